"""Warm starts: where a descent begins, as a chain's table of samples suggests for a target.

Each of the eight sampled configurations with the nearest poses is taken one damped Newton step on, for which the table
keeps the gain. They are ranked by score, smallest first: the part of that step that the limits do not allow, plus a
tenth of its length. What was measured, evaluations a target on random / near-limit / singular targets, 150 each:

* Six arms, the nearest 12: as they are, nearest first, 9.4 / 17.0 / 25.3; one step on and in that order 6.7 / 13.3 /
  22.5; in the order of the error that the step leaves, which needs the Jacobians too, 6.6 / 13.1 / 22.5.
* Five arms, the nearest 12, nearest first: as they are 9.5 / 17.4 / 28.0, one step on 8.3 / 16.5 / 28.8.
* Gains with damping 0.01 instead of 0.001: 7.3 / 14.4 / 21.7 instead of 6.7 / 13.3 / 22.5.
* The nearest 8 instead of 12 (300 each): 6.9 / 14.3 / 23.6 instead of 6.7 / 14.1 / 22.1, but 6.2 / 10.7 / 17.3 us
  instead of 6.6 / 11.1 / 17.1, and a third less of the table to fetch.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, inline, jit, separate
from pin_metaik.kinematics.kernel.descent import solve_symmetric
from pin_metaik.kinematics.kernel.forward import IDENTITY, copy, forward, sizes_of, unpack
from pin_metaik.kinematics.kernel.goals import evaluate_pose, pose_error
from pin_metaik.kinematics.kernel.layout import (
    GOAL,
    LEAF,
    SLACK,
    TURN_SLACK,
    WEIGHT,
    Arm,
    Bounds,
    Samples,
    samples_in,
)
from pin_metaik.kinematics.kernel.scratch import OPENED, TRIED, LookupScratch, Scratch, lookup_scratch, scratch_for

samples_of = separate(samples_in)

GAIN_DAMPING = 1e-3  # m^2 or rad^2
LENGTH = 0.1  # what a radian of the step counts against one that the limits do not allow


@inline
def target_feature(goals: Floats, scale: float, feature: Singles, weights: Singles) -> None:
    """Feature (9 T,) of the targets as the samples have it, weight 0 where they leave position or orientation free."""
    for t in range(goals.shape[0]):
        goal, at = goals[t], 9 * t
        placed = goal[SLACK] < np.inf and goal[SLACK + 1] < np.inf and goal[SLACK + 2] < np.inf
        turned = goal[TURN_SLACK] < np.inf and goal[TURN_SLACK + 1] < np.inf and goal[TURN_SLACK + 2] < np.inf
        for j in range(3):
            feature[at + j] = -(goal[j] * goal[9] + goal[3 + j] * goal[10] + goal[6 + j] * goal[11])
            feature[at + 3 + j] = scale * goal[j]
            feature[at + 6 + j] = scale * goal[6 + j]
            weights[at + j] = 1.0 if placed else 0.0
            weights[at + 3 + j] = weights[at + 6 + j] = 1.0 if turned else 0.0


@inline
def merge_nearest(
    leaf: Singles, number: int, feature: Singles, weights: Singles, away: Singles, found: Ints, distances: Singles
) -> None:
    """Merge the columns of a leaf (9 T, LEAF) into the nearest found so far, nearest first."""
    away[:] = 0.0
    for j in range(0, feature.shape[0], 3):  # three rows at a time: a third of the loads and stores
        f, g, h, weight = feature[j], feature[j + 1], feature[j + 2], weights[j]
        for i in range(LEAF):
            a, b, c = leaf[j, i] - f, leaf[j + 1, i] - g, leaf[j + 2, i] - h
            away[i] += weight * (a * a + b * b + c * c)
    last = distances.shape[0] - 1
    for i in range(LEAF):
        if away[i] < distances[last]:
            k = last
            while k > 0 and distances[k - 1] > away[i]:
                distances[k], found[k] = distances[k - 1], found[k - 1]
                k -= 1
            distances[k], found[k] = away[i], number * LEAF + i


@inline
def look_up(leaves: Singles, look: LookupScratch) -> None:
    """The entries nearest to the feature (TRIED,), nearest first, with their squared distances."""
    feature, weights, away = look.feature, look.weights, look.away
    look.spans[:] = np.inf
    merge_nearest(leaves[0], 0, feature, weights, away, look.opened, look.spans)
    look.distances[:] = np.inf
    for k in range(OPENED):
        leaf = look.opened[k]
        merge_nearest(leaves[1 + leaf], leaf, feature, weights, away, look.order, look.distances)


@inline
def feature_distance(arm: Arm, x: Floats, scale: float, feature: Singles, weights: Singles, work: Scratch) -> float:
    """Squared distance of the feature at x (n,) from the target's."""
    joints, wiring, ends, tips = arm
    axes, origins, pose = work.axes, work.origins, work.pose
    away = 0.0
    for t in range(tips.shape[0]):
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], IDENTITY, x, axes, origins, pose)
        for j in range(3):
            away += weights[9 * t + j] * (feature[9 * t + j] - pose[9 + j]) ** 2
            away += weights[9 * t + 3 + j] * (feature[9 * t + 3 + j] - scale * pose[3 * j]) ** 2
            away += weights[9 * t + 6 + j] * (feature[9 * t + 6 + j] - scale * pose[3 * j + 2]) ** 2
    return away


