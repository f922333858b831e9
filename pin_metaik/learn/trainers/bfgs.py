"""Quasi-Newton: BFGS, by scipy."""

from __future__ import annotations

from dataclasses import dataclass

from scipy.optimize import OptimizeResult, minimize

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.learn.trainers.protocol import Record, TrainingTask


@checked
@dataclass(frozen=True)
class BFGS:
    """Broyden, Fletcher, Goldfarb and Shanno 1970; an iteration is one line search.

    Attributes:
        tolerance: Largest component of the gradient that counts as zero.
    """

    tolerance: float = 1e-12

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Train."""

        def tell(intermediate_result: OptimizeResult) -> None:
            record.tell(intermediate_result.x, float(intermediate_result.fun))

        options = {"maxiter": iterations, "gtol": self.tolerance}
        minimize(task.loss, w, jac=True, method="BFGS", callback=tell, options=options)
