"""The compiled descent from one start: damped least squares with the limits inside the step.

What was measured: evaluations a target on random / near-limit / singular targets, the mean of ten arms with 300 each.

* First guesses: random starts 21.9 / 45 / 50; of a table of 4,096 configurations the nearest by pose 9.1 / 21.6 / 20.3.
* Damping 0.3 |e|^2 9.8 / 24 / 27; 0.05 |e|^2 8.6 / 19.8 / 20.5; 0.005 |e|^2 8.3 / 16.9 / 16.3 with the second pass.
* Joints that a step would take across a limit: cut back afterwards 8.4 / 18.9 / 19.5; put on the limit and the step
  solved again for the others 8.2 / 16.9 / 18.2; a third pass brings nothing.
* A start is given up unless the error falls below 70 % every 4 steps: 8.6 / 19.8 / 20.5; every 3: 8.3 / 19.1 / 28
  (singular targets converge slowly and need the patience), every 8: 10.3 / 27 / 20.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, shared
from pin_metaik.kinematics.kernel.forward import beyond_ball, copy, forward, jacobian, pose_error, residual

PATIENCE = 4  # steps that must bring the squared error below `progress`, or the start is given up
DAMPING_FLOOR = 1e-9  # what is left of the damping at a solution
POLISH, EXACT = 3, 1e-18  # further steps once the tolerance is met, while each gains a decade; until 1e-9 m or rad

Arm: TypeAlias = tuple[Floats, Ints, Ints, Floats]  # joints, wiring, ends, tips
Bounds: TypeAlias = tuple[Floats, Floats, Ints]  # lower, upper, winds
Settings: TypeAlias = tuple[float, float, int]  # damping, progress, evaluations from one start
Work: TypeAlias = tuple[Floats, ...]


@allocating
def workspace(n: int, rows: Ints | None, S: int) -> Work:
    """Scratch arrays of a descent: one allocation for all starts."""
    m = 6 if rows is None else rows.shape[0]
    axes, origins, pose, error = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(6)
    r6, J6, r, J, H, y = np.empty(6), np.empty((n, 6)), np.empty(m), np.empty((n, m)), np.empty((m, m)), np.empty(m)
    return axes, origins, pose, error, r6, J6, r, J, H, y, np.empty(n), np.empty(n), np.empty(n)


@inline
def have_balls(tasks: Floats) -> bool:
    """Whether a tolerance is aimed at as a ball."""
    found = False
    for t in range(tasks.shape[0]):
        found = found or tasks[t, 12] < 0.0 or tasks[t, 15] < 0.0
    return found


@inline
def evaluate_with(arm: Arm, tasks: Floats, rows: Ints, x: Floats, work: Work, balls: bool) -> tuple[float, bool]:
    """``evaluate``; ``balls`` is a constant, so that what has none does not pay for them."""
    joints, wiring, ends, tips = arm
    axes, origins, pose, error, r6, J6, r, J, _, _, _, _, _ = work
    m = 0
    square = 0.0
    solved = True
    for t in range(tips.shape[0]):
        task = tasks[t]
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], task[:12], x, axes, origins, pose)
        pose_error(pose, error)
        position, orientation = residual(task, error, r6)
        J6[:, :] = 0.0
        rotated = task[15] > 0.0 or task[16] > 0.0 or task[17] > 0.0 or (balls and task[15] < 0.0)
        jacobian(joints, wiring, ends[t], ends[t + 1], task, pose, axes, origins, error, rotated, J6)
        if balls and task[12] < 0.0:
            position = beyond_ball(task, error, 0, r6, J6)
        if balls and task[15] < 0.0:
            orientation = beyond_ball(task, error, 3, r6, J6)
        solved = solved and position <= task[24] * task[24] and orientation <= task[25] * task[25]
        while m < rows.shape[0] and rows[m, 0] == t:
            j = rows[m, 1]
            r[m] = r6[j]
            square += r6[j] * r6[j]
            counts = r6[j] != 0.0 or task[12 + j] == 0.0 or (balls and task[12 + j] < 0.0)
            for c in range(J6.shape[0]):
                J[c, m] = J6[c, j] if counts else 0.0
            m += 1
    return square, solved


@shared
def evaluate_balls(arm: Arm, tasks: Floats, rows: Ints, x: Floats, work: Work) -> tuple[float, bool]:
    """``evaluate`` where a tolerance is aimed at as a ball."""
    return evaluate_with(arm, tasks, rows, x, work, True)


@inline
def evaluate(arm: Arm, tasks: Floats, rows: Ints, x: Floats, work: Work, balls: bool) -> tuple[float, bool]:
    """Residual r (m,) and Jacobian by coordinate J (n, m) of several tips, or of one with free axes, slack or balls.

    Returns |r|^2 and whether every tip is in tolerance.
    """
    return evaluate_balls(arm, tasks, rows, x, work) if balls else evaluate_with(arm, tasks, rows, x, work, False)


@inline
def evaluate_pose(arm: Arm, task: Floats, x: Floats, work: Work) -> tuple[float, bool]:
    """The same for one tip's whole pose without slack: what almost everybody asks for, at half the time."""
    joints, wiring, ends, tips = arm
    axes, origins, pose, error, _, _, r, J, _, _, _, _, _ = work
    forward(joints, wiring, ends[0], ends[1], tips[0], task[:12], x, axes, origins, pose)
    pose_error(pose, error)
    position, orientation = residual(task, error, r)
    J[:, :] = 0.0
    jacobian(joints, wiring, ends[0], ends[1], task, pose, axes, origins, error, False, J)
    square = 0.0
    for j in range(6):
        square += r[j] * r[j]
    return square, position <= task[24] * task[24] and orientation <= task[25] * task[25]


