"""The pose solver: poses in, configurations out, with nothing in between that Python would have to do.

For one tip and a whole pose, or a position at any orientation. First the bounds on reach, then the closed form, if the
arm has one, then descents from the table of samples and from random starts.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit
from pin_metaik.kinematics.kernel.closed_form import ORIGIN, Numbers, Vector, first_branch, numbers_of
from pin_metaik.kinematics.kernel.descent import EXACT, descend_from, descent_of
from pin_metaik.kinematics.kernel.forward import forward, sizes_of
from pin_metaik.kinematics.kernel.goals import pose_error
from pin_metaik.kinematics.kernel.layout import (
    ALIGNED,
    ANCHOR,
    ANGLE,
    DESCEND,
    DISTANCE,
    DONE,
    END,
    ENTRY,
    FAR,
    FEW,
    GOAL,
    LEAST,
    MOST,
    NEAR,
    ORTHONORMAL,
    PAIR,
    POSE,
    REFUSED,
    ROUNDING,
    SEARCH,
    SLACK,
    TURN,
    WEIGHT,
    WITHOUT_BRANCH,
    Arm,
    Bounds,
    Entries,
    PoseScratch,
    chain_in,
    pose_scratch_in,
    pose_scratch_shapes,
)
from pin_metaik.kinematics.kernel.multistart import Patience, search
from pin_metaik.kinematics.kernel.scratch import LookupScratch, Scratch, lookup_scratch, scratch_for
from pin_metaik.kinematics.kernel.warm_starts import samples_of

Quaternion: TypeAlias = tuple[float, float, float, float]
Room: TypeAlias = tuple[Floats, Floats]

TARGET = "Array(f8, 2, 'A', readonly=True)"  # (4, 4), however it lies in memory; read only
NOWHERE = ORIGIN, (0.0, 0.0, 0.0, 1.0)
POSITION = np.array([[0, 0], [0, 1], [0, 2]])  # the rows that count where orientation is free

views, shapes = inline(pose_scratch_in), inline(pose_scratch_shapes)
unpack = inline(chain_in)  # not the separate one: a closed form would take 3 % longer


@allocating
def room_for(n: int, S: int) -> Room:
    """The arrays of a ``PoseScratch``: two are made in less time than eight."""
    numbers, lines = shapes(n, S)
    return np.empty(numbers), np.empty(lines)


@inline
def scratch_in(room: Room, n: int) -> PoseScratch:
    """The named parts of the room."""
    return views(room[0], room[1], n)


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
def parts_of(target: Floats) -> tuple[Vector, Quaternion]:
    """Position and quaternion of a target (4, 4)."""
    pose = numbers_of(target)
    return (pose[9], pose[10], pose[11]), quaternion(pose)


@inline
def write_world(pose: Numbers, goal: Floats) -> None:
    """Write the world as seen from the target into a goal."""
    for i in range(3):
        offset = 0.0
        for j in range(3):
            goal[3 * i + j] = pose[3 * j + i]
            offset -= pose[3 * j + i] * pose[9 + j]
        goal[9 + i] = offset


@inline
def read_start(q: Floats, entries: Entries, guess: Floats) -> bool:
    """Bring q inside the limits and read its coordinates; whether it is (nq,) and finite."""
    least, most, places = entries
    if q.shape[0] != least.shape[0]:
        return False
    sound = True
    for e in range(q.shape[0]):
        sound = sound and abs(q[e]) < np.inf
        q[e] = min(max(q[e], least[e]), most[e])
    for c in range(guess.shape[0]):
        e = places[c, ENTRY]
        guess[c] = math.atan2(q[e + 1], q[e]) if places[c, PAIR] == 1 else q[e]
    return sound


@inline
def read(target: Floats, q: Floats, entries: Entries, goal: Floats, guess: Floats) -> bool:
    """Write a target (4, 4) and a start q (nq,) into goal and guess; whether they are a pose and a configuration."""
    if not is_pose(target) or not read_start(q, entries, guess):
        return False
    write_world(numbers_of(target), goal)
    return True


@inline
def write_end(x: Floats, entries: Entries, q: Floats) -> None:
    """Write coordinates (n,) into q (nq,), clamped to the limits: a rounding may be beyond."""
    least, most, places = entries
    for c in range(x.shape[0]):
        e = places[c, ENTRY]
        if places[c, PAIR] == 1:
            q[e], q[e + 1] = math.cos(x[c]), math.sin(x[c])
        else:
            q[e] = min(max(x[c], least[e]), most[e])


@inline
def aim(goal: Floats, rows: Ints | None, near: float, aligned: float) -> None:
    """Let position count, and orientation unless there are ``rows``, to within m and rad, without slack."""
    for i in range(6):
        goal[SLACK + i], goal[WEIGHT + i] = 0.0 if i < TURN or rows is None else np.inf, 1.0
    goal[NEAR], goal[ALIGNED] = near, aligned


@inline
def misshape(goal: Floats) -> float:
    """By how much (relative) the rotation of a target may stretch a vector: |R R' - I|."""
    square = 0.0
    for i in range(3):
        for j in range(3):
            dot = -1.0 if i == j else 0.0
            for k in range(3):
                dot += goal[3 * i + k] * goal[3 * j + k]
            square += dot * dot
    return math.sqrt(square)


