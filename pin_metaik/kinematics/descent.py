"""The compiled descent: damped least squares with the limits inside the step, from one start after the other.

What was measured: evaluations a target on random / near-limit / singular targets, the mean of ten arms with 300 each.

* First guesses: random starts 21.9 / 45 / 50; of a table of 4,096 configurations the nearest by pose 9.1 / 21.6 / 20.3.
* Damping 0.3 |e|^2 9.8 / 24 / 27; 0.05 |e|^2 8.6 / 19.8 / 20.5; 0.005 |e|^2 8.3 / 16.9 / 16.3 with the second pass.
* Joints that a step would take across a limit: cut back afterwards 8.4 / 18.9 / 19.5; put on the limit and the step
  solved again for the others 8.2 / 16.9 / 18.2; a third pass brings nothing.
* A start is given up unless the error falls below 70 % every 4 steps: 8.6 / 19.8 / 20.5; every 3: 8.3 / 19.1 / 28
  (singular targets converge slowly and need the patience), every 8: 10.3 / 27 / 20.
"""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernels import PATHS, costs, forward, jacobian, pose_error, poses, residual

__all__ = ["costs", "descend", "linearize", "poses"]

PATIENCE = 4  # steps that must bring the squared error below `progress`, or the start is given up
DAMPING_FLOOR = 1e-9  # what is left of the damping at a solution
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])

POLISH = 1  # further steps once the tolerance is met, while each gains a decade
LEAF, OPENED, TRIED = 64, 5, 8  # entries in a leaf of the atlas, leaves opened, entries tried before the given starts


@inline
def evaluate(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    x: Floats,
    axes: Floats,
    origins: Floats,
    pose: Floats,
    error: Floats,
    r6: Floats,
    J6: Floats,
    r: Floats,
    J: Floats,
) -> tuple[float, bool]:
    """Residual r (m,) and Jacobian by coordinate J (n, m) of several tips, or of one with free axes or slack.

    Returns |r|^2 and whether every tip is in tolerance.
    """
    m = 0
    square = 0.0
    solved = True
    for t in range(tips.shape[0]):
        task = tasks[t]
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], task[:12], x, axes, origins, pose)
        pose_error(pose, error)
        position, orientation = residual(task, error, r6)
        solved = solved and position <= task[24] * task[24] and orientation <= task[25] * task[25]
        J6[:, :] = 0.0
        rotated = task[15] > 0.0 or task[16] > 0.0 or task[17] > 0.0
        jacobian(joints, wiring, ends[t], ends[t + 1], task, pose, axes, origins, error, rotated, J6)
        while m < rows.shape[0] and rows[m, 0] == t:
            j = rows[m, 1]
            r[m] = r6[j]
            square += r6[j] * r6[j]
            counts = r6[j] != 0.0 or task[12 + j] == 0.0
            for c in range(J6.shape[0]):
                J[c, m] = J6[c, j] if counts else 0.0
            m += 1
    return square, solved


@inline
def evaluate_pose(
    joints: Floats,
    wiring: Ints,
    tip: Floats,
    task: Floats,
    x: Floats,
    axes: Floats,
    origins: Floats,
    pose: Floats,
    error: Floats,
    r: Floats,
    J: Floats,
) -> tuple[float, bool]:
    """The same for one tip's whole pose without slack: what almost everybody asks for, at half the time."""
    forward(joints, wiring, 0, joints.shape[0], tip, task[:12], x, axes, origins, pose)
    pose_error(pose, error)
    position, orientation = residual(task, error, r)
    J[:, :] = 0.0
    jacobian(joints, wiring, 0, joints.shape[0], task, pose, axes, origins, error, False, J)
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


@jit(f"Tuple((f8, b1))({PATHS}, f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[:,::1])")
def linearize(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    x: Floats,
    r: Floats,
    J: Floats,
) -> tuple[float, bool]:
    """Weighted residual r (m,) and its Jacobian by coordinate J (n, m) at x; |r|^2 and whether the tolerances are met."""
    n, S = x.shape[0], joints.shape[0]
    axes, origins, pose, error = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(6)
    r6, J6 = np.empty(6), np.empty((n, 6))
    return evaluate(joints, wiring, ends, tips, tasks, rows, x, axes, origins, pose, error, r6, J6, r, J)


@inline
def target_feature(tasks: Floats, scale: float, goal: Floats, weights: Floats) -> None:
    """Feature (9 T,) of the targets as the atlas has it, and weight 0 where they leave position or orientation free."""
    for t in range(tasks.shape[0]):
        task, at = tasks[t], 9 * t
        placed = task[12] < np.inf and task[13] < np.inf and task[14] < np.inf
        turned = task[15] < np.inf and task[16] < np.inf and task[17] < np.inf
        for j in range(3):
            goal[at + j] = -(task[j] * task[9] + task[3 + j] * task[10] + task[6 + j] * task[11])
            goal[at + 3 + j] = scale * task[j]
            goal[at + 6 + j] = scale * task[6 + j]
            weights[at + j] = 1.0 if placed else 0.0
            weights[at + 3 + j] = weights[at + 6 + j] = 1.0 if turned else 0.0