@inline
def solve_symmetric(H: Floats, y: Floats, m: int) -> None:
    """Solve H y = y in place through H = L D L'; H (m, m) is positive definite, its lower half is overwritten."""
    for j in range(m):
        d = H[j, j]
        for k in range(j):
            d -= H[j, k] * H[j, k] * H[k, k]
        H[j, j] = d
        inverse = 1.0 / d
        for i in range(j + 1, m):
            v = H[i, j]
            for k in range(j):
                v -= H[i, k] * H[j, k] * H[k, k]
            H[i, j] = v * inverse
    for i in range(m):
        for k in range(i):
            y[i] -= H[i, k] * y[k]
    for i in range(m - 1, -1, -1):
        y[i] /= H[i, i]
        for k in range(i + 1, m):
            y[i] -= H[k, i] * y[k]


@inline
def step(
    x: Floats,
    lower: Floats,
    upper: Floats,
    r: Floats,
    J: Floats,
    m: int,
    damping: float,
    H: Floats,
    y: Floats,
    dx: Floats,
    held: Floats,
) -> None:
    """Move x by dx = -J' (J J' + damping I)^-1 r over the joints that their limits leave free.

    Joints at a limit and pushed outward stay; those that dx would take across a limit go onto it, and the step is
    solved again for the others.
    """
    n = x.shape[0]
    for c in range(n):
        slope = 0.0
        for a in range(m):
            slope += J[c, a] * r[a]
        held[c] = 1.0 if (slope > 0.0 and x[c] <= lower[c]) or (slope < 0.0 and x[c] >= upper[c]) else 0.0
        dx[c] = 0.0
    for again in range(2):
        for a in range(m):
            for b in range(a):
                H[a, b] = 0.0
            H[a, a] = damping
            y[a] = r[a]
        for c in range(n):
            if held[c] == 0.0:
                for a in range(m):
                    v = J[c, a]
                    for b in range(a + 1):
                        H[a, b] += v * J[c, b]
        solve_symmetric(H, y, m)
        crossing = False
        for c in range(n):
            if held[c] == 0.0:
                v = 0.0
                for a in range(m):
                    v += J[c, a] * y[a]
                dx[c] = -v
                crossing = crossing or x[c] - v < lower[c] or x[c] - v > upper[c]
        if again == 1 or not crossing:
            break
        for c in range(n):
            if held[c] == 0.0 and (x[c] + dx[c] < lower[c] or x[c] + dx[c] > upper[c]):
                dx[c] = (lower[c] if dx[c] < 0.0 else upper[c]) - x[c]
                held[c] = 1.0
                for a in range(m):
                    r[a] += J[c, a] * dx[c]
    for c in range(n):
        x[c] = min(max(x[c] + dx[c], lower[c]), upper[c])


@shared
def descend_from(
    arm: Arm,
    tasks: Floats,
    rows: Ints | None,
    bounds: Bounds,
    start: Floats,
    settings: Settings,
    evaluations: int,
    least: float,
    best: Floats,
    work: Work,
) -> tuple[int, bool, float]:
    """Descend from one start (n,), for no more evaluations than are left; ``rows`` None: to one tip's whole pose.

    Returns the evaluations spent, whether the tolerances are met, and the least |r|^2 so far, here or before;
    ``best`` (n,) gets the coordinates that have it.
    """
    _, _, _, _, _, _, r, J, H, y, x, dx, held = work
    lower, upper, _ = bounds
    damping, progress, steps = settings
    for c in range(x.shape[0]):
        x[c] = min(max(start[c], lower[c]), upper[c])
    balls = have_balls(tasks)
    mark = np.inf
    found = False
    polish = POLISH
    for i in range(min(steps, evaluations)):
        if rows is None:
            square, solved = evaluate_pose(arm, tasks[0], x, work)
        else:
            square, solved = evaluate(arm, tasks, rows, x, work, balls)
        if found and not (solved and square < 0.01 * least):
            return i + 1, True, least
        if square < least or solved:
            least = square
            copy(x, best)
        if solved:
            polish = polish - 1 if found else POLISH
            found = True
            if polish == 0 or square < EXACT:
                return i + 1, True, least
        elif i % PATIENCE == 0:
            if square > progress * mark:
                return i + 1, False, least
            mark = square
        m = 6 if rows is None else rows.shape[0]
        step(x, lower, upper, r, J, m, damping * square + DAMPING_FLOOR, H, y, dx, held)
    return min(steps, evaluations), found, least