@inline
def out_of_reach(goal: Floats, reach: Floats) -> bool:
    """Whether every pose in the tolerances is proved to be farther away, or nearer, than the links can span."""
    square = lever = 0.0
    for i in range(3):  # the tip's point in the target frame, less the world's point there
        away = reach[END + i] - goal[9 + i]
        for j in range(3):
            away -= goal[3 * i + j] * reach[ANCHOR + j]
        square += away * away
        lever += reach[END + i] * reach[END + i]
    distance = math.sqrt(square)
    allowed = ROUNDING + goal[NEAR] + (math.sqrt(lever) * goal[ALIGNED] if lever > 0.0 else 0.0)
    if reach[LEAST] - 1.01 * allowed <= distance <= reach[MOST] + 1.01 * allowed:
        return False
    allowed += math.sqrt(lever) * misshape(goal)
    return bool(distance > reach[MOST] + 1.01 * allowed or distance < reach[LEAST] - 1.01 * allowed)


@inline
def stands_exactly(arm: Arm, x: Floats, scratch: PoseScratch) -> bool:
    """Whether the tip at x (n,) is on the target but for rounding: there is nothing left to descend."""
    joints, wiring, ends, tips = arm
    goal, pose, error = scratch.goal, scratch.pose, scratch.error
    forward(joints, wiring, ends[0], ends[1], tips[0], goal[:POSE], x, scratch.axes, scratch.origins, pose)
    pose_error(pose, error)
    square = 0.0
    for j in range(6):
        square += error[j] * error[j]
    return square < EXACT


@inline
def take_branch(
    arm: Arm, bounds: Bounds, entries: Entries, form: Floats, target: Floats, scratch: PoseScratch, q: Floats
) -> tuple[int, int]:
    """Write the first branch that there is into q, if it is exactly there: evaluations, and what is left to do."""
    start, best = scratch.start, scratch.best
    if not first_branch(form, arm.wiring, bounds, numbers_of(target), scratch.guess, start):
        return 0, SEARCH
    for c in range(start.shape[0]):
        best[c] = min(max(start[c], bounds.lower[c]), bounds.upper[c])
    if not stands_exactly(arm, best, scratch):
        return 1, DESCEND
    write_end(best, entries, q)
    return 1, DONE


@inline
def directly(block: Floats, target: Floats, q: Floats, room: Room) -> int:
    """What is left to do: DONE, if a branch is exactly there and q written; or REFUSED."""
    arm, bounds, entries, _, form = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    if not read(target, q, entries, scratch.goal, scratch.guess):
        return REFUSED
    return take_branch(arm, bounds, entries, form, target, scratch, q)[1]


@jit(f"Tuple((i8, UniTuple(f8, 3), UniTuple(f8, 4)))(f8[::1], {TARGET}, f8[::1])")
def solve_directly(block: Floats, target: Floats, q: Floats) -> tuple[int, Vector, Quaternion]:
    """By closed form only: the first evaluation of ``solve_pose``. A smaller signature is called in less time.

    Returns DONE if the target (4, 4) is met by q (nq,), DESCEND if a branch is nearly there, SEARCH if there is none,
    or REFUSED; and the target's position and quaternion.
    """
    S, n, _ = sizes_of(block)
    todo = directly(block, target, q, room_for(n, S))
    position, turn = NOWHERE if todo == REFUSED else parts_of(target)
    return todo, position, turn


@inline
def begin(block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats, room: Room) -> tuple[int, int]:
    """Do for a target what needs no search: returns evaluations, and what is left to do for ``go_on``."""
    arm, bounds, entries, reach, form = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    goal = scratch.goal
    if not read(target, q, entries, goal, scratch.guess):
        return REFUSED, DONE
    aim(goal, rows, 0.999 * settings[DISTANCE], 0.999 * settings[ANGLE])
    if out_of_reach(goal, reach):
        return 0, DONE
    if rows is not None or form.shape[0] == 0:
        return 0, SEARCH
    return take_branch(arm, bounds, entries, form, target, scratch, q)


