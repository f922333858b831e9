"""Newton-Raphson steps with the pseudo-inverse of the Jacobian."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.optimize.settings import within


@dataclass(frozen=True)
class Newton:
    """Newton-Raphson, dx = -J^+ r (Whitney 1969), clipped at the limits.

    Only the cutoff limits the step near singular poses: a classical method for comparison, quick at regular poses.

    Attributes:
        cutoff: Singular values of J below this share of the largest count as 0.
        patience: When a start is given up.
    """

    cutoff: float = 1e-3
    patience: Patience = field(default=Patience())

    def __post_init__(self) -> None:
        """Raises InvalidSetting for a cutoff that is no share."""
        within("cutoff", self.cutoff, 0.0, 1.0)

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        return iterate(problem, starts, evaluations, self.step, self.patience)

    def step(
        self, x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
    ) -> NDArray[np.float64]:
        """dx (n,) for a residual r (m,) and its Jacobian J (m, n): the shortest that leaves least of r."""
        shortest = np.linalg.lstsq(J, r, rcond=self.cutoff)[0]  # J^+ r
        return np.asarray(-shortest, dtype=np.float64)
