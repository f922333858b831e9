"""A box made smaller around the solutions in it, to first order.

The equations |A d - b| <= 1 of ``box_linear`` are solved for as many coordinates as they have rows, those that they say
most of: a row u of the inverse turns them into d_c = u . b - sum_j (u . A_j) d_j, for the other coordinates j, give or
take |u_p| + |u_o|. That holds for any u, so that the inverse need not be exact. A box around an isolated solution
shrinks quadratically, one around a curve to a piece of a tube along it.
"""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline, shared
from pin_metaik.kinematics.kernel.closed_form import minus, vector
from pin_metaik.kinematics.kernel.layout import COLUMN
from pin_metaik.kinematics.proofs.balls import arc_from_to
from pin_metaik.kinematics.proofs.box import PAD, BoxArm, Laid
from pin_metaik.kinematics.proofs.box_linear import Equations
from pin_metaik.kinematics.proofs.box_wrist import turns

LEAST = 1e-3  # of tolerance and remainder: what a whole coordinate moves if the equations are to be solved for it


@shared
def contracted(
    columns: Floats,
    b: Equations,
    equations: int,
    centre: Floats,
    width: Floats,
    system: Floats,
    tied: Floats,
) -> float:
    """Shrink a box to what the equations leave of it, in place.

    Args:
        columns: (n, 6) A by coordinate.
        b: The right side.
        equations: How many of them say anything: 3, those of the place, or 6.
        centre: (n,) of the box.
        width: (n,) its half widths.
        system: (9, n + 6) scratch.
        tied: (n, 3) gets what the equations say of the coordinates in the box as it was: each is the first number, and
            the second one times a number between -1 and 1, the same for all, within the third.

    Returns:
        What is left of the sum of the half widths that they are about, as a share; 0 if nothing can be in the box.
    """
    n, E = width.shape[0], equations
    low, high, solved = system[6], system[7], system[8]
    for r in range(E):
        for c in range(n):
            system[r, c] = columns[c, r]
        for k in range(E):
            system[r, n + k] = 1.0 if r == k else 0.0
    for c in range(n):
        low[c], high[c] = -width[c], width[c]
    rank = eliminated(system, E, width, solved)
    free = tie_to_one(columns, rank, solved, width, tied)
    for r in range(rank):
        c = int(solved[r])
        slope = middle = place = turn = 0.0
        for k in range(E):
            u = system[r, n + k]
            slope += u * columns[c, k]
            middle += u * b[k]
            if k < 3:
                place += u * u
            else:
                turn += u * u
        if slope < 0.5:  # it is 1 but for rounding
            continue
        least = most = middle
        along = rest = 0.0
        for j in range(n):
            if j != c:
                share = 0.0
                for k in range(E):
                    share += system[r, n + k] * columns[j, k]
                if j == free:
                    along = -share * width[j]
                else:
                    rest += abs(share) * width[j]
                least -= max(share * low[j], share * high[j])
                most -= min(share * low[j], share * high[j])
        spread = math.sqrt(place) + math.sqrt(turn)
        if rest + spread < slope * width[c]:
            tied[c, 0], tied[c, 1], tied[c, 2] = middle / slope, along / slope, (rest + spread) / slope + PAD
        low[c], high[c] = max(low[c], (least - spread) / slope - PAD), min(high[c], (most + spread) / slope + PAD)
        if low[c] > high[c]:
            return 0.0
    before = after = 0.0
    for c in range(n):
        left = 0.5 * (high[c] - low[c])
        for k in range(6):
            if columns[c, k] != 0.0:
                before, after = before + width[c], after + left
                break
        centre[c], width[c] = centre[c] + 0.5 * (low[c] + high[c]), left
    return max(after / before, PAD) if before > 0.0 else 1.0


@inline
def tie_to_one(columns: Floats, rank: int, solved: Floats, width: Floats, tied: Floats) -> int:
    """The widest coordinate that is not solved for, to which the others are tied; -1: there is none.

    ``tied`` (n, 3) is written for all as if nothing was known but their half widths (n,); see ``contracted``.
    """
    free = -1
    for c in range(width.shape[0]):
        tied[c, 0], tied[c, 1], tied[c, 2] = 0.0, 0.0, width[c]
        counts = False
        for k in range(6):
            counts = counts or columns[c, k] != 0.0
        for r in range(rank):
            counts = counts and int(solved[r]) != c
        if counts and (free < 0 or width[c] > width[free]):
            free = c
    if free >= 0:
        tied[free, 1], tied[free, 2] = width[free], 0.0
    return free


@shared
def eliminated(system: Floats, E: int, width: Floats, solved: Floats) -> int:
    """Solve [A | I] (E, n + E) for coordinates that move much within their half widths (n,); for how many.

    The row that is solved for a coordinate, whose number goes into ``solved`` (E,), is divided by its pivot.
    """
    n = width.shape[0]
    for r in range(E):
        at, column, largest = r, -1, 0.0
        for i in range(r, E):
            for c in range(n):
                size = system[i, c] ** 2 * width[c]
                if size > largest and abs(system[i, c]) * width[c] > LEAST:
                    at, column, largest = i, c, size
        if column < 0:
            return r
        solved[r] = column
        for j in range(n + E):
            system[r, j], system[at, j] = system[at, j], system[r, j]
        inverse = 1.0 / system[r, column]
        for j in range(n + E):
            system[r, j] *= inverse
        for i in range(E):
            factor = system[i, column]
            if i != r and factor != 0.0:
                for j in range(n + E):
                    system[i, j] -= factor * system[r, j]
    return E


@shared
def first_joint_turned(
    arm: BoxArm, laid: Laid, near: float, box: Floats, centre: Floats, width: Floats, turned: Floats
) -> bool:
    """Shrink a box, in place, to turns of its first joint that bring a wrist's point to the target; False: none does.

    ``box`` (2 n,) is what it was when the chain was laid, ``centre`` and ``width`` (n,) what was left of it since;
    ``turned`` is scratch.
    """
    n, w, c = width.shape[0], laid.half.shape[0] - 3, arm.wiring[0, COLUMN]
    z, o, room = vector(laid.axes[0]), vector(laid.points[0]), 0.0
    for j in range(1, w):
        room += laid.moves[j] * laid.distances[w, j]
    here, there = minus(vector(laid.points[w]), o), minus(vector(laid.target_points[w]), o)
    arc = arc_from_to(z, (here, room), (there, near + arm.reach[1]))
    if not turns(arm, box[:n], box[n:], 0, arc, turned):
        return False
    lower, upper = max(turned[1], centre[c] - width[c]), min(turned[2], centre[c] + width[c])
    if lower > upper + PAD:
        return False
    centre[c], width[c] = 0.5 * (lower + upper), max(0.5 * (upper - lower), 0.0) + PAD
    return True
