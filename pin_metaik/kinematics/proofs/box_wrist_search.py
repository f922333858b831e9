"""Branch and bound for all solutions of an arm with a wrist: of its joints only those before the wrist are split.

A box is shrunk around what may be in it, again and again while that tells much, and then split. What is kept has the
ranges of the wrist's joints, too: one box for each of the two ways to bend it. Where the wrist may be straight, these
ranges are wide; there the other joints are split until they are short, and then those of the wrist as well.

Where four joints place the wrist as ``box_shoulder`` says, they follow from the first one, which is split first: of
200 poses of a Panda 1,000 boxes each are looked at in the median, and 4,600 if nothing is known of a shoulder.
"""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.closed_form import vector
from pin_metaik.kinematics.kernel.forward import copy
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES
from pin_metaik.kinematics.proofs.box import BoxArm, Laid, laid_for, lay, set_range
from pin_metaik.kinematics.proofs.box_balls import excluded_by_balls
from pin_metaik.kinematics.proofs.box_contract import contracted, first_joint_turned
from pin_metaik.kinematics.proofs.box_linear import separated, to_first_order
from pin_metaik.kinematics.proofs.box_search import ARM, SMALL, halve, middle_joint, put
from pin_metaik.kinematics.proofs.box_shoulder import shoulder_turns
from pin_metaik.kinematics.proofs.box_wrist import back_of, follow_first, moved, moved_along, wrist_turns

FIRST_ORDER = 1.5  # rad, sum of the half widths before the wrist up to which the series is worth looking at
ALL = 1.0  # rad, sum of all half widths up to which that of all joints is
SHRUNK = 0.85  # of the sum of its half widths, below which a box that was shrunk is looked at anew
FINER = 0.05  # of the least half width: sum of those before the wrist, below which its joints are split, too
LEADING = 8.0  # how many times the width of the joint counts from which the others follow
PARTS = 8  # into which a box is taken apart at most


