"""The loop every step-by-step refiner shares: starts, tolerances, limits and bookkeeping; a refiner adds its step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.protocol import Refinement, given_starts
from pin_metaik.optimize.settings import whole, within

Step: TypeAlias = Callable[[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float], NDArray[np.float64]]
"""dx (n,) from coordinates x (n,), weighted residual r (m,), its Jacobian J (m, n) and |r|^2; not finite: no way on."""

DECADE = 0.01  # once the tolerances are met a further step must bring the squared error below this share,
EXACT = 1e-18  # ... until it is this small: 1e-9 m or rad


@dataclass(frozen=True)
class Patience:
    """When a start is given up.

    Attributes:
        iterations: After this many steps at the latest.
        steps: After any so many steps ...
        share: ... that leave more than this share of the squared error they found.
    """

    iterations: int = 100
    steps: int = 4
    share: float = 0.49

    def __post_init__(self) -> None:
        """Raises InvalidSetting for less than one step, or a share that is none."""
        whole("iterations", self.iterations, 1)
        whole("steps", self.steps, 1)
        within("share", self.share, 0.0, 1.0)


def iterate(
    problem: IKProblem, starts: NDArray[np.float64], evaluations: int, step: Step, patience: Patience
) -> Refinement:
    """Walk from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent.

    A step that leaves the limits is clipped onto them, coordinate by coordinate. Meeting the tolerances is followed by
    further steps for as long as each gains a decade. One evaluation is one residual with its Jacobian.
    """
    starts = given_starts(problem, starts, evaluations)
    chain = problem.chain
    lower, upper = chain.limits.lower, chain.limits.upper
    r = np.empty(problem.m)  # (m,)
    by_coordinate = np.empty((chain.n, problem.m))  # (n, m)
    evaluate = problem._evaluator(r, by_coordinate)
    J = by_coordinate.T
    best, least, spent = np.minimum(np.maximum(starts[0], lower), upper), math.inf, 0
    for start in starts:
        x, mark, found = np.minimum(np.maximum(start, lower), upper), math.inf, False
        for i in range(patience.iterations):
            if spent >= evaluations:
                break
            square, met = evaluate(x)
            spent += 1
            if found and not (met and square < DECADE * least):
                break
            if met or square < least:
                best, least, found = x, square, met
            if found:
                if square < EXACT:
                    break
            elif i % patience.steps == 0:
                if square > patience.share * mark:
                    break
                mark = square
            dx = step(x, r, J, square)
            if not math.isfinite(dx.dot(dx)):
                break
            x = np.minimum(np.maximum(x + dx, lower), upper)
        if found or spent >= evaluations:
            return Refinement(best, found, spent)
    return Refinement(best, False, spent)
