"""Branch and bound over boxes of joint coordinates: a proof that a pose is out of reach, or where it may be met.

A box that a test excludes is done with; another is split in two, depth first, in the coordinate that keeps the tests
from excluding most. When none is left, no configuration inside the limits reaches the target: that is proved. A box
whose sides are all short is kept as a place to descend from. There is no randomness in it.
"""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES
from pin_metaik.kinematics.proofs.box import BoxArm, laid_for, lay
from pin_metaik.kinematics.proofs.box_balls import excluded_by_balls
from pin_metaik.kinematics.proofs.box_linear import excluded_to_first_order
from pin_metaik.kinematics.proofs.box_wrist import excluded_by_wrist

FIRST_ORDER = 3.0  # rad, sum of the half widths up to which the series is worth looking at

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
        leaves: (l, 2 n) gets centres and half widths of the boxes that are kept. When it is full the search stops.

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
    laid = laid_for(S)
    for k in range(last):
        splits[wiring[k, COLUMN]] = 1
    looked = kept = 0
    while count > 0:
        if looked >= boxes or kept == leaves.shape[0] or count + 1 > waiting.shape[0]:
            break
        looked += 1
        count -= 1
        for c in range(n):
            centre[c], width[c] = waiting[count, c], waiting[count, n + c]
            start[c] = centre[c]
        lay(arm, target, centre, width, laid)
        if excluded_by_balls(arm, laid, near, aligned, weights):
            continue
        if has_wrist and excluded_by_wrist(arm, laid, centre, width, aligned, start):
            continue
        total = 0.0
        for k in range(last):
            total += laid.half[k] if wiring[k, ROTATES] == 1 else 0.0
        if total < FIRST_ORDER:
            cut = last - 1 if has_wrist else middle_joint(arm, laid.half, last, total)
            if excluded_to_first_order(arm, laid, width, near, aligned, cut, has_wrist, rows, columns, way):
                continue
        at = -1
        for c in range(n):
            wide = splits[c] == 1 and width[c] > least
            if wide and (at < 0 or weights[c] > weights[at]):
                at = c
        if at < 0 and wrist[0] == 2:
            for s in range(last, S):
                c = wiring[s, COLUMN]
                if width[c] > least and (at < 0 or width[c] > width[at]):
                    at = c
        if at < 0:
            for c in range(n):
                leaves[kept, c], leaves[kept, n + c] = centre[c] if wrist[0] == 2 else start[c], width[c]
            kept += 1
            continue
        for side in range(2):
            for c in range(n):
                waiting[count, c], waiting[count, n + c] = centre[c], width[c]
            half = 0.5 * width[at]
            waiting[count, n + at] = half
            waiting[count, at] += half if side == 1 else -half
            count += 1
    return looked, kept, count
