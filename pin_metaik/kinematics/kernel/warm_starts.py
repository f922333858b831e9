"""Where a descent starts: what the atlas of a chain suggests for a target.

Each of the eight sampled configurations with the nearest poses is taken one damped Newton step on, for which the atlas
keeps the gain; they are tried in the order of how much of that step the limits would not allow, plus a tenth of its
length. What was measured, evaluations a target on random / near-limit / singular targets, 150 each:

* Six arms, the nearest 12: as they are, nearest first, 9.4 / 17.0 / 25.3; one step on and in that order 6.7 / 13.3 /
  22.5; in the order of the error that the step leaves, which needs the Jacobians too, 6.6 / 13.1 / 22.5.
* Five arms, the nearest 12, nearest first: as they are 9.5 / 17.4 / 28.0, one step on 8.3 / 16.5 / 28.8.
* Gains with damping 0.01 instead of 0.001: 7.3 / 14.4 / 21.7 instead of 6.7 / 13.3 / 22.5.
* The nearest 8 instead of 12 (300 each): 6.9 / 14.3 / 23.6 instead of 6.7 / 14.1 / 22.1, but 6.2 / 10.7 / 17.3 us
  instead of 6.6 / 11.1 / 17.1, and a third less of the atlas to fetch.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, allocating, inline, jit
from pin_metaik.kinematics.atlas import LEAF
from pin_metaik.kinematics.kernel.descent import Arm, Bounds, Work, evaluate_pose, solve_symmetric, workspace
from pin_metaik.kinematics.kernel.forward import PATHS, copy, forward, pose_error

ATLAS = "f4[:,:,::1], f4[:,::1], f4[:,:,::1], f8"
Atlas: TypeAlias = tuple[Singles, Singles, Singles, float]  # leaves, entries, gains, scale
Looks: TypeAlias = tuple[Floats, Singles, Singles, Singles, Ints, Singles, Ints, Singles, Floats]

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
OPENED, TRIED = 4, 8  # leaves of the atlas that are opened, entries that are tried
GAIN_DAMPING = 1e-3  # m^2 or rad^2
LENGTH = 0.1  # what a radian of the step counts against one that the limits do not allow


@allocating
def lookup_space(n: int, T: int) -> Looks:
    """Scratch arrays of look-ups: starts (TRIED, n), feature of the target and weights (9 T,), and what is nearest."""
    return (
        np.empty((TRIED, n)),
        np.empty(9 * T, np.float32),
        np.empty(9 * T, np.float32),
        np.empty(LEAF, np.float32),
        np.empty(OPENED, np.int64),
        np.empty(OPENED, np.float32),
        np.empty(TRIED, np.int64),
        np.empty(TRIED, np.float32),
        np.empty(TRIED),
    )


@inline
def target_feature(tasks: Floats, scale: float, goal: Singles, weights: Singles) -> None:
    """Feature (9 T,) of the targets as the atlas has it, and weight 0 where they leave position or orientation free."""
    for t in range(tasks.shape[0]):
        task, at = tasks[t], 9 * t
        placed = task[12] < np.inf and task[13] < np.inf and task[14] < np.inf
        turned = task[15] < np.inf and task[16] < np.inf and task[17] < np.inf
        for j in range(3):
            goal[at + j] = -(task[j] * task[9] + task[3 + j] * task[10] + task[6 + j] * task[11])
            goal[at + 3 + j] = scale * task[j]
            goal[at + 6 + j] = scale * task[6 + j]
            weights[at + j] = 1.0 if placed else 0.0
            weights[at + 3 + j] = weights[at + 6 + j] = 1.0 if turned else 0.0


@inline
def merge_nearest(
    leaf: Singles, number: int, goal: Singles, weights: Singles, away: Singles, found: Ints, distances: Singles
) -> None:
    """Merge the columns of a leaf (9 T, LEAF) into the nearest found so far, nearest first."""
    away[:] = 0.0
    for j in range(0, goal.shape[0], 3):  # three rows at a time: a third of the loads and stores
        f, g, h, weight = goal[j], goal[j + 1], goal[j + 2], weights[j]
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
def look_up(leaves: Singles, looks: Looks) -> None:
    """The atlas entries nearest to the goal (TRIED,), nearest first, with their squared distances."""
    _, goal, weights, away, opened, spans, order, distances, _ = looks
    spans[:] = np.inf
    merge_nearest(leaves[0], 0, goal, weights, away, opened, spans)
    distances[:] = np.inf
    for k in range(OPENED):
        leaf = opened[k]
        merge_nearest(leaves[1 + leaf], leaf, goal, weights, away, order, distances)


@inline
def feature_distance(arm: Arm, x: Floats, scale: float, goal: Singles, weights: Singles, work: Work) -> float:
    """Squared distance of the feature at x (n,) from the goal's."""
    joints, wiring, ends, tips = arm
    axes, origins, pose = work[0], work[1], work[2]
    away = 0.0
    for t in range(tips.shape[0]):
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], IDENTITY, x, axes, origins, pose)
        for j in range(3):
            away += weights[9 * t + j] * (goal[9 * t + j] - pose[9 + j]) ** 2
            away += weights[9 * t + 3 + j] * (goal[9 * t + 3 + j] - scale * pose[3 * j]) ** 2
            away += weights[9 * t + 6 + j] * (goal[9 * t + 6 + j] - scale * pose[3 * j + 2]) ** 2
    return away


