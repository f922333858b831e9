"""How four joints before a wrist follow from the first of them, where axes 2 and 3 meet: most arms of seven joints.

With P where they meet and W the wrist's point, which shall come to W':

1. Turns of joints 2 and 3 leave |W - P|, which joint 4 alone changes, and joint 1 alone moves P: each of the two gives
   the other one, in up to two ways, by |W' - P| = |W - P|.
2. Joints 2 and 3 turn W - P to W' - P: first by the angle of W - P to axis 3, in two ways, then about that axis.

So boxes of such an arm need to be split in one coordinate, and in others only where this says little of them: where
the arm is stretched, or W on an axis.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline, shared
from pin_metaik.kinematics.kernel.closed_form import Vector, cross, dot, minus, plus, turned, vector
from pin_metaik.kinematics.kernel.forward import copy, cos_sin
from pin_metaik.kinematics.kernel.layout import COLUMN, ROUNDING, SCALE
from pin_metaik.kinematics.proofs.balls import Arc, arc_from_to, arcs_onto, chord, lever, reverse, turned_ball
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, cosine_range, set_range
from pin_metaik.kinematics.proofs.box_wrist import turns

ROUNDED = 1e-14  # of a squared distance: what rounding does to it


@inline
def about(axis: Vector, through: Vector, angle: float, point: Vector) -> Vector:
    """A point turned about an axis through another one by an angle, rad."""
    return plus(through, turned(axis, cos_sin(angle), minus(point, through)))


@inline
def distances(axis: Vector, through: Vector, half: float, point: Vector, other: Vector) -> tuple[float, float]:
    """Least and most distance of a point from another one, while it turns about an axis by up to ``half``, rad."""
    a, b = minus(point, through), minus(other, through)
    along, square = dot(axis, a) * dot(axis, b), dot(a, a) + dot(b, b)
    low, high = cosine_range(dot(a, b) - along, dot(b, cross(axis, a)), half)
    return (
        math.sqrt(max(square - 2.0 * (along + high), 0.0)),
        math.sqrt(max(square - 2.0 * (along + low), 0.0)),
    )


@inline
def to_distance(
    axis: Vector, through: Vector, point: Vector, other: Vector, shortest: float, longest: float
) -> tuple[Arc, Arc, float]:
    """The turns of a point about an axis that bring it so near to another one, as ``arcs_onto`` tells them."""
    a, b, shortest = minus(point, through), minus(other, through), max(shortest, 0.0)
    square = 0.5 * (dot(a, a) + dot(b, b))
    level, off = square - 0.25 * (longest**2 + shortest**2), 0.25 * (longest**2 - shortest**2)
    return arcs_onto(b, axis, (a, 0.0), level, off + ROUNDED * square)


@inline
def ranges(arm: BoxArm, box: Floats, s: int, arcs: tuple[Arc, Arc, float], found: Floats) -> int:
    """How many ranges of joint s inside a box (2 n,) two arcs from its centre leave, which ``found`` (2, 3) gets.

    Each as ``turns`` tells them; two that overlap are one.
    """
    one, two, lack = arcs
    n, ways = box.shape[0] // 2, 0
    if lack > 0.0:
        return 0
    if turns(arm, box[:n], box[n:], s, one, found[0]):
        ways = 1
    if turns(arm, box[:n], box[n:], s, two, found[ways]):
        ways += 1
    if ways == 2 and found[0, 1] <= found[1, 2] + ROUNDING and found[1, 1] <= found[0, 2] + ROUNDING:
        found[0, 1], found[0, 2] = min(found[0, 1], found[1, 1]), max(found[0, 2], found[1, 2])
        return 1
    return ways


@inline
def turn_of(arm: BoxArm, box: Floats, s: int, found: Floats) -> tuple[float, float]:
    """By how much a joint turns from a box's centre to that of its range (3,), and half of the range, rad."""
    scale, c = arm.joints[s, SCALE], arm.wiring[s, COLUMN]
    return scale * (0.5 * (found[1] + found[2]) - box[c]), 0.5 * abs(scale) * (found[2] - found[1])


@shared
def shoulder_turns(arm: BoxArm, laid: Laid, near: float, box: Floats, found: Floats, parts: Floats) -> int:
    """How many parts of a box (2 n,) may bring the wrist's point within ``near`` (m) of the target's.

    ``parts`` (8, 2 n) gets them; ``found`` (4, 2, 3) is scratch.
    """
    z1, o1, z4, o4 = vector(laid.axes[0]), vector(laid.points[0]), vector(laid.axes[3]), vector(laid.points[3])
    P, W, there = vector(laid.points[2]), vector(laid.points[4]), vector(laid.target_points[4])
    n, off, count = box.shape[0] // 2, near + arm.reach[1] + arm.reach[2], 0
    least, most = distances(z1, o1, laid.half[0], P, there)
    for fourth in range(ranges(arm, box, 3, to_distance(z4, o4, W, P, least - off, most + off), found[3])):
        angle, half = turn_of(arm, box, 3, found[3, fourth])
        bent, sway = about(z4, o4, angle, W), chord(half) * lever(z4, minus(W, o4))
        least, most = distances(z4, o4, half, bent, P)
        for first in range(ranges(arm, box, 0, to_distance(z1, o1, P, there, least - off, most + off), found[0])):
            angle, half = turn_of(arm, box, 0, found[0, first])
            turn = cos_sin(angle)
            z2, z3 = turned(z1, turn, vector(laid.axes[1])), turned(z1, turn, vector(laid.axes[2]))
            arm_there = minus(there, about(z1, o1, angle, P)), chord(half) * lever(z1, minus(there, o1)) + off
            arm_here = turned(z1, turn, minus(bent, P)), sway
            one, two, lack = arcs_onto(z3, z2, arm_there, dot(z3, arm_here[0]), sway)
            for second in range(ranges(arm, box, 1, (reverse(one), reverse(two), lack), found[1])):
                angle, half = turn_of(arm, box, 1, found[1, second])
                third = arc_from_to(z3, arm_here, turned_ball(z2, (cos_sin(-angle), half), arm_there))
                if turns(arm, box[:n], box[n:], 2, third, found[2, 0]):
                    part = parts[count]
                    copy(box, part)
                    set_range(part, arm.wiring[0, COLUMN], found[0, first, 1], found[0, first, 2])
                    set_range(part, arm.wiring[1, COLUMN], found[1, second, 1], found[1, second, 2])
                    set_range(part, arm.wiring[2, COLUMN], found[2, 0, 1], found[2, 0, 2])
                    set_range(part, arm.wiring[3, COLUMN], found[3, fourth, 1], found[3, fourth, 2])
                    count += 1
    return count
