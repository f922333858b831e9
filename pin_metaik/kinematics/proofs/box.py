"""A box of configurations, seen from its centre: where the joints stand, and how far each test lets them move.

At the centre the chain is laid twice. From the world: axes z_k and a point o_k on each. From the target: the same axes
and points, z'_k and o'_k, carried by D = T FK(centre)^-1, which takes the tip to the target T. In a configuration that
reaches the target the two are one. A joint j that turns by up to r_j moves a point at distance d from its axis by at
most 2 sin(r_j / 2) d, and a direction at angle a to it by 2 sin(r_j / 2) sin a; a slide moves points by r_j.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, shared
from pin_metaik.kinematics.kernel.closed_form import Vector, cross, minus, vector
from pin_metaik.kinematics.kernel.forward import forward
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE
from pin_metaik.kinematics.proofs.balls import chord, norm

FREE, BENT, SPLIT = 1, 2, 3  # what becomes of a wrist; see ``BoxArm``
PAD = 1e-12  # rad or m: rounding
START = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])  # the world, seen from the world


class BoxArm(NamedTuple):
    """One path of a chain, for boxes.

    Attributes:
        joints: (S, 14) as ``forward`` takes them.
        wiring: (S, 2) the coordinate a joint follows, and 1 if it turns.
        knots: (S,) where on each axis its point is, m.
        tip: (12,) placement of the tip in the last joint frame.
        lower: (n,) limits of the coordinates, finite, rad or m.
        upper: (n,).
        reach: (3,) greatest distance of any point from the tip and from each other, m; and how far turns of the wrist
            may move its point as the tip sees it, and of a shoulder its own, because the axes do not quite meet.
        wrist: (3,) 1 if the last three axes meet, each with a coordinate of its own; then these are split last, if at
            all. 0, or above if boxes are shrunk around solutions: ``FREE`` if nobody asks for the values of a wrist's
            joints, ``BENT`` if its two bends are told apart and it is split where it may be straight, and ``SPLIT`` if
            it always is, once all other joints are short. 1 if four joints are before it, the axes of the second and
            third of which meet; see ``box_shoulder``.
    """

    joints: Floats
    wiring: Ints
    knots: Floats
    tip: Floats
    lower: Floats
    upper: Floats
    reach: Floats
    wrist: Ints


class Laid(NamedTuple):
    """The chain laid at the centre of a box.

    Attributes:
        axes: (S, 3) from the world.
        points: (S, 3).
        target_axes: (S, 3) from the target.
        target_points: (S, 3).
        turn: (3, 3) rotation of D.
        half: (S,) half width of each joint, rad or m.
        moves: (S,) chord of each joint's half width: how far it moves a point at distance 1, or any by a slide.
        distances: (K, S) how far joint j carries point k for each unit of its move; the last k is a wrist's first axis.
        angles: (K, S) the same for axis k.
        pose: (12,) of the tip at the centre.
    """

    axes: Floats
    points: Floats
    target_axes: Floats
    target_points: Floats
    turn: Floats
    half: Floats
    moves: Floats
    distances: Floats
    angles: Floats
    pose: Floats


@allocating
def laid_for(S: int, K: int) -> Laid:
    """Room for a chain of S joints, K of which balls are tested at."""
    return Laid(
        np.empty((S, 3)),
        np.empty((S, 3)),
        np.empty((S, 3)),
        np.empty((S, 3)),
        np.empty((3, 3)),
        np.empty(S),
        np.empty(S),
        np.empty((K, S)),
        np.empty((K, S)),
        np.empty(12),
    )


@inline
def times(M: Floats, v: Vector) -> Vector:
    """M v for a matrix (3, 3)."""
    return (
        M[0, 0] * v[0] + M[0, 1] * v[1] + M[0, 2] * v[2],
        M[1, 0] * v[0] + M[1, 1] * v[1] + M[1, 2] * v[2],
        M[2, 0] * v[0] + M[2, 1] * v[1] + M[2, 2] * v[2],
    )


@inline
def transposed_times(M: Floats, v: Vector) -> Vector:
    """M' v for a matrix (3, 3)."""
    return (
        M[0, 0] * v[0] + M[1, 0] * v[1] + M[2, 0] * v[2],
        M[0, 1] * v[0] + M[1, 1] * v[1] + M[2, 1] * v[2],
        M[0, 2] * v[0] + M[1, 2] * v[1] + M[2, 2] * v[2],
    )


