"""The compiled fast lane: poses in, configurations out, with nothing in between that Python would have to do."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.closed_form import DESCEND, DONE, SEARCH
from pin_metaik.kinematics.kernel.closed_form import Vector, numbers_of
from pin_metaik.kinematics.kernel.descent import Work, descend_from, workspace
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
    write_world,
)
from pin_metaik.kinematics.kernel.direct import REFUSED, take_branch
from pin_metaik.kinematics.kernel.layout import sizes_of, unpack, unpack_atlas
from pin_metaik.kinematics.kernel.multistart import search
from pin_metaik.kinematics.kernel.warm_starts import Looks, lookup_space
from pin_metaik.kinematics.reach import ROUNDING

POSITION = np.array([[0, 0], [0, 1], [0, 2]])  # the rows that count where orientation is free


@inline
def misshape(task: Floats) -> float:
    """By how much (relative) the rotation of a target may stretch a vector: |R R' - I|."""
    square = 0.0
    for i in range(3):
        for j in range(3):
            dot = -1.0 if i == j else 0.0
            for k in range(3):
                dot += task[3 * i + k] * task[3 * j + k]
            square += dot * dot
    return math.sqrt(square)


@inline
def out_of_reach(task: Floats, reach: Floats) -> bool:
    """Whether every pose in the tolerances is proved to be farther away, or nearer, than the links can span."""
    square = lever = 0.0
    for i in range(3):  # the tip's point in the target frame, less the world's point there
        away = reach[3 + i] - task[9 + i]
        for j in range(3):
            away -= task[3 * i + j] * reach[j]
        square += away * away
        lever += reach[3 + i] * reach[3 + i]
    distance = math.sqrt(square)
    allowed = ROUNDING + task[24] + (math.sqrt(lever) * task[25] if lever > 0.0 else 0.0)
    if reach[6] - 1.01 * allowed <= distance <= reach[7] + 1.01 * allowed:
        return False
    allowed += math.sqrt(lever) * misshape(task)
    return bool(distance > reach[7] + 1.01 * allowed or distance < reach[6] - 1.01 * allowed)


@inline
def begin(block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats, desk: Desk) -> tuple[int, int]:
    """Do for a target what needs no search: returns evaluations, and what is left to do for ``go_on``."""
    arm, bounds, entries, reach, form = unpack(block)
    task, guess, _, _, _ = laid_out(desk, bounds[0].shape[0])
    if not read(target, q, entries, task, guess):
        return REFUSED, DONE
    for i in range(6):
        task[12 + i], task[18 + i] = 0.0 if i < 3 or rows is None else np.inf, 1.0
    task[24], task[25] = 0.999 * settings[4], 0.999 * settings[5]
    if out_of_reach(task, reach):
        return 0, DONE
    if rows is not None or form.shape[0] == 0:
        return 0, SEARCH
    return take_branch(arm, bounds, entries, form, target, desk, q)


@inline
def go_on(
    block: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    q: Floats,
    desk: Desk,
    begun: tuple[int, int],
    work: Work,
    looks: Looks,
) -> int:
    """Descend from the branch that ``begin`` found, if it did, then ``search``; returns all evaluations."""
    arm, bounds, entries, _, form = unpack(block)
    task, guess, start, best, _ = laid_out(desk, bounds[0].shape[0])
    tasks = task.reshape(1, 26)
    descent, most = (settings[0], settings[1], int(settings[2])), int(settings[3])
    few, far = int(settings[7]), settings[8]
    (spent, todo), met = begun, False
    if todo == SEARCH and rows is None and form.shape[0] > 0:
        most = min(most, int(settings[6]))
    if todo == DESCEND:
        steps, met, _ = descend_from(arm, tasks, rows, bounds, start, descent, most, np.inf, best, work)
        spent += steps
    if not met:
        atlas = unpack_atlas(block)
        patience = most - spent, few - spent, far
        spent += search(arm, tasks, rows, bounds, atlas, guess, starts, descent, patience, best, work, looks)[0]
    write_end(best, entries, q)
    return spent


HOW = "f8[::1], i8[:,::1]?, f8[:,::1], f8[::1]"  # block, rows, starts, settings


@jit(f"Tuple((i8, UniTuple(f8, 3), UniTuple(f8, 4)))({HOW}, {POSE}, f8[::1])")
def solve_pose(
    block: Floats, rows: Ints | None, starts: Floats, settings: Floats, target: Floats, q: Floats
) -> tuple[int, Vector, Quaternion]:
    """``solve_poses`` for one target (4, 4) and one q (nq,); returns evaluations, and the target's parts."""
    S, n = sizes_of(block)
    desk = desk_for(n, S)
    spent, todo = begin(block, rows, settings, target, q, desk)
    if todo != DONE:
        work, looks = workspace(n, rows, S), lookup_space(n, 1)
        spent = go_on(block, rows, starts, settings, q, desk, (spent, todo), work, looks)
    position, turn = NOWHERE if spent == REFUSED else parts_of(target)
    return spent, position, turn


