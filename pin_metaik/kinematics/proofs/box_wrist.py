"""Whether a wrist, the last three axes, which meet, can turn the tip as the target asks, for any place of the others.

The three steps of a closed form, with what the joints before the wrist do as a radius on the directions that they
turn. So the wrist's joints need never be split, but where it may be straight.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline, shared
from pin_metaik.kinematics.kernel.closed_form import Vector, angle, cross, dot, plus, vector
from pin_metaik.kinematics.kernel.forward import copy, cos_sin
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, ROUNDING, SCALE, SHIFT
from pin_metaik.kinematics.proofs.balls import (
    Arc,
    Ball,
    arc_from_to,
    beyond,
    lever,
    norm,
    reverse,
    turned_ball,
)
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, set_range, times, times_number, transposed_times


@inline
def moved(arm: BoxArm, laid: Laid, v: Vector, aligned: float) -> Ball:
    """Where joints before a wrist may turn a unit vector, or from where they may: each by its half width on its own."""
    off = aligned
    for j in range(laid.half.shape[0] - 3):
        if arm.wiring[j, ROTATES] == 1:
            off += laid.moves[j] * lever(vector(laid.axes[j]), v)
    return v, off


@inline
def moved_along(arm: BoxArm, laid: Laid, v: Vector, way: float, aligned: float, tied: Floats) -> Ball:
    """Where joints before a wrist turn a unit vector (``way`` 1), or from where they do (-1), to first order.

    ``tied`` (n, 3) tells how they go with each other, as ``contracted`` does.
    """
    middle, along, rest, sum_ = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), aligned, 0.0
    for j in range(laid.half.shape[0] - 3):
        if arm.wiring[j, ROTATES] == 1:
            c, scale, swing = arm.wiring[j, COLUMN], way * arm.joints[j, SCALE], cross(vector(laid.axes[j]), v)
            middle, along = (
                plus(middle, times_number(scale * tied[c, 0], swing)),
                plus(along, times_number(scale * tied[c, 1], swing)),
            )
            rest += abs(scale) * tied[c, 2] * norm(swing)
            sum_ += laid.half[j]
    to = plus(v, middle)
    long = norm(to)  # at least 1, as all swings are across v
    return times_number(1.0 / long, to), long - 1.0 + rest + norm(along) + 0.5 * sum_ * sum_


@inline
def back_of(laid: Laid, first: Ball) -> Ball:
    """Axis 1 of a wrist, turned by the joints before it, as the target's frame has it at the centre."""
    return transposed_times(laid.turn, first[0]), first[1]


@shared
def wrist_turns(
    arm: BoxArm, laid: Laid, centre: Floats, width: Floats, goal: Ball, back: Ball, most: int, turned: Floats
) -> int:
    """How the wrist inside the box turns its axis 3 to ``goal``, while it turns ``back`` to its axis 1.

    Returns in how many ways: it is bent to one side or to the other. ``turned`` (2, 9) gets, for up to ``most`` ways, a
    value of each of its coordinates, the least that they may have, and the greatest. Ways that overlap are one.
    """
    w = laid.half.shape[0] - 3
    k1, k2, k3 = vector(laid.axes[w]), vector(laid.axes[w + 1]), vector(laid.axes[w + 2])
    # The second joint: k1 . Rot(k2, turn) k3 = k1 . goal, so that a cos(turn) + b sin(turn) = rest, within spread.
    fixed, off = dot(k1, k2) * dot(k2, k3), goal[1]
    a, b, rest = dot(k1, k3) - fixed, dot(k1, cross(k2, k3)), dot(k1, goal[0]) - fixed
    size, spread = math.sqrt(a * a + b * b), min(off, lever(k1, goal[0]) * off + 0.5 * off * off)
    if size < ROUNDING:  # it can turn axis 3 nowhere else: nothing is known
        for k in range(3):
            c = arm.wiring[w + k, COLUMN]
            turned[0, k], turned[0, 3 + k], turned[0, 6 + k] = centre[c], centre[c] - width[c], centre[c] + width[c]
        return 1
    if abs(rest) - spread > size:
        return 0
    near, far = math.acos(min((rest + spread) / size, 1.0)), math.acos(max((rest - spread) / size, -1.0))
    middle, half, radius = math.atan2(b, a), 0.5 * (near + far), 0.5 * (far - near)
    ways = 0
    for way in range(2):
        t2: Arc = cos_sin(middle + (half if way == 0 else -half)), radius
        t1 = arc_from_to(k1, turned_ball(k2, t2, (k3, 0.0)), goal)
        t3 = arc_from_to(k3, back, turned_ball(k2, reverse(t2), (k1, 0.0)))
        here = turned[ways]
        fits = turns(arm, centre, width, w, t1, here[::3]) and turns(arm, centre, width, w + 1, t2, here[1::3])
        if fits and turns(arm, centre, width, w + 2, t3, here[2::3]):
            ways += 1
            if ways == most:
                return ways
    if ways == 2 and overlap(turned):
        for k in range(3):
            turned[0, 3 + k] = min(turned[0, 3 + k], turned[1, 3 + k])
            turned[0, 6 + k] = max(turned[0, 6 + k], turned[1, 6 + k])
        return 1
    return ways


@inline
def overlap(turned: Floats) -> bool:
    """Whether two ways to turn a wrist (2, 9) have something in common."""
    apart = False
    for k in range(3):
        apart = apart or turned[0, 3 + k] > turned[1, 6 + k] or turned[1, 3 + k] > turned[0, 6 + k]
    return not apart


@shared
def follow_first(arm: BoxArm, laid: Laid, box: Floats, aligned: float, found: Floats, part: Floats) -> bool:
    """Whether a wrist's second and third joint can turn as its first one, inside a box (2 n,), asks of them.

    That also tells of a wrist that may be straight. ``part`` (2 n,) gets what is left of the box; ``found`` (3,) is
    scratch.
    """
    n, w = box.shape[0] // 2, laid.half.shape[0] - 3
    k1, k2, k3 = vector(laid.axes[w]), vector(laid.axes[w + 1]), vector(laid.axes[w + 2])
    side = cross(k3, k2)
    side = times_number(1.0 / norm(side), side)
    t1: Arc = (1.0, 0.0), laid.half[w]
    t2 = arc_from_to(k2, (k3, 0.0), turned_ball(k1, t1, moved(arm, laid, vector(laid.target_axes[w + 2]), aligned)))
    back = turned_ball(k2, reverse(t2), turned_ball(k1, t1, moved(arm, laid, times(laid.turn, side), aligned)))
    copy(box, part)
    for k, arc in ((1, t2), (2, arc_from_to(k3, (side, 0.0), back))):
        if not turns(arm, box[:n], box[n:], w + k, arc, found):
            return False
        set_range(part, arm.wiring[w + k, COLUMN], found[1], found[2])
    return True


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