@inline
def times_number(number: float, v: Vector) -> Vector:
    """A vector that is so many times as long."""
    return number * v[0], number * v[1], number * v[2]


@inline
def set_range(box: Floats, c: int, lower: float, upper: float) -> None:
    """Write the range of one coordinate into a box (2 n,)."""
    box[c], box[box.shape[0] // 2 + c] = 0.5 * (lower + upper), max(0.5 * (upper - lower), 0.0) + PAD


@inline
def write(v: Vector, row: Floats) -> None:
    """Write a vector into a row (3,)."""
    row[0], row[1], row[2] = v


@shared
def lay(arm: BoxArm, target: Floats, centre: Floats, width: Floats, laid: Laid) -> None:
    """Lay the chain for a target (12,) at the centre (n,) of a box with half widths (n,)."""
    joints, wiring = arm.joints, arm.wiring
    S = joints.shape[0]
    forward(joints, wiring, 0, S, arm.tip, START, centre, laid.axes, laid.points, laid.pose)
    pose, turn = laid.pose, laid.turn
    for i in range(3):
        for j in range(3):
            turn[i, j] = 0.0
            for k in range(3):
                turn[i, j] += target[3 * i + k] * pose[3 * j + k]
    at, goal = (pose[9], pose[10], pose[11]), (target[9], target[10], target[11])
    for k in range(S):
        z, o = vector(laid.axes[k]), vector(laid.points[k])
        o = o[0] + arm.knots[k] * z[0], o[1] + arm.knots[k] * z[1], o[2] + arm.knots[k] * z[2]
        write(o, laid.points[k])
        moved = times(turn, minus(o, at))
        write((goal[0] + moved[0], goal[1] + moved[1], goal[2] + moved[2]), laid.target_points[k])
        write(times(turn, z), laid.target_axes[k])
        half = abs(joints[k, SCALE]) * width[wiring[k, COLUMN]]
        laid.half[k], laid.moves[k] = half, chord(half) if wiring[k, ROTATES] == 1 else half


@inline
def lay_levers(arm: BoxArm, laid: Laid, first: int) -> None:
    """Measure how far joints carry the points and axes from a first one on."""
    for j in range(laid.half.shape[0]):
        z, o = vector(laid.axes[j]), vector(laid.points[j])
        for k in range(first, laid.angles.shape[0]):
            if arm.wiring[j, ROTATES] == 1:
                laid.distances[k, j] = norm(cross(z, minus(vector(laid.points[k]), o)))
                laid.angles[k, j] = norm(cross(z, vector(laid.axes[k])))
            else:
                laid.distances[k, j], laid.angles[k, j] = 1.0, 0.0


@inline
def cosine_range(a: float, b: float, radius: float) -> tuple[float, float]:
    """Least and most of a cos t + b sin t for |t| <= radius."""
    size = math.sqrt(a * a + b * b)
    if radius >= math.pi:
        return -size, size
    phase, turn = math.atan2(b, a), 2.0 * math.pi
    low, high = -radius - phase, radius - phase
    ends = math.cos(low), math.cos(high)
    most = 1.0 if math.floor(high / turn) >= math.ceil(low / turn) else max(ends[0], ends[1])
    flat = math.floor((high - math.pi) / turn) >= math.ceil((low - math.pi) / turn)
    return size * (-1.0 if flat else min(ends[0], ends[1])), size * most