@inline
def merge_nearest(
    leaf: Floats, number: int, goal: Floats, weights: Floats, away: Floats, found: Ints, distances: Floats
) -> None:
    """Merge the columns of a leaf (9 T, LEAF) into the nearest found so far, nearest first."""
    away[:] = 0.0
    for j in range(goal.shape[0]):
        g, w, row = goal[j], weights[j], leaf[j]
        for i in range(LEAF):
            d = row[i] - g
            away[i] += w * d * d
    last = distances.shape[0] - 1
    for i in range(LEAF):
        if away[i] < distances[last]:
            k = last
            while k > 0 and distances[k - 1] > away[i]:
                distances[k], found[k] = distances[k - 1], found[k - 1]
                k -= 1
            distances[k], found[k] = away[i], number * LEAF + i


@inline
def look_up(leaves: Floats, goal: Floats, weights: Floats, found: Ints, distances: Floats) -> None:
    """The atlas entries nearest to the goal: found (TRIED,), nearest first, with their squared distances."""
    away = np.empty(LEAF)
    opened, spans = np.empty(OPENED, np.int64), np.full(OPENED, np.inf)
    merge_nearest(leaves[0], 0, goal, weights, away, opened, spans)
    distances[:] = np.inf
    for k in range(OPENED):
        leaf = opened[k]
        merge_nearest(leaves[1 + leaf], leaf, goal, weights, away, found, distances)


@jit(
    f"UniTuple(i8, 2)({PATHS}, f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[:,:,::1], "
    "f8[:,::1], f8, f8[:,::1], f8, f8, i8, i8, f8[::1])"
)
def descend(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    lower: Floats,
    upper: Floats,
    leaves: Floats,
    entries: Floats,
    scale: float,
    starts: Floats,
    damping: float,
    progress: float,
    per_start: int,
    evaluations: int,
    best: Floats,
) -> tuple[int, int]:
    """Descend from one start after the other until one meets the tolerances or the evaluations are spent.

    The starts are the entries of the atlas nearest to the target, if there is one, and ``starts`` (s, n). The first of
    those is somebody's guess: it goes before the entries when its pose is nearer, otherwise after them.

    Returns the evaluations spent and the index of the start that met them, or -1; ``best`` (n,) gets the coordinates.
    """
    n, m, S, T = lower.shape[0], rows.shape[0], joints.shape[0], tips.shape[0]
    whole = T == 1 and m == 6
    for j in range(6):
        whole = whole and tasks[0, 12 + j] == 0.0
    axes, origins, pose, error = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(6)
    r6, J6, r, J = np.empty(6), np.empty((n, 6)), np.empty(m), np.empty((n, m))
    H6, y6, H, y = np.empty((6, 6)), np.empty(6), np.empty((m, m)), np.empty(m)
    x, dx, held = np.empty(n), np.empty(n), np.empty(n)
    best[:] = starts[0]
    spent = 0
    least = np.inf
    tried = TRIED if leaves.shape[0] > 0 else 0
    order, distances = np.empty(TRIED, np.int64), np.empty(TRIED)
    if tried > 0:
        goal, weights = np.empty(9 * T), np.empty(9 * T)
        target_feature(tasks, scale, goal, weights)
        look_up(leaves, goal, weights, order, distances)
        away = 0.0
        for t in range(T):
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], IDENTITY, starts[0], axes, origins, pose)
            for j in range(3):
                away += weights[9 * t + j] * (goal[9 * t + j] - pose[9 + j]) ** 2
                away += weights[9 * t + 3 + j] * (goal[9 * t + 3 + j] - scale * pose[3 * j]) ** 2
                away += weights[9 * t + 6 + j] * (goal[9 * t + 6 + j] - scale * pose[3 * j + 2]) ** 2
        own = 0 if away <= distances[0] else TRIED
    else:
        own = 0
    for k in range(tried + starts.shape[0]):
        if k == own:
            x[:] = starts[0]
        elif k <= tried:
            x[:] = entries[order[k - 1 if own == 0 else k]]
        else:
            x[:] = starts[k - tried]
        mark = np.inf
        found = False
        polish = POLISH
        for i in range(per_start):
            if spent >= evaluations:
                return spent, k if found else -1
            if whole:
                square, solved = evaluate_pose(joints, wiring, tips[0], tasks[0], x, axes, origins, pose, error, r6, J6)
            else:
                square, solved = evaluate(
                    joints, wiring, ends, tips, tasks, rows, x, axes, origins, pose, error, r6, J6, r, J
                )
            spent += 1
            if found and not (solved and square < 0.01 * least):
                return spent, k
            if square < least or solved:
                least = square
                best[:] = x
            if solved:
                polish = polish - 1 if found else POLISH
                found = True
                if polish == 0 or square == 0.0:
                    return spent, k
            elif i % PATIENCE == 0:
                if square > progress * mark:
                    break
                mark = square
            if whole:
                step(x, lower, upper, r6, J6, 6, damping * square + DAMPING_FLOOR, H6, y6, dx, held)
            else:
                step(x, lower, upper, r, J, m, damping * square + DAMPING_FLOOR, H, y, dx, held)
    return spent, -1