@inline
def go_on(
    block: Floats,
    rows: Ints | None,
    starts: Floats,
    settings: Floats,
    q: Floats,
    room: Room,
    begun: tuple[int, int],
    work: Scratch,
    look: LookupScratch,
) -> int:
    """Descend from the branch that ``begin`` found, if it did, then ``search``; returns all evaluations."""
    arm, bounds, entries, _, form = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    goals, best = scratch.goal.reshape(1, GOAL), scratch.best
    descent, most = descent_of(settings)
    (spent, todo), met = begun, False
    if todo == SEARCH and rows is None and form.shape[0] > 0:
        most = min(most, int(settings[WITHOUT_BRANCH]))
    if todo == DESCEND:
        steps, met, _ = descend_from(arm, goals, rows, bounds, scratch.start, descent, most, np.inf, best, work)
        spent += steps
    if not met:
        samples = samples_of(block)
        patience = Patience(most - spent, int(settings[FEW]) - spent, settings[FAR])
        spent += search(arm, goals, rows, bounds, samples, scratch.guess, starts, descent, patience, best, work, look)[
            0
        ]
    write_end(best, entries, q)
    return spent


HOW = "f8[::1], i8[:,::1]?, f8[:,::1], f8[::1]"  # block, rows, starts, settings


@jit(f"Tuple((i8, UniTuple(f8, 3), UniTuple(f8, 4)))({HOW}, {TARGET}, f8[::1])")
def solve_pose(
    block: Floats, rows: Ints | None, starts: Floats, settings: Floats, target: Floats, q: Floats
) -> tuple[int, Vector, Quaternion]:
    """``solve_poses`` for one target (4, 4) and one q (nq,); returns evaluations, and the target's parts."""
    S, n, _ = sizes_of(block)
    room = room_for(n, S)
    spent, todo = begin(block, rows, settings, target, q, room)
    if todo != DONE:
        work, look = scratch_for(n, rows, S), lookup_scratch(n, 1)
        spent = go_on(block, rows, starts, settings, q, room, (spent, todo), work, look)
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

    ``block`` is the packed chain, ``settings`` (9,) are the pose solver's: see ``layout``. q (k, nq) is where to start
    from and what other joints keep, and gets the nearest to the target that was found: by the closed form, if the arm
    has one, then by ``search``. What is proved to be out of reach is not searched for. ``evaluations`` (k,) gets how
    many there were, or REFUSED.
    """
    S, n, _ = sizes_of(block)
    room = room_for(n, S)
    work, look = scratch_for(n, rows, S), lookup_scratch(n, 1)
    for i in range(targets.shape[0]):
        spent, todo = begin(block, rows, settings, targets[i], q[i], room)
        if todo != DONE:
            spent = go_on(block, rows, starts, settings, q[i], room, (spent, todo), work, look)
        evaluations[i] = spent


@inline
def beyond(block: Floats, near: float, aligned: float, target: Floats, room: Room) -> bool:
    """``is_out_of_reach`` in room that was made for it."""
    _, bounds, _, reach, _ = unpack(block)
    goal = scratch_in(room, bounds.lower.shape[0]).goal
    write_world(numbers_of(target), goal)
    goal[NEAR], goal[ALIGNED] = 0.999 * near, 0.999 * aligned
    return out_of_reach(goal, reach)


@jit(f"b1(f8[::1], f8, f8, {TARGET})")
def is_out_of_reach(block: Floats, near: float, aligned: float, target: Floats) -> bool:
    """Whether a target (4, 4) is proved to be out of reach of the links, to within ``near`` m and ``aligned`` rad."""
    S, n, _ = sizes_of(block)
    return beyond(block, near, aligned, target, room_for(n, S))


@inline
def settle(
    block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats, room: Room, work: Scratch
) -> int:
    """``settle_pose`` in room that was made for it."""
    arm, bounds, entries, _, _ = unpack(block)
    scratch = scratch_in(room, bounds.lower.shape[0])
    goal, best = scratch.goal, scratch.best
    if not read(target, q, entries, goal, scratch.guess):
        return REFUSED
    aim(goal, rows, 0.0, 0.0)  # nothing is near enough
    descent, most = descent_of(settings)
    goals = goal.reshape(1, GOAL)
    spent = descend_from(arm, goals, rows, bounds, scratch.guess, descent, most, np.inf, best, work)[0]
    write_end(best, entries, q)
    return spent


@jit(f"i8(f8[::1], i8[:,::1]?, f8[::1], {TARGET}, f8[::1])")
def settle_pose(block: Floats, rows: Ints | None, settings: Floats, target: Floats, q: Floats) -> int:
    """Descend from q (nq,) towards a target (4, 4) that cannot be met, as near as it gets; returns evaluations.

    ``settings`` (4,) are those of a descent; one start is all there is.
    """
    S, n, _ = sizes_of(block)
    return settle(block, rows, settings, target, q, room_for(n, S), scratch_for(n, rows, S))


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
