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

from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, separate
from pin_metaik.kinematics.kernel.forward import copy
from pin_metaik.kinematics.kernel.goals import evaluate, evaluate_pose, have_balls
from pin_metaik.kinematics.kernel.layout import DAMPING, EVALUATIONS, PER_START, PROGRESS, Arm, Bounds
from pin_metaik.kinematics.kernel.scratch import Scratch

PATIENCE = 4  # steps that must bring the squared error below `progress`, or the start is given up
DAMPING_FLOOR = 1e-9  # what is left of the damping at a solution
POLISH, EXACT = 3, 1e-18  # further steps once the tolerance is met, while each gains a decade; until 1e-9 m or rad


class Descent(NamedTuple):
    """How to descend: damping, share of the squared error that a few steps must undercut, steps from one start."""

    damping: float
    progress: float
    steps: int


@inline
def descent_of(settings: Floats) -> tuple[Descent, int]:
    """How to descend, and evaluations in all: the first four settings."""
    return Descent(settings[DAMPING], settings[PROGRESS], int(settings[PER_START])), int(settings[EVALUATIONS])


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


def step_in(bounds: Bounds, m: int, damping: float, work: Scratch) -> None:
    """Move ``work.x`` by dx = -J' (J J' + damping I)^-1 r over the joints that their limits leave free.

    Joints at a limit and pushed outward stay; those that dx would take across a limit go onto it, and the step is
    solved again for the others. Of the m rows ``r`` gets what those on their limits leave of it; ``H``, ``y``, ``dx``
    and ``held`` are written.
    """
    lower, upper = bounds.lower, bounds.upper
    x, r, J, H, y, dx, held = work.x, work.r, work.J, work.H, work.y, work.dx, work.held
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


step = inline(step_in)


@separate
def descend_from(
    arm: Arm,
    goals: Floats,
    rows: Ints | None,
    bounds: Bounds,
    start: Floats,
    descent: Descent,
    evaluations: int,
    least: float,
    best: Floats,
    work: Scratch,
) -> tuple[int, bool, float]:
    """Descend from one start (n,), for no more evaluations than are left; ``rows`` None: to one tip's whole pose.

    Returns the evaluations spent, whether the tolerances are met, and the least |r|^2 so far, here or before;
    ``best`` (n,) gets the coordinates that have it.
    """
    lower, upper, x = bounds.lower, bounds.upper, work.x
    damping, progress, steps = descent.damping, descent.progress, descent.steps
    for c in range(x.shape[0]):
        x[c] = min(max(start[c], lower[c]), upper[c])
    balls = have_balls(goals)
    mark = np.inf
    found = False
    polish = POLISH
    for i in range(min(steps, evaluations)):
        if rows is None:
            square, solved = evaluate_pose(arm, goals[0], x, work)
        else:
            square, solved = evaluate(arm, goals, rows, x, work, balls)
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
        step(bounds, m, damping * square + DAMPING_FLOOR, work)
    return min(steps, evaluations), found, least
