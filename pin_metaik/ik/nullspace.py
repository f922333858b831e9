"""Sliding along the solutions of a redundant chain towards a better one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.dls import DLS
from pin_metaik.ik.select import Measure

STEPS = 30
FIRST_STEP, LAST_STEP = 0.3, 1e-3  # rad or m
NUDGE = 1e-5  # of the finite differences


def slide(problem: IKProblem, x: NDArray[np.float64], x0: NDArray[np.float64], measure: Measure) -> NDArray[np.float64]:
    """Better coordinates (n,) by the measure, reached from a solution x (n,) without leaving the targets.

    Steepest descent of the measure projected on the null space of the Jacobian, each step put back onto the targets by
    the refiner (Rosen's gradient projection, 1961). Returns x itself where the targets leave no freedom.
    """
    J = problem.linearize(x)[1].T
    if J.shape[1] <= J.shape[0]:
        return x
    best = float(measure(problem, x[None], x0)[0])
    length = FIRST_STEP
    for _ in range(STEPS):
        gradient = (measure(problem, x + NUDGE * np.eye(len(x)), x0) - best) / NUDGE
        J = problem.linearize(x)[1].T
        downhill = -gradient + np.linalg.pinv(J) @ (J @ gradient)
        size = float(np.linalg.norm(downhill))
        if size < 1e-9:
            return x
        while length > LAST_STEP:
            tried = problem.limits.clip(x + length / size * downhill)
            refined = DLS().refine(problem, tried[None], 50)
            value = float(measure(problem, refined.x[None], x0)[0])
            if refined.met and value < best:
                x, best = refined.x, value
                break
            length *= 0.5
        else:
            return x
    return x
