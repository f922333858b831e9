"""Branch and bound over boxes of joint coordinates: a proof that a pose is out of reach, or where it may be met.

A box that a test excludes is done with; another is split in two, depth first, in the coordinate that keeps the tests
from excluding most. When none is left, no configuration inside the limits reaches the target: that is proved. A box
whose sides are all short is kept as a place to descend from. There is no randomness in it.

Where all solutions are asked for, boxes are also shrunk around what may be in them; those of an arm with a wrist have a
loop of their own, ``box_wrist_search``.
"""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.closed_form import vector
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES
from pin_metaik.kinematics.proofs.box import SPLIT, BoxArm, laid_for, lay
from pin_metaik.kinematics.proofs.box_balls import excluded_by_balls
from pin_metaik.kinematics.proofs.box_contract import contracted, first_joint_turned
from pin_metaik.kinematics.proofs.box_linear import separated, to_first_order
from pin_metaik.kinematics.proofs.box_wrist import back_of, moved, wrist_turns

FIRST_ORDER = 3.0  # rad, sum of the half widths up to which the series is worth looking at
SMALL = 0.5  # rad, the same sum, below which pairs of axes tell little that shrinking does not
SHRUNK = 0.75  # of the sum of its half widths, below which a box that was shrunk is looked at anew
FINER = 0.03  # of the least half width: that of the other joints before those of a wrist that may be straight are split

ARM = "f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], i8[::1]"


@inline
def middle_joint(arm: BoxArm, half: Floats, last: int, total: float) -> int:
    """The joint after which the chain is cut: half of the uncertainty is on either side."""
    cut, sum_ = 0, 0.0
    for k in range(last):
        sum_ += half[k] if arm.wiring[k, ROTATES] == 1 else 0.0
        if sum_ <= 0.5 * total:
            cut = k
    return cut


@jit(f"UniTuple(i8, 3)({ARM}, f8[::1], f8, f8, f8[:,::1], i8, f8, i8, f8[:,::1])")
def cover(
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
    """Exclude what can be excluded of some boxes of configurations: boxes looked at, leaves, and boxes still waiting.

    Args:
        joints: The arm's arrays, down to ``wrist``; see ``BoxArm``.
        wiring: ...
        knots: ...
        tip: ...
        lower: ...
        upper: ...
        reach: ...
        wrist: ...
        target: (12,) pose of the tip.
        near: How far (m) from it the tip may be.
        aligned: By how much (rad) it may be turned.
        waiting: (DEPTH, 2 n) centres and half widths; its first rows are the boxes to begin with, and in the end those
            that are still to be looked at: another call goes on with them.
        count: How many they are.
        least: Half width (rad or m) below which a box is kept instead of split.
        boxes: How many to look at, at most.
        leaves: (l + 1, 2 n) gets centres and half widths of the boxes that are kept. The search stops after l.

    Returns:
        With none waiting and no leaf it is proved that nothing in the boxes reaches the target; with leaves, that
        nothing outside of them does.
    """
    arm = BoxArm(joints, wiring, knots, tip, lower, upper, reach, wrist)
    n, S = lower.shape[0], joints.shape[0]
    has_wrist = wrist[0] > 0
    last = S - 3 if has_wrist else S  # joints that are split
    centre, width, start, weights, way = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    rows, columns, splits = np.empty((S, 6)), np.empty((n, 6)), np.zeros(n, np.int64)
    laid = laid_for(S, last + 1 if has_wrist else S)
    for k in range(last):
        splits[wiring[k, COLUMN]] = 1
    shrinks, system, turned, tied = wrist[1] > 0, np.empty((9, n + 6)), np.empty((2, 9)), np.empty((n, 3))
    straight = wrist[1] == SPLIT
    looked = kept = 0
    while count > 0:
        if looked >= boxes or kept >= leaves.shape[0] - 1 or count + 1 > waiting.shape[0]:
            break
        looked += 1
        count -= 1
        box = waiting[count]
        for c in range(n):
            centre[c], width[c] = box[c], box[n + c]
            start[c] = centre[c]
        lay(arm, target, centre, width, laid)
        total = whole = 0.0
        for k in range(S):
            half = laid.half[k] if wiring[k, ROTATES] == 1 else 0.0
            whole += half
            total += half if k < last else 0.0
        first = last if has_wrist and not shrinks else 0
        if excluded_by_balls(arm, laid, near, aligned, first, total > SMALL or not shrinks, weights):
            continue
        alone, left = has_wrist and not (straight and whole < FIRST_ORDER), 1.0
        if total < FIRST_ORDER:
            cut = last - 1 if alone else middle_joint(arm, laid.half, S, whole)
            b = to_first_order(arm, laid, near, aligned, cut, alone, rows, columns)
            if separated(columns, b, width, way):
                continue
            left = contracted(columns, b, 3 if alone else 6, centre, width, system, tied) if shrinks else 1.0
            if left == 0.0:
                continue
            if left < SHRUNK and widest(width, splits, 1, least) >= 0:
                put(centre, width, box)
                count += 1
                continue
        if has_wrist:
            goal = moved(arm, laid, vector(laid.target_axes[S - 1]), aligned)
            back = back_of(laid, moved(arm, laid, vector(laid.axes[last]), aligned))
            if wrist_turns(arm, laid, start, box[n:], goal, back, 1, turned) == 0:
                continue
            for k in range(3):
                start[wiring[last + k, COLUMN]] = turned[0, k]
        if shrinks and has_wrist and wiring[0, ROTATES] == 1:
            if not first_joint_turned(arm, laid, near, box, centre, width, system[0]):
                continue
            weights[wiring[0, COLUMN]] = 0.0
        at = -1
        for c in range(n):
            if splits[c] == 1 and width[c] > least and (at < 0 or weights[c] > weights[at]):
                at = c
        if at < 0 and straight:
            at = widest(width, splits, 1, FINER * least)
            at = widest(width, splits, 0, least) if at < 0 else at
        if at >= 0:
            halve(centre, width, at, waiting[count : count + 2])
            count += 2
        else:
            put(centre if shrinks else start, width, leaves[kept])
            kept += 1
    return looked, kept, count


@inline
def put(centre: Floats, width: Floats, box: Floats) -> None:
    """Write a centre (n,) and half widths (n,) as a box (2 n,)."""
    n = centre.shape[0]
    for c in range(n):
        box[c], box[n + c] = centre[c], width[c]


@inline
def halve(centre: Floats, width: Floats, at: int, boxes: Floats) -> None:
    """Write both halves of a box, split in one coordinate, as boxes (2, 2 n)."""
    for side in range(2):
        put(centre, width, boxes[side])
        half = 0.5 * width[at]
        boxes[side, centre.shape[0] + at] = half
        boxes[side, at] += half if side == 1 else -half


@inline
def widest(width: Floats, splits: Ints, kind: int, least: float) -> int:
    """The coordinate with the greatest half width of those of a kind that are above ``least``; -1: there is none."""
    at = -1
    for c in range(width.shape[0]):
        if splits[c] == kind and width[c] > least and (at < 0 or width[c] > width[at]):
            at = c
    return at
