"""Jacobian transpose steps: steepest descent with the step length that is optimal for the linearised robot."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.protocol import Refinement


@dataclass(frozen=True)
class Transpose:
    """Jacobian transpose, dx = -alpha J'r (Wolovich and Elliott 1984), clipped at the limits.

    alpha minimises |r + J dx| (Buss 2004). It needs no inverse and never overshoots far, and it converges only
    linearly: hundreds of steps where J is ill-conditioned.

    Attributes:
        patience: When a start is given up.
    """

    patience: Patience = field(default=Patience(iterations=2000, steps=50, share=0.8))

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        return iterate(problem, starts, evaluations, self.step, self.patience)

    def step(
        self, x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
    ) -> NDArray[np.float64]:
        """dx (n,) for a residual r (m,) and its Jacobian J (m, n)."""
        g = J.T @ r
        Jg = J @ g
        curvature = float(Jg @ Jg)
        if curvature == 0.0:
            return np.full_like(x, np.nan)
        alpha = float(r @ Jg) / curvature
        return -alpha * g