@jit(f"void({HOW}, f8[:,:,::1], f8[:,::1], i8[::1])")
def solve_poses(
    block: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    targets: Floats,
    q: Floats,
    evaluations: Ints,
) -> None:
    """Search for the poses (k, 4, 4) of one tip, each on its own; with the rows ``POSITION``, for their positions.

    ``block`` is the packed chain; ``settings`` (9,) are damping, progress, evaluations from one start and in all, the
    tolerances, m and rad, evaluations for a pose for which the closed form has no branch, and those after which a
    search ends whose nearest is farther away than the last number: squared, m and rad. q (k, nq) is where to start from
    and what other joints keep, and gets the nearest to the target that was found: by the closed form, if the arm has
    one, then by ``search``. What is proved to be out of reach is not searched for. ``evaluations`` (k,) gets
    how many there were, or REFUSED.
    """
    S, n = sizes_of(block)
    desk = desk_for(n, S)
    work, looks = workspace(n, rows, S), lookup_space(n, 1)
    for i in range(targets.shape[0]):
        spent, todo = begin(block, rows, settings, targets[i], q[i], desk)
        if todo != DONE:
            spent = go_on(block, rows, starts, settings, q[i], desk, (spent, todo), work, looks)
        evaluations[i] = spent


@inline
def beyond(block: Floats, near: float, aligned: float, target: Floats, desk: Desk) -> bool:
    """``is_out_of_reach`` in room that was made for it."""
    _, bounds, _, reach, _ = unpack(block)
    task, _, _, _, _ = laid_out(desk, bounds[0].shape[0])
    write_world(numbers_of(target), task)
    task[24], task[25] = 0.999 * near, 0.999 * aligned
    return out_of_reach(task, reach)


@jit(f"b1(f8[::1], f8, f8, {POSE})")
def is_out_of_reach(block: Floats, near: float, aligned: float, target: Floats) -> bool:
    """Whether a target (4, 4) is proved to be out of reach of the links, to within ``near`` m and ``aligned`` rad."""
    S, n = sizes_of(block)
    return beyond(block, near, aligned, target, desk_for(n, S))


@inline
def settle(
    block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats, desk: Desk, work: Work
) -> int:
    """``settle_pose`` in room that was made for it."""
    arm, bounds, entries, _, _ = unpack(block)
    task, guess, _, best, _ = laid_out(desk, bounds[0].shape[0])
    if not read(target, q, entries, task, guess):
        return REFUSED
    for i in range(6):
        task[12 + i], task[18 + i] = 0.0 if i < 3 or rows is None else np.inf, 1.0
    task[24] = task[25] = 0.0  # nothing is near enough
    descent, most = (settings[0], settings[1], int(settings[2])), int(settings[2])
    spent = descend_from(arm, task.reshape(1, 26), rows, bounds, guess, descent, most, np.inf, best, work)[0]
    write_end(best, entries, q)
    return spent


@jit(f"i8(f8[::1], i8[:,::1]?, f8[::1], {POSE}, f8[::1])")
def settle_pose(block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats) -> int:
    """Descend from q (nq,) towards a target (4, 4) that cannot be met, as near as it gets; returns evaluations.

    ``settings`` (3,) are damping, progress and evaluations.
    """
    S, n = sizes_of(block)
    return settle(block, rows, settings, target, q, desk_for(n, S), workspace(n, rows, S))


@jit("void(f8[:,:,::1], f8[:,::1], f8[:,::1])")
def distances(targets: Floats, reached: Floats, out: Floats) -> None:
    """Distance (m) and angle (rad), out (k, 2), of poses reached (k, 7), as Pinocchio writes them, from (k, 4, 4)."""
    for i in range(targets.shape[0]):
        position, goal = parts_of(targets[i])
        square = near = far = 0.0  # far: the other quaternion of the same orientation
        for j in range(3):
            square += (reached[i, j] - position[j]) ** 2
        for j in range(4):
            near += (reached[i, 3 + j] - goal[j]) ** 2
            far += (reached[i, 3 + j] + goal[j]) ** 2
        out[i, 0] = math.sqrt(square)
        out[i, 1] = 4.0 * math.asin(0.5 * math.sqrt(min(near, far)))
