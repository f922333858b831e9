"""Levenberg-Marquardt: between Gauss-Newton and the gradient, as the last step fared. The one for small networks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.learn.trainers.protocol import Record, TrainingTask

HOPELESS = 1e12  # damping at which no step is left
PIECE = 64  # rows


@checked
@dataclass(frozen=True)
class LevenbergMarquardt:
    """Levenberg-Marquardt on the normal equations, Hagan and Menhaj 1994, IEEE Trans. Neural Networks 5.

    ``(J^T J + mu I) dw = -J^T e``; an iteration is one accepted step.

    Attributes:
        mu: First damping, above 0.
        up: Its growth after a step that did not help, above 1.
        down: Its shrinkage after one that did, above 0 and at most 1.

    Raises:
        InvalidSetting: A setting out of its range.
    """

    mu: float = 1e-3
    up: float = 10.0
    down: float = 0.1

    def __post_init__(self) -> None:
        """Check that the damping grows: where no step helps, that is what ends the search for one."""
        if not (self.mu > 0.0 and self.up > 1.0 and 0.0 < self.down <= 1.0):
            raise InvalidSetting(
                f"Levenberg-Marquardt takes mu above 0, up above 1 and down in (0, 1], got {self.mu}, {self.up}, "
                f"{self.down}"
            )

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Train until the iterations are spent or no step helps."""
        mu, identity = self.mu, np.eye(len(w))
        e = task.residuals(w)
        E = float(e @ e)
        while True:
            J = task.jacobian(w)
            H, g = _normal(J), J.T @ e
            while True:
                try:
                    dw = np.linalg.solve(H + mu * identity, -g)
                except np.linalg.LinAlgError:
                    E_new = np.inf
                else:
                    e_new = task.residuals(w + dw)
                    E_new = float(e_new @ e_new)
                if E_new < E:
                    break
                mu *= self.up
                if mu > HOPELESS:
                    return
            w, e, E = w + dw, e_new, E_new
            mu *= self.down
            record.tell(w, E / len(e))


def _normal(J: Array) -> Array:
    """``J^T J`` (w, w), in pieces that BLAS does not spread over threads.

    On two busy cores a product of this size on two threads takes 1 to 25 ms, waiting for the other one; so 0.3 ms.
    """
    H = np.zeros((J.shape[1], J.shape[1]))
    for first in range(0, len(J), PIECE):
        piece = J[first : first + PIECE]
        H += piece.T @ piece
    return H
