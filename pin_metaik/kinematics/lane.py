"""The compiled fast lane: poses in, configurations out, with nothing in between that Python would have to do."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.descent import workspace
from pin_metaik.kinematics.kernels import PATHS
from pin_metaik.kinematics.searches import ATLAS, BOUNDS, search

ORTHONORMAL = 1e-6  # how far R'R may be from the identity
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


@jit(
    f"void({PATHS}, {BOUNDS}, {ATLAS}, f8[::1], f8[::1], i8[:,::1], i8[:,::1]?, f8[:,::1], f8, f8, i8, i8, f8, f8, "
    "f8[:,:,::1], f8[:,::1], f8[:,::1], i8[:,::1])"
)
def solve_poses(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    lower: Floats,
    upper: Floats,
    winds: Ints,
    leaves: Floats,
    entries: Floats,
    scale: float,
    least: Floats,
    most: Floats,
    places: Ints,
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

    What ``search`` does not have: ``least`` and ``most`` (nq,) limit every entry of q; ``places`` (n, 2) is where in q
    a coordinate is and whether it is a pair (cos, sin); ``near`` and ``aligned`` are the tolerances, m and rad; q0
    (k, nq) is where to start from and what other joints keep. Row i of q (k, nq) and of ``ended`` (k, 2), evaluations
    and one of SOLVED, UNSOLVED, NO_POSE, NO_START, is written.
    """
    n = lower.shape[0]
    tasks = np.zeros((1, 26))
    tasks[0, 15:18] = 0.0 if rows is None else np.inf
    tasks[0, 18:24] = 1.0
    tasks[0, 24], tasks[0, 25] = 0.999 * near, 0.999 * aligned
    work = workspace(n, rows, joints.shape[0])
    own, best = starts.copy(), np.empty(n)
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
            own[0, c] = math.atan2(q[i, e + 1], q[i, e]) if places[c, 1] == 1 else q[i, e]
        task_of(targets[i], tasks[0])
        spent, solved_by = search(
            (joints, wiring, ends, tips),
            tasks,
            rows,
            (lower, upper, winds),
            (leaves, entries, scale),
            own,
            (damping, progress, per_start),
            evaluations,
            best,
            work,
        )
        ended[i, 0] = spent
        ended[i, 1] = SOLVED if solved_by >= 0 else UNSOLVED
        for c in range(n):
            e = places[c, 0]
            if places[c, 1] == 1:
                q[i, e], q[i, e + 1] = math.cos(best[c]), math.sin(best[c])
            else:
                q[i, e] = min(max(best[c], least[e]), most[e])
