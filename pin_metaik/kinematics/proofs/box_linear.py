"""What reaching the target says of a box to first order, with the remainder of the series bounded.

The chain is cut after joint s, in a point P of link s. With d the way from the centre, A P and the orientation after
joint s are reached from the world and from the target; to first order

    sum_{i <= s} d_i z_i x (P - o_i) + sum_{i > s} d_i z'_i x (P' - o'_i) = P' - P
    sum_{i <= s} d_i z_i + sum_{i > s} d_i vee(skew([z'_i] R)) = vee(skew(R)),   vee(skew([z] R)) = (tr(R) z - R z) / 2

with R the rotation of D, and a slide along z_i in the first line alone. Terms of second order are bounded one by one,
those of third by (sum of half widths)^3 / 6. Divided by its remainder and tolerance, each line says |A d - b| <= 1. A
direction w = (w_p, w_o) with w . b - sum_c |w . A_c| width_c > |w_p| + |w_o| proves that no d in the box meets both.
What a few sweeps of coordinate descent leave of A d - b is taken for w.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from pin_metaik.compiled import Floats, shared
from pin_metaik.kinematics.kernel.closed_form import cross, dot, minus, vector
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE
from pin_metaik.kinematics.proofs.balls import norm
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, times, write

SWEEPS, LOOK, SETTLED = 12, 3, 0.02  # sweeps, how often the direction is tried, share of a width that is no move


Equations: TypeAlias = tuple[float, float, float, float, float, float]


@shared
def to_first_order(
    arm: BoxArm, laid: Laid, near: float, aligned: float, cut: int, place_alone: bool, rows: Floats, columns: Floats
) -> Equations:
    """The equations of a cut after joint ``cut``: ``columns`` (n, 6) gets A by coordinate, b is returned.

    ``place_alone``: at the wrist's point, where only the joints before it and only the place count. ``rows`` (S, 6) is
    scratch.
    """
    S = laid.half.shape[0] - 3 if place_alone else laid.half.shape[0]
    at = S if place_alone else cut
    P, there, R = vector(laid.points[at]), vector(laid.target_points[at]), laid.turn
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    twist = min(math.sqrt(max(3.0 - trace, 0.0)), 1.0)  # |R - I|, or what bounds the terms without it
    place, lean = near + arm.reach[1] if place_alone else near, aligned
    before = after = slid = 0.0
    for i in range(S):
        here = i <= cut
        z = vector(laid.axes[i]) if here else vector(laid.target_axes[i])
        arms = minus(P, vector(laid.points[i])) if here else minus(there, vector(laid.target_points[i]))
        if arm.wiring[i, ROTATES] == 1:
            swing = cross(z, arms)
            write(swing, rows[i, :3])
            if here:
                write(z, rows[i, 3:])
                before += laid.half[i]
            else:
                turned = times(R, z)
                write(
                    (
                        0.5 * (trace * z[0] - turned[0]),
                        0.5 * (trace * z[1] - turned[1]),
                        0.5 * (trace * z[2] - turned[2]),
                    ),
                    rows[i, 3:],
                )
                after += laid.half[i]
                lean += 0.5 * laid.half[i] ** 2 * twist
            place += 0.5 * laid.half[i] ** 2 * norm(swing)
        else:
            write(z, rows[i, :3])
            rows[i, 3:] = 0.0
            slid += laid.half[i]
    for j in range(S):
        here = j <= cut
        for i in range(0 if here else j + 1, j if here else S):  # joints that carry joint j
            if arm.wiring[i, ROTATES] == 1:
                z = vector(laid.axes[i]) if here else vector(laid.target_axes[i])
                place += laid.half[i] * laid.half[j] * norm(cross(z, vector(rows[j, :3])))
                if arm.wiring[j, ROTATES] == 1:
                    other = vector(laid.axes[j]) if here else vector(laid.target_axes[j])
                    lean += laid.half[i] * laid.half[j] * (0.5 * norm(cross(z, other)) + (0.0 if here else twist))
    cubes = (before**3 + after**3) / 6.0
    place += cubes * arm.reach[0] + 0.5 * slid * (before * before + after * after)
    lean += cubes
    by_place, by_turn = 1.0 / place, 0.0 if place_alone else 1.0 / lean
    b = (
        by_place * (there[0] - P[0]),
        by_place * (there[1] - P[1]),
        by_place * (there[2] - P[2]),
        by_turn * 0.5 * (R[2, 1] - R[1, 2]),
        by_turn * 0.5 * (R[0, 2] - R[2, 0]),
        by_turn * 0.5 * (R[1, 0] - R[0, 1]),
    )
    columns[:, :] = 0.0
    for i in range(S):
        c, scale = arm.wiring[i, COLUMN], arm.joints[i, SCALE]
        for k in range(3):
            columns[c, k] += scale * by_place * rows[i, k]
            columns[c, 3 + k] += scale * by_turn * rows[i, 3 + k]
    return b


@shared
def separated(columns: Floats, b: Equations, width: Floats, way: Floats) -> bool:
    """Whether |A d - b| <= 1 for the place and for the turn has no solution |d| <= width: proved by a direction.

    ``columns`` (n, 6) is A by coordinate; ``way`` (n,) gets the last d.
    """
    n = width.shape[0]
    p, o = (b[0], b[1], b[2]), (b[3], b[4], b[5])  # b - A d
    way[:] = 0.0
    for sweep in range(SWEEPS):
        moved = 0.0
        for c in range(n):
            a_p, a_o = vector(columns[c, :3]), vector(columns[c, 3:])
            square = dot(a_p, a_p) + dot(a_o, a_o)
            if square == 0.0 or width[c] == 0.0:
                continue
            to = min(max(way[c] + (dot(a_p, p) + dot(a_o, o)) / square, -width[c]), width[c])
            step = to - way[c]
            way[c] = to
            moved = max(moved, abs(step) / width[c])
            p = p[0] - step * a_p[0], p[1] - step * a_p[1], p[2] - step * a_p[2]
            o = o[0] - step * a_o[0], o[1] - step * a_o[1], o[2] - step * a_o[2]
        if norm(p) <= 1.0 and norm(o) <= 1.0:
            return False
        if sweep % LOOK == LOOK - 1 or moved < SETTLED:
            side = b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + b[3] * o[0] + b[4] * o[1] + b[5] * o[2]
            for c in range(n):
                side -= width[c] * abs(dot(vector(columns[c, :3]), p) + dot(vector(columns[c, 3:]), o))
            if side > norm(p) + norm(o):
                return True
        if moved < SETTLED:
            return False
    return False
