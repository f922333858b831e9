"""Scaled conjugate gradient: conjugate directions without a line search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.learn.trainers.protocol import Record, TrainingTask


@checked
@dataclass(frozen=True)
class SCG:
    """Scaled conjugate gradient, Moller 1993, Neural Networks 6; variables and steps as numbered there.

    Attributes:
        sigma: Step of the difference that estimates the curvature.
        lamda: First scale, which is added to the curvature to make it positive.
    """

    sigma: float = 5e-5
    lamda: float = 5e-7

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Train until the iterations are spent or the gradient vanishes."""
        lamda, bar = self.lamda, 0.0
        E, g = task.loss(w)
        r = p = -g  # step 1
        success, k = True, 0
        while True:
            k += 1
            p2 = float(p @ p)
            if p2 == 0.0 or not np.isfinite(p2):
                return
            if success:  # step 2: second order information
                sigma = self.sigma / np.sqrt(p2)
                s = (task.loss(w + sigma * p)[1] - g) / sigma
                delta = float(p @ s)
            delta += (lamda - bar) * p2  # step 3: scale
            if delta <= 0:  # step 4: make the Hessian positive definite
                bar = 2 * (lamda - delta / p2)
                delta = -delta + lamda * p2
                lamda = bar
            mu = float(p @ r)  # step 5: step size
            alpha = mu / delta
            E_new, g_new = task.loss(w + alpha * p)
            Delta = 2 * delta * (E - E_new) / mu**2 if mu else 0.0  # step 6: comparison
            success = Delta >= 0
            if success:  # step 7
                w, E, g = w + alpha * p, E_new, g_new
                r_new = -g
                bar = 0.0
                if k % len(w) == 0:
                    p = r_new
                else:
                    beta = float(r_new @ r_new - r_new @ r) / mu
                    p = r_new + beta * p
                r = r_new
                if Delta >= 0.75:
                    lamda /= 4
            else:
                bar = lamda
            if Delta < 0.25:  # step 8
                lamda += delta * (1 - Delta) / p2
            record.tell(w, E)
            if not np.isfinite(lamda) or not r.any():  # step 9
                return