@inline
def entry_error(task: Floats, leaf: Singles, i: int, scale: float, pose: Floats, error: Floats) -> None:
    """Translation and rotation vector (6,) of column i of a leaf, in its own frame, from a target."""
    inverse = 1.0 / scale
    xx, xy, xz = inverse * leaf[3, i], inverse * leaf[4, i], inverse * leaf[5, i]
    zx, zy, zz = inverse * leaf[6, i], inverse * leaf[7, i], inverse * leaf[8, i]
    yx, yy, yz = zy * xz - zz * xy, zz * xx - zx * xz, zx * xy - zy * xx
    for j in range(3):
        a, b, c = task[3 * j], task[3 * j + 1], task[3 * j + 2]
        pose[3 * j] = a * xx + b * xy + c * xz
        pose[3 * j + 1] = a * yx + b * yy + c * yz
        pose[3 * j + 2] = a * zx + b * zy + c * zz
        pose[9 + j] = a * leaf[0, i] + b * leaf[1, i] + c * leaf[2, i] + task[9 + j]
    pose_error(pose, error)
    px, py, pz = error[0], error[1], error[2]
    for j in range(3):  # the rotation vector is the same in both frames
        error[j] = pose[j] * px + pose[3 + j] * py + pose[6 + j] * pz


@inline
def suggest(tasks: Floats, rows: Ints | None, bounds: Bounds, atlas: Atlas, work: Work, looks: Looks) -> float:
    """Starts (TRIED, n), the most promising first; returns the squared distance of the nearest entry's pose.

    With ``rows``, for anything but one whole pose, they are the entries with the nearest poses as they are.
    """
    leaves, entries, gains, scale = atlas
    out, _, _, _, _, _, order, distances, doubts = looks
    look_up(leaves, looks)
    if rows is not None:
        for k in range(TRIED):
            copy(entries[order[k]], out[k])
        return float(distances[0])
    lower, upper, _ = bounds
    pose, error, x = work[2], work[3], work[10]
    n = x.shape[0]
    for k in range(TRIED):
        entry = order[k]
        entry_error(tasks[0], leaves[1 + entry // LEAF], entry % LEAF, scale, pose, error)
        outside = length = 0.0
        for c in range(n):
            step = 0.0
            for j in range(6):
                step -= gains[entry, c, j] * error[j]
            there = entries[entry, c] + step
            x[c] = min(max(there, lower[c]), upper[c])
            outside += (there - x[c]) ** 2
            length += (x[c] - entries[entry, c]) ** 2
        doubt = math.sqrt(outside) + LENGTH * math.sqrt(length)
        i = k
        while i > 0 and doubts[i - 1] > doubt:
            doubts[i] = doubts[i - 1]
            copy(out[i - 1], out[i])
            i -= 1
        doubts[i] = doubt
        copy(x, out[i])
    return float(distances[0])


@jit(f"void({PATHS}, f8[:,::1], f4[:,:,::1])")
def gains_of(joints: Floats, wiring: Ints, ends: Ints, tips: Floats, X: Floats, out: Singles) -> None:
    """Gains (k, n, 6) of one tip at X (k, n): J' (J J' + GAIN_DAMPING I)^-1, with J in the tip's frame."""
    n = X.shape[1]
    arm = joints, wiring, ends, tips
    work = workspace(n, None, joints.shape[0])
    pose, J, H, y = work[2], work[7], work[8], work[9]
    task = np.zeros(26)
    task[18:24] = 1.0
    for k in range(X.shape[0]):
        forward(joints, wiring, ends[0], ends[1], tips[0], IDENTITY, X[k], work[0], work[1], pose)
        for i in range(3):  # the world as seen from the tip
            task[9 + i] = 0.0
            for j in range(3):
                task[3 * i + j] = pose[3 * j + i]
                task[9 + i] -= pose[3 * j + i] * pose[9 + j]
        evaluate_pose(arm, task, X[k], work)
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
