"""Whether a wrist, the last three axes, which meet, can turn the tip as the target asks, for any place of the others.

The three steps of a closed form, with what the joints before the wrist do as a radius on the target's directions. So
the wrist's joints need never be split.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from pin_metaik.compiled import Floats, inline, shared
from pin_metaik.kinematics.kernel.closed_form import Vector, angle, cross, dot, vector
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, ROUNDING, SCALE, SHIFT
from pin_metaik.kinematics.proofs.balls import (
    Arc,
    arc_from_to,
    beyond,
    lever,
    norm,
    reverse,
    turned_ball,
)
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, times

Bend: TypeAlias = tuple[Vector, float, float, float, float, float]


@inline
def asked_of_bend(arm: BoxArm, laid: Laid, aligned: float) -> Bend:
    """What the target asks of the wrist's second joint: k1 . Rot(k2, turn) k3 = k1 . goal, its axes being k1, k2, k3.

    Returns the goal, by how much it may be off (rad), and ``a cos(turn) + b sin(turn) = rest``, give or take a spread.
    """
    w = laid.half.shape[0] - 3
    k1, k2, k3 = vector(laid.axes[w]), vector(laid.axes[w + 1]), vector(laid.axes[w + 2])
    goal, off = vector(laid.target_axes[w + 2]), aligned
    for j in range(w):
        if arm.wiring[j, ROTATES] == 1:
            off += laid.moves[j] * lever(vector(laid.axes[j]), goal)
    fixed = dot(k1, k2) * dot(k2, k3)
    a, b, rest = dot(k1, k3) - fixed, dot(k1, cross(k2, k3)), dot(k1, goal) - fixed
    return goal, off, a, b, rest, min(off, lever(k1, goal) * off + 0.5 * off * off)


@shared
def may_be_straight(arm: BoxArm, laid: Laid, aligned: float) -> bool:
    """Whether the wrist may be straight, or its axes 1 and 3 always point alike."""
    _, _, a, b, rest, spread = asked_of_bend(arm, laid, aligned)
    return abs(rest) + spread >= math.sqrt(a * a + b * b)


@shared
def wrist_turns(
    arm: BoxArm, laid: Laid, centre: Floats, width: Floats, aligned: float, most: int, turned: Floats
) -> int:
    """How the wrist inside the box comes within ``aligned`` (rad) of the target's orientation.

    Returns in how many ways: it is bent to one side or to the other. ``turned`` (2, 9) gets, for up to ``most`` ways, a
    value of each of its coordinates, the least that they may have, and the greatest.
    """
    w = laid.half.shape[0] - 3
    k1, k2, k3 = vector(laid.axes[w]), vector(laid.axes[w + 1]), vector(laid.axes[w + 2])
    goal, off, a, b, rest, spread = asked_of_bend(arm, laid, aligned)
    size = math.sqrt(a * a + b * b)
    if size < ROUNDING:  # it can turn axis 3 nowhere else: nothing is known
        for k in range(3):
            c = arm.wiring[w + k, COLUMN]
            turned[0, k], turned[0, 3 + k], turned[0, 6 + k] = centre[c], centre[c] - width[c], centre[c] + width[c]
        return 1
    if abs(rest) - spread > size:
        return 0
    side = cross(k3, (1.0, 0.0, 0.0) if abs(k3[0]) < 0.6 else (0.0, 1.0, 0.0))
    long = norm(side)
    side = side[0] / long, side[1] / long, side[2] / long  # across axis 3 of the wrist
    goal_side, off_side = times(laid.turn, side), aligned
    for j in range(w):
        if arm.wiring[j, ROTATES] == 1:
            off_side += laid.moves[j] * lever(vector(laid.axes[j]), goal_side)
    near, far = math.acos(min((rest + spread) / size, 1.0)), math.acos(max((rest - spread) / size, -1.0))
    middle, half, radius = math.atan2(b, a), 0.5 * (near + far), 0.5 * (far - near)
    ways = 0
    for way in range(2):
        second = middle + (half if way == 0 else -half)
        t2: Arc = (math.cos(second), math.sin(second)), radius
        t1 = arc_from_to(k1, turned_ball(k2, t2, (k3, 0.0)), (goal, off))
        back = turned_ball(k2, reverse(t2), turned_ball(k1, reverse(t1), (goal_side, off_side)))
        t3 = arc_from_to(k3, (side, 0.0), back)
        here = turned[ways]
        fits = turns(arm, centre, width, w, t1, here[::3]) and turns(arm, centre, width, w + 1, t2, here[1::3])
        if fits and turns(arm, centre, width, w + 2, t3, here[2::3]):
            ways += 1
            if ways == most:
                return ways
    return ways


@inline
def turns(arm: BoxArm, centre: Floats, width: Floats, s: int, arc: Arc, turned: Floats) -> bool:
    """Whether joint s may turn by an arc from the centre within the box; ``turned`` (3,) gets where to; see above."""
    c, scale, shift = arm.wiring[s, COLUMN], arm.joints[s, SCALE], arm.joints[s, SHIFT]
    middle, half = scale * centre[c] + shift, abs(scale) * width[c]
    lower, upper = middle - half, middle + half
    at, radius = middle + angle(arc[0]), arc[1]
    if beyond(at, radius, lower, upper) > 0.0:
        return False
    least, most, turn = lower, upper, 2.0 * math.pi
    if radius < math.pi:
        at += turn * math.ceil((lower - ROUNDING - radius - at) / turn)
        last = at + turn * math.floor((upper + ROUNDING + radius - at) / turn)
        least, most = max(lower, at - radius), min(upper, last + radius)
    turned[0] = (min(max(at, lower), upper) - shift) / scale
    turned[1], turned[2] = (least - shift) / scale, (most - shift) / scale
    if scale < 0.0:
        turned[1], turned[2] = turned[2], turned[1]
    return True
