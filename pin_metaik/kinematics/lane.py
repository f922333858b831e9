"""The compiled fast lane: poses in, configurations out, with nothing in between that Python would have to do."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit
from pin_metaik.kinematics.branches import ORIGIN, Numbers, Vector, first_branch, numbers_of
from pin_metaik.kinematics.descent import EXACT, Arm, Work, descend_from, workspace
from pin_metaik.kinematics.guesses import Looks, lookup_space
from pin_metaik.kinematics.kernels import forward, pose_error
from pin_metaik.kinematics.packing import Entries, sizes_of, unpack, unpack_atlas
from pin_metaik.kinematics.pose import ORTHONORMAL
from pin_metaik.kinematics.reach import ROUNDING
from pin_metaik.kinematics.searches import search

Quaternion: TypeAlias = tuple[float, float, float, float]
Desk: TypeAlias = tuple[Floats, Floats, Floats, Floats]

POSITION = np.array([[0, 0], [0, 1], [0, 2]])  # the rows that count where orientation is free
REFUSED = -1  # evaluations of what is no pose, or no configuration to start from
DONE, DESCEND, SEARCH = 0, 1, 2  # what is left to do: nothing, from a branch that is nearly there, or from anywhere


@inline
def is_pose(M: Floats) -> bool:
    """Whether a matrix is a pose: (4, 4), finite, orthonormal, right-handed, last row 0 0 0 1. NaN fails every test."""
    if M.shape[0] != 4 or M.shape[1] != 4:
        return False
    sound = bool(M[3, 0] == 0.0 and M[3, 1] == 0.0 and M[3, 2] == 0.0 and M[3, 3] == 1.0)
    for i in range(3):
        sound = sound and abs(M[i, 3]) < np.inf
        j, k = (i + 1) % 3, (i + 2) % 3
        sound = sound and abs(M[i, 0] * M[i, 0] + M[i, 1] * M[i, 1] + M[i, 2] * M[i, 2] - 1.0) <= ORTHONORMAL
        for c in range(3):  # each row is the cross product of the two after it
            d, e = (c + 1) % 3, (c + 2) % 3
            sound = sound and abs(M[j, d] * M[k, e] - M[j, e] * M[k, d] - M[i, c]) <= ORTHONORMAL
    return sound


@inline
def quaternion(pose: Numbers) -> Quaternion:
    """Unit quaternion (x, y, z, w) of a pose, with the sign that Pinocchio (Eigen; Shoemake 1987) gives it."""
    a, b, c, d, e, f, g, h, i = pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]
    if a + e + i > 0.0:
        x, y, z, w = h - f, c - g, d - b, 1.0 + a + e + i
    elif i >= a and i >= e:
        x, y, z, w = c + g, f + h, 1.0 + i - a - e, d - b
    elif e > a:
        x, y, z, w = b + d, 1.0 + e - i - a, h + f, c - g
    else:
        x, y, z, w = 1.0 + a - e - i, d + b, g + c, h - f
    k = 1.0 / math.sqrt(x * x + y * y + z * z + w * w)
    return k * x, k * y, k * z, k * w


@inline
def write_task(pose: Numbers, oriented: bool, settings: Floats, task: Floats) -> None:
    """Write a task: the world as seen from the target, slack, weights and tolerances."""
    for i in range(3):
        offset = 0.0
        for j in range(3):
            task[3 * i + j] = pose[3 * j + i]
            offset -= pose[3 * j + i] * pose[9 + j]
        task[9 + i] = offset
        task[12 + i], task[15 + i] = 0.0, 0.0 if oriented else np.inf
        task[18 + i] = task[21 + i] = 1.0
    task[24], task[25] = 0.999 * settings[4], 0.999 * settings[5]


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
    return bool(distance > reach[7] + 1.01 * allowed or distance < reach[6] - 1.01 * allowed)


@inline
def read_start(q: Floats, entries: Entries, guess: Floats) -> bool:
    """Bring q (nq,) inside the limits and read its coordinates; whether all of it is finite."""
    least, most, places = entries
    sound = True
    for e in range(q.shape[0]):
        sound = sound and abs(q[e]) < np.inf
        q[e] = min(max(q[e], least[e]), most[e])
    for c in range(guess.shape[0]):
        e = places[c, 0]
        guess[c] = math.atan2(q[e + 1], q[e]) if places[c, 1] == 1 else q[e]
    return sound


@inline
def write_end(x: Floats, entries: Entries, q: Floats) -> None:
    """Write coordinates (n,) into q, not a rounding beyond the limits."""
    least, most, places = entries
    for c in range(x.shape[0]):
        e = places[c, 0]
        if places[c, 1] == 1:
            q[e], q[e + 1] = math.cos(x[c]), math.sin(x[c])
        else:
            q[e] = min(max(x[c], least[e]), most[e])


@allocating
def desk_for(n: int, S: int) -> tuple[Floats, Floats]:
    """What ``begin`` writes on: task, guess, start, best, and scratch of a forward kinematics."""
    return np.empty(26 + 3 * n + 18), np.empty((2 * S, 3))


@inline
def laid_out(desk: Floats, n: int) -> Desk:
    """Task (26,), guess, start and best (n,) on a desk."""
    return desk[:26], desk[26 : 26 + n], desk[26 + n : 26 + 2 * n], desk[26 + 2 * n : 26 + 3 * n]


@inline
def stands_exactly(arm: Arm, task: Floats, x: Floats, room: Floats, scratch: Floats) -> bool:
    """Whether the tip at x (n,) is on the target but for rounding: there is nothing left to descend."""
    joints, wiring, ends, tips = arm
    S = joints.shape[0]
    pose, error = scratch[:12], scratch[12:]
    forward(joints, wiring, ends[0], ends[1], tips[0], task[:12], x, room[:S], room[S:], pose)
    pose_error(pose, error)
    square = 0.0
    for j in range(6):
        square += error[j] * error[j]
    return square < EXACT


@inline
def begin(
    block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats, desk: Floats, room: Floats
) -> tuple[int, int]:
    """Do for a target what needs no search: returns evaluations, and what is left to do for ``go_on``."""
    arm, bounds, entries, reach, form = unpack(block)
    task, guess, start, best = laid_out(desk, bounds[0].shape[0])
    if not is_pose(target) or q.shape[0] != entries[0].shape[0] or not read_start(q, entries, guess):
        return REFUSED, DONE
    pose = numbers_of(target)
    write_task(pose, rows is None, settings, task)
    if out_of_reach(task, reach):
        return 0, DONE
    if rows is not None or form.shape[0] == 0 or not first_branch(form, arm[1], bounds, pose, guess, start):
        return 0, SEARCH
    for c in range(start.shape[0]):
        best[c] = min(max(start[c], bounds[0][c]), bounds[1][c])
    if not stands_exactly(arm, task, best, room, desk[desk.shape[0] - 18 :]):
        return 1, DESCEND
    write_end(best, entries, q)
    return 1, DONE


@inline
def go_on(
    block: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    q: Floats,
    desk: Floats,
    begun: tuple[int, int],
    work: Work,
    looks: Looks,
) -> int:
    """Descend from the branch that ``begin`` found, if it did, then ``search``; returns all evaluations."""
    arm, bounds, entries, _, _ = unpack(block)
    task, guess, start, best = laid_out(desk, bounds[0].shape[0])
    tasks = task.reshape(1, 26)
    descent, most = (settings[0], settings[1], int(settings[2])), int(settings[3])
    (spent, todo), met = begun, False
    if todo == DESCEND:
        steps, met, _ = descend_from(arm, tasks, rows, bounds, start, descent, most, np.inf, best, work)
        spent += steps
    if not met:
        atlas = unpack_atlas(block)
        spent += search(arm, tasks, rows, bounds, atlas, guess, starts, descent, most - spent, best, work, looks)[0]
    write_end(best, entries, q)
    return spent


HOW = "f8[::1], i8[:,::1]?, f8[:,::1], f8[::1]"  # block, rows, starts, settings


@jit(f"Tuple((i8, UniTuple(f8, 3), UniTuple(f8, 4)))({HOW}, f8[:,:], f8[::1])")
def solve_pose(
    block: Floats, rows: Ints | None, starts: Floats, settings: Floats, target: Floats, q: Floats
) -> tuple[int, Vector, Quaternion]:
    """``solve_poses`` for one target (4, 4) and one q (nq,); returns evaluations, and the target's parts."""
    S, n = sizes_of(block)
    desk, room = desk_for(n, S)
    spent, todo = begin(block, rows, settings, target, q, desk, room)
    if spent == REFUSED:
        return REFUSED, ORIGIN, (0.0, 0.0, 0.0, 1.0)
    if todo != DONE:
        work, looks = workspace(n, rows, S), lookup_space(n, 1)
        spent = go_on(block, rows, starts, settings, q, desk, (spent, todo), work, looks)
    pose = numbers_of(target)
    return spent, (pose[9], pose[10], pose[11]), quaternion(pose)


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

    ``block`` is the packed chain; ``settings`` (6,) are damping, progress, evaluations from one start and in all, and
    the tolerances, m and rad. q (k, nq) is where to start from and what other joints keep, and gets the nearest to the
    target that was found: by the closed form, if the arm has one, then by ``search``. What is proved to be out of reach
    is not searched for. ``evaluations`` (k,) gets how many there were, or REFUSED.
    """
    S, n = sizes_of(block)
    desk, room = desk_for(n, S)
    work, looks = workspace(n, rows, S), lookup_space(n, 1)
    for i in range(targets.shape[0]):
        spent, todo = begin(block, rows, settings, targets[i], q[i], desk, room)
        if todo != DONE:
            spent = go_on(block, rows, starts, settings, q[i], desk, (spent, todo), work, looks)
        evaluations[i] = spent


@jit("void(f8[:,:,::1], f8[:,:,::1], f8[:,::1])")
def distances(targets: Floats, reached: Floats, out: Floats) -> None:
    """Distance (m) and angle (rad), out (k, 2), of poses reached (k, 4, 4) from their targets."""
    for i in range(targets.shape[0]):
        A, B = targets[i], reached[i]
        square = cos = 0.0
        for r in range(3):
            square += (B[r, 3] - A[r, 3]) ** 2
            for c in range(3):
                cos += A[r, c] * B[r, c]
        x = y = z = 0.0
        for r in range(3):
            x += A[r, 2] * B[r, 1] - A[r, 1] * B[r, 2]
            y += A[r, 0] * B[r, 2] - A[r, 2] * B[r, 0]
            z += A[r, 1] * B[r, 0] - A[r, 0] * B[r, 1]
        out[i, 0] = math.sqrt(square)
        out[i, 1] = math.atan2(math.sqrt(x * x + y * y + z * z), cos - 1.0)
