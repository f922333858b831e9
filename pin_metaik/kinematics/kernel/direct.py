"""The closed form as a lane of its own: a pose in, a configuration out, if one of the branches is exactly there."""

from __future__ import annotations

from pin_metaik.compiled import Floats, inline, jit
from pin_metaik.kinematics.closed_form import DESCEND, DONE, SEARCH
from pin_metaik.kinematics.kernel.closed_form import Vector, first_branch, numbers_of
from pin_metaik.kinematics.kernel.descent import EXACT, Arm, Bounds
from pin_metaik.kinematics.kernel.desk import (
    NOWHERE,
    POSE,
    Desk,
    Quaternion,
    desk_for,
    laid_out,
    parts_of,
    read,
    write_end,
)
from pin_metaik.kinematics.kernel.forward import forward, pose_error
from pin_metaik.kinematics.kernel.layout import Entries, sizes_of, unpack

REFUSED = -1  # evaluations of what is no pose, or no configuration to start from


@inline
def stands_exactly(arm: Arm, task: Floats, x: Floats, lines: Floats, room: Floats) -> bool:
    """Whether the tip at x (n,) is on the target but for rounding: there is nothing left to descend."""
    joints, wiring, ends, tips = arm
    S = joints.shape[0]
    pose, error = room[:12], room[12:]
    forward(joints, wiring, ends[0], ends[1], tips[0], task[:12], x, lines[:S], lines[S:], pose)
    pose_error(pose, error)
    square = 0.0
    for j in range(6):
        square += error[j] * error[j]
    return square < EXACT


@inline
def take_branch(
    arm: Arm, bounds: Bounds, entries: Entries, form: Floats, target: Floats, desk: Desk, q: Floats
) -> tuple[int, int]:
    """Write the first branch that there is into q, if it is exactly there: evaluations, and what is left to do."""
    task, guess, start, best, room = laid_out(desk, bounds[0].shape[0])
    if not first_branch(form, arm[1], bounds, numbers_of(target), guess, start):
        return 0, SEARCH
    for c in range(start.shape[0]):
        best[c] = min(max(start[c], bounds[0][c]), bounds[1][c])
    if not stands_exactly(arm, task, best, desk[1], room):
        return 1, DESCEND
    write_end(best, entries, q)
    return 1, DONE


@inline
def directly(block: Floats, target: Floats, q: Floats, desk: Desk) -> int:
    """What is left to do: DONE, if a branch is exactly there and q written; or REFUSED."""
    arm, bounds, entries, _, form = unpack(block)
    task, guess, _, _, _ = laid_out(desk, bounds[0].shape[0])
    if not read(target, q, entries, task, guess):
        return REFUSED
    return take_branch(arm, bounds, entries, form, target, desk, q)[1]


@jit(f"Tuple((i8, UniTuple(f8, 3), UniTuple(f8, 4)))(f8[::1], {POSE}, f8[::1])")
def solve_directly(block: Floats, target: Floats, q: Floats) -> tuple[int, Vector, Quaternion]:
    """One evaluation of ``lane.solve_pose`` for an arm with a closed form, in less than its time to be called.

    Returns DONE if the target (4, 4) is met by q (nq,), DESCEND if a branch is nearly there, SEARCH if there is none,
    or REFUSED; and the target's position and quaternion.
    """
    S, n = sizes_of(block)
    todo = directly(block, target, q, desk_for(n, S))
    position, turn = NOWHERE if todo == REFUSED else parts_of(target)
    return todo, position, turn
