"""The compiled fast lane: poses in, configurations out, with nothing in between that Python would have to do."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, allocating, inline, jit
from pin_metaik.kinematics.atlas import LEAF
from pin_metaik.kinematics.descent import Arm, Bounds, workspace
from pin_metaik.kinematics.guesses import Atlas, lookup_space
from pin_metaik.kinematics.pose import ORTHONORMAL
from pin_metaik.kinematics.reach import ROUNDING
from pin_metaik.kinematics.searches import search

POSITION = np.array([[0, 0], [0, 1], [0, 2]])  # the rows that count where orientation is free
SOLVED, UNSOLVED, NO_POSE, NO_START = 0, 1, 2, 3


@inline
def is_pose(M: Floats) -> bool:
    """Whether a matrix (4, 4) is a pose: finite, orthonormal, right-handed, last row 0 0 0 1. NaN fails every test."""
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
def task_of(M: Floats, task: Floats) -> None:
    """Write the world as seen from the target M (4, 4) into a task."""
    for i in range(3):
        offset = 0.0
        for j in range(3):
            task[3 * i + j] = M[j, i]
            offset -= M[j, i] * M[j, 3]
        task[9 + i] = offset


def pack(
    arm: Arm, bounds: Bounds, atlas: Atlas, span: tuple[Floats, Floats], places: Ints, reach: Floats
) -> tuple[Floats, Ints, Singles]:
    """A chain in three blocks: numbers, whole numbers and the atlas.

    Every argument of a compiled loop costs a call from Python another 90 ns. Of these arguments ``search`` does not
    have ``span``, limits (nq,) of every entry of q; ``places`` (n, 2), where in q a coordinate is and whether it is a
    pair (cos, sin); and ``reach`` (8,), what bounds the distance of the tip's point from a world point.
    """
    (joints, wiring, ends, tips), (lower, upper, winds), (leaves, entries, gains, scale) = arm, bounds, atlas
    numbers = joints, tips, lower, upper, np.array([scale]), *span, reach
    sizes = np.array([len(joints), len(lower), len(span[0]), len(leaves)])
    return _joined(numbers), _joined((sizes, wiring, ends, winds, places)), _joined((leaves, entries, gains))


def _joined(parts: tuple[Floats | Ints | Singles, ...]) -> Any:
    return np.concatenate([part.ravel() for part in parts])


@allocating
def unpack(
    numbers: Floats, whole: Ints, tables: Singles
) -> tuple[Arm, Bounds, Atlas, tuple[Floats, Floats], Ints, Floats]:
    """What ``pack`` took."""
    S, n, nq, L = whole[0], whole[1], whole[2], whole[3]
    a = 14 * S + 12
    b = a + 2 * n
    c = b + 1 + 2 * nq
    d = 6 + 2 * S
    e = 9 * LEAF * L
    k = LEAF * (L - 1)
    wiring, ends = whole[4 : 4 + 2 * S].reshape(S, 2), whole[4 + 2 * S : d]
    leaves, entries, gains = tables[:e], tables[e : e + k * n], tables[e + k * n :]
    return (
        (numbers[: 14 * S].reshape(S, 14), wiring, ends, numbers[14 * S : a].reshape(1, 12)),
        (numbers[a : a + n], numbers[a + n : b], whole[d : d + n]),
        (leaves.reshape(L, 9, LEAF), entries.reshape(k, n), gains.reshape(k, n, 6), numbers[b]),
        (numbers[b + 1 : b + 1 + nq], numbers[b + 1 + nq : c]),
        whole[d + n : d + 3 * n].reshape(n, 2),
        numbers[c : c + 8],
    )


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


@jit(
    "void(f8[::1], i8[::1], f4[::1], i8[:,::1]?, f8[:,::1], f8, f8, i8, i8, f8, f8, "
    "f8[:,:,::1], f8[:,::1], f8[:,::1], i8[:,::1])"
)
def solve_poses(
    numbers: Floats,
    whole: Ints,
    tables: Singles,
    rows: Ints | None,
    starts: Floats,
    damping: float,
    progress: float,
    per_start: int,
    evaluations: int,
    near: float,
    aligned: float,
    targets: Floats,
    q0: Floats,
    q: Floats,
    ended: Ints,
) -> None:
    """``search`` for the poses (k, 4, 4) of one tip, each on its own; with the rows ``POSITION``, for their positions.

    ``numbers``, ``whole`` and ``tables`` are the packed chain; ``near`` and ``aligned`` the tolerances, m and rad; q0
    (k, nq) is where to start from and what other joints keep. Row i of q (k, nq) and of ``ended`` (k, 2), evaluations
    and one of SOLVED, UNSOLVED, NO_POSE, NO_START, is written. What is proved to be out of reach is UNSOLVED at once.
    """
    arm, bounds, atlas, (least, most), places, reach = unpack(numbers, whole, tables)
    n = bounds[0].shape[0]
    tasks = np.zeros((1, 26))
    tasks[0, 15:18] = 0.0 if rows is None else np.inf
    tasks[0, 18:24] = 1.0
    tasks[0, 24], tasks[0, 25] = 0.999 * near, 0.999 * aligned
    work, looks = workspace(n, rows, arm[0].shape[0]), lookup_space(n, 1)
    guess, best = np.empty(n), np.empty(n)
    for i in range(targets.shape[0]):
        ended[i, 0] = 0
        if not is_pose(targets[i]):
            ended[i, 1] = NO_POSE
            continue
        sound = True
        for e in range(q.shape[1]):
            sound = sound and abs(q0[i, e]) < np.inf
            q[i, e] = min(max(q0[i, e], least[e]), most[e])
        if not sound:
            ended[i, 1] = NO_START
            continue
        for c in range(n):
            e = places[c, 0]
            guess[c] = math.atan2(q[i, e + 1], q[i, e]) if places[c, 1] == 1 else q[i, e]
        task_of(targets[i], tasks[0])
        if out_of_reach(tasks[0], reach):
            ended[i, 1] = UNSOLVED
            continue
        settings = damping, progress, per_start
        spent, solved_by = search(
            arm, tasks, rows, bounds, atlas, guess, starts, settings, evaluations, best, work, looks
        )
        ended[i, 0] = spent
        ended[i, 1] = SOLVED if solved_by >= 0 else UNSOLVED
        for c in range(n):
            e = places[c, 0]
            if places[c, 1] == 1:
                q[i, e], q[i, e + 1] = math.cos(best[c]), math.sin(best[c])
            else:
                q[i, e] = min(max(best[c], least[e]), most[e])


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
