"""Levenberg-Marquardt by MINPACK, through scipy: a control for our own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.learn.trainers.protocol import Record, TrainingTask

EPSILON = float(np.finfo(float).eps)


@checked
@dataclass(frozen=True)
class Minpack:
    """Levenberg-Marquardt as More 1978 wrote it: a trust region, QR instead of normal equations.

    An iteration is one trial step. Slower than ``LevenbergMarquardt``, as each step factors the whole Jacobian.

    Attributes:
        tolerance: Relative change of the error or the weights that counts as none.
    """

    tolerance: float = EPSILON

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Train; needs at least as many data as weights."""
        told = False

        def residuals(w: Array) -> Array:
            nonlocal told
            error = task.residuals(w)
            if told:  # the first call is the start itself
                record.tell(w, float(np.mean(np.square(error))))
            told = True
            return error

        limits = {"ftol": self.tolerance, "xtol": self.tolerance, "gtol": self.tolerance}
        least_squares(residuals, w, jac=task.jacobian, method="lm", max_nfev=10 * iterations, **limits)