@inline
def entry_error(goal: Floats, leaf: Singles, i: int, scale: float, pose: Floats, error: Floats) -> None:
    """Translation and rotation vector (6,) of column i of a leaf, in its own frame, from a target."""
    inverse = 1.0 / scale
    xx, xy, xz = inverse * leaf[3, i], inverse * leaf[4, i], inverse * leaf[5, i]
    zx, zy, zz = inverse * leaf[6, i], inverse * leaf[7, i], inverse * leaf[8, i]
    yx, yy, yz = zy * xz - zz * xy, zz * xx - zx * xz, zx * xy - zy * xx
    for j in range(3):
        a, b, c = goal[3 * j], goal[3 * j + 1], goal[3 * j + 2]
        pose[3 * j] = a * xx + b * xy + c * xz
        pose[3 * j + 1] = a * yx + b * yy + c * yz
        pose[3 * j + 2] = a * zx + b * zy + c * zz
        pose[9 + j] = a * leaf[0, i] + b * leaf[1, i] + c * leaf[2, i] + goal[9 + j]
    pose_error(pose, error)
    px, py, pz = error[0], error[1], error[2]
    for j in range(3):  # the rotation vector is the same in both frames
        error[j] = pose[j] * px + pose[3 + j] * py + pose[6 + j] * pz


@inline
def suggest(
    goals: Floats, rows: Ints | None, bounds: Bounds, samples: Samples, work: Scratch, look: LookupScratch
) -> float:
    """Starts (TRIED, n), the most promising first; returns the squared distance of the nearest entry's pose.

    With ``rows``, for anything but one whole pose, they are the entries with the nearest poses as they are.
    """
    leaves, entries, gains, scale = samples
    out, order, distances, scores = look.starts, look.order, look.distances, look.scores
    look_up(leaves, look)
    if rows is not None:
        for k in range(TRIED):
            copy(entries[order[k]], out[k])
        return float(distances[0])
    lower, upper = bounds.lower, bounds.upper
    pose, error, x = work.pose, work.error, work.x
    n = x.shape[0]
    for k in range(TRIED):
        entry = order[k]
        entry_error(goals[0], leaves[1 + entry // LEAF], entry % LEAF, scale, pose, error)
        outside = length = 0.0
        for c in range(n):
            step = 0.0
            for j in range(6):
                step -= gains[entry, c, j] * error[j]
            there = entries[entry, c] + step
            x[c] = min(max(there, lower[c]), upper[c])
            outside += (there - x[c]) ** 2
            length += (x[c] - entries[entry, c]) ** 2
        score = math.sqrt(outside) + LENGTH * math.sqrt(length)
        i = k
        while i > 0 and scores[i - 1] > score:
            scores[i] = scores[i - 1]
            copy(out[i - 1], out[i])
            i -= 1
        scores[i] = score
        copy(x, out[i])
    return float(distances[0])


@inline
def gains_in(block: Floats, X: Floats, out: Singles, work: Scratch, goal: Floats) -> None:
    """``gains_of`` in room that was made for it; ``goal`` (GOAL,) is zero."""
    arm = unpack(block).arm
    joints, wiring, ends, tips = arm
    pose, J, H, y = work.pose, work.J, work.H, work.y
    n = X.shape[1]
    for j in range(6):
        goal[WEIGHT + j] = 1.0
    for k in range(X.shape[0]):
        forward(joints, wiring, ends[0], ends[1], tips[0], IDENTITY, X[k], work.axes, work.origins, pose)
        for i in range(3):  # the world as seen from the tip
            goal[9 + i] = 0.0
            for j in range(3):
                goal[3 * i + j] = pose[3 * j + i]
                goal[9 + i] -= pose[3 * j + i] * pose[9 + j]
        evaluate_pose(arm, goal, X[k], work)
        for c in range(n):
            for a in range(6):
                for b in range(a + 1):
                    H[a, b] = GAIN_DAMPING if a == b else 0.0
                    for d in range(n):
                        H[a, b] += J[d, a] * J[d, b]
                y[a] = J[c, a]
            solve_symmetric(H, y, 6)
            for a in range(6):
                out[k, c, a] = y[a]


@jit("void(f8[::1], f8[:,::1], f4[:,:,::1])")
def gains_of(block: Floats, X: Floats, out: Singles) -> None:
    """Gains (k, n, 6) of one tip at X (k, n): J' (J J' + GAIN_DAMPING I)^-1, with J in the tip's frame."""
    S, n, _ = sizes_of(block)
    gains_in(block, X, out, scratch_for(n, None, S), np.zeros(GOAL))


@inline
def nearest_in(block: Floats, goals: Floats, out: Floats, look: LookupScratch, order: Ints, distances: Singles) -> None:
    """``nearest_samples`` in room that was made for it."""
    samples = samples_of(block)
    target_feature(goals, samples.scale, look.feature, look.weights)
    distances[:] = np.inf
    for leaf in range(samples.leaves.shape[0] - 1):
        merge_nearest(samples.leaves[1 + leaf], leaf, look.feature, look.weights, look.away, order, distances)
    for k in range(out.shape[0]):
        copy(samples.x[order[k]], out[k])


@jit("void(f8[::1], f8[:,::1], f8[:,::1])")
def nearest_samples(block: Floats, goals: Floats, out: Floats) -> None:
    """The samples (count, n) with the poses nearest to the targets, nearest first."""
    _, n, T = sizes_of(block)
    count = out.shape[0]
    nearest_in(block, goals, out, lookup_scratch(n, T), np.zeros(count, np.int64), np.empty(count, np.float32))