@inline
def sum_of_widths(arm: BoxArm, box: Floats, first: int, last: int) -> float:
    """Sum of the half widths of joints from a first to before a last one."""
    sum_ = 0.0
    for k in range(first, last):
        sum_ += box[box.shape[0] // 2 + arm.wiring[k, COLUMN]]
    return sum_


@inline
def turns_of(arm: BoxArm, laid: Laid, last: int) -> float:
    """By how much joints before a last one turn the chain, rad."""
    sum_ = 0.0
    for k in range(last):
        sum_ += laid.half[k] if arm.wiring[k, ROTATES] == 1 else 0.0
    return sum_


@inline
def shrank(arm: BoxArm, box: Floats, parts: Floats, count: int, first: int, last: int) -> bool:
    """Whether no part (2 n,) of a box is nearly as wide as it is, in joints from a first to before a last one."""
    for i in range(count):
        if sum_of_widths(arm, parts[i], first, last) > SHRUNK * sum_of_widths(arm, box, first, last):
            return False
    return True


@inline
def heaviest(arm: BoxArm, width: Floats, weights: Floats, joints: int, least: float) -> int:
    """The coordinate of most weight that one of the first joints has and that is wider than ``least``; -1: none is."""
    at = -1
    for k in range(joints):
        c = arm.wiring[k, COLUMN]
        if width[c] > least and (at < 0 or weights[c] > weights[at]):
            at = c
    return at


@inline
def put_back(parts: Floats, some: int, waiting: Floats, count: int) -> int:
    """Put some parts of a box where boxes wait; how many do then."""
    for i in range(some):
        copy(parts[i], waiting[count + i])
    return count + some


@inline
def range_widely(turned: Floats, ways: int, least: float) -> bool:
    """Whether half the range of a wrist's joint, of which ``turned`` (2, 9) tells, is above ``least`` for some bend."""
    for way in range(ways):
        for k in range(3):
            if turned[way, 6 + k] - turned[way, 3 + k] > 2.0 * least:
                return True
    return False


@inline
def keep(arm: BoxArm, centre: Floats, width: Floats, turned: Floats, ways: int, leaves: Floats, kept: int) -> int:
    """Keep a box with the ranges of a wrist's joints, of which ``turned`` (2, 9) tells, for each bend; how many are."""
    for way in range(ways):
        put(centre, width, leaves[kept])
        for k in range(3):
            c = arm.wiring[arm.wiring.shape[0] - 3 + k, COLUMN]
            set_range(leaves[kept], c, turned[way, 3 + k], turned[way, 6 + k])
        kept += 1
    return kept


@jit(f"UniTuple(i8, 3)({ARM}, f8[::1], f8, f8, f8[:,::1], i8, f8, i8, f8[:,::1])")
def cover_with_wrist(
    joints: Floats,
    wiring: Ints,
    knots: Floats,
    tip: Floats,
    lower: Floats,
    upper: Floats,
    reach: Floats,
    wrist: Ints,
    target: Floats,
    near: float,
    aligned: float,
    waiting: Floats,
    count: int,
    least: float,
    boxes: int,
    leaves: Floats,
) -> tuple[int, int, int]:
    """``cover`` for all solutions of an arm with a wrist."""
    arm = BoxArm(joints, wiring, knots, tip, lower, upper, reach, wrist)
    n, S = lower.shape[0], joints.shape[0]
    w = S - 3
    has_shoulder = wrist[2] == 1
    leading = wiring[0, COLUMN] if has_shoulder else -1
    centre, width, weights, way = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    rows, columns, system, tied = np.empty((S, 6)), np.empty((n, 6)), np.empty((9, n + 6)), np.empty((n, 3))
    laid, turned, found, parts = laid_for(S, w + 1), np.empty((2, 9)), np.empty((4, 2, 3)), np.empty((PARTS, 2 * n))
    looked = kept = 0
    while count > 0:
        if looked >= boxes or kept >= leaves.shape[0] - 1 or count + PARTS > waiting.shape[0]:
            break
        looked += 1
        count -= 1
        box = waiting[count]
        widest = 0.0
        for c in range(n):
            centre[c], width[c] = box[c], box[n + c]
            widest = max(widest, width[c])
        lay(arm, target, centre, width, laid)
        before, whole = sum_of_widths(arm, box, 0, w), sum_of_widths(arm, box, 0, S)
        short, shrinks, series = before < FINER * least, widest > least, turns_of(arm, laid, w) < FIRST_ORDER
        if has_shoulder:
            some = shoulder_turns(arm, laid, near, box, found, parts)
            if some == 0 or (shrinks and shrank(arm, box, parts, some, 0, w)):
                count = put_back(parts, some, waiting, count)
                continue
            copy(width, weights)
            weights[leading] *= LEADING
        elif excluded_by_balls(arm, laid, near, aligned, 0, turns_of(arm, laid, w) > SMALL, weights):
            continue
        if short and laid.half[w] < 1.0:
            if not follow_first(arm, laid, box, aligned, found[0, 0], parts[0]):
                continue
            if shrinks and shrank(arm, box, parts, 1, w + 1, S):
                count = put_back(parts, 1, waiting, count)
                continue
        together = short and whole < ALL
        goal, first = vector(laid.target_axes[S - 1]), vector(laid.axes[w])
        if series:
            cut = middle_joint(arm, laid.half, S, whole) if together else w - 1
            b = to_first_order(arm, laid, near, aligned, cut, not together, rows, columns)
            if not has_shoulder and separated(columns, b, width, way):
                continue
            left = contracted(columns, b, 6 if together else 3, centre, width, system, tied)
            if left == 0.0:
                continue
            if left < SHRUNK and shrinks:
                put(centre, width, box)
                count += 1
                continue
        if series and not together:
            to = moved_along(arm, laid, goal, -1.0, aligned, tied)
            back = back_of(laid, moved_along(arm, laid, first, 1.0, aligned, tied))
        else:
            to, back = moved(arm, laid, goal, aligned), back_of(laid, moved(arm, laid, first, aligned))
        ways = wrist_turns(arm, laid, box[:n], box[n:], to, back, 2, turned)
        if ways == 0:
            continue
        if not has_shoulder and wiring[0, ROTATES] == 1:
            if not first_joint_turned(arm, laid, near, box, centre, width, system[0]):
                continue
            weights[wiring[0, COLUMN]] = 0.0
        wide = heaviest(arm, width, width, w, least) >= 0
        if not wide and not range_widely(turned, ways, least):
            kept = keep(arm, centre, width, turned, ways, leaves, kept)
            continue
        if has_shoulder and not short:
            at = heaviest(arm, width, weights, w, 0.0)
        elif wide:
            at = heaviest(arm, width, weights, w, least)
        else:
            at = heaviest(arm, width, width, S if short else w, 0.0)
        halve(centre, width, at, waiting[count : count + 2])
        count += 2
    return looked, kept, count
