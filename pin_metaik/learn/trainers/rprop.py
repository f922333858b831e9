"""Resilient backpropagation: the sign of each derivative counts, not its size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.learn.trainers.protocol import Record, TrainingTask


@checked
@dataclass(frozen=True)
class Rprop:
    """Rprop, Riedmiller and Braun 1993, in the form iRprop- (Igel and Huesken 2003): a step is not taken back.

    Attributes:
        up: Growth of a weight's step while its derivative keeps its sign.
        down: Shrinkage when it changes.
        first: First step.
        least: Smallest step.
        most: Largest step.
    """

    up: float = 1.2
    down: float = 0.5
    first: float = 0.07
    least: float = 1e-12
    most: float = 50.0

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Train until the iterations are spent."""
        w = w.copy()
        step, before = np.full(len(w), self.first), np.zeros(len(w))
        _, g = task.loss(w)
        while True:
            agreement = g * before
            step = np.where(agreement > 0, step * self.up, np.where(agreement < 0, step * self.down, step))
            step = np.clip(step, self.least, self.most)
            g = np.where(agreement < 0, 0.0, g)
            w = w - np.sign(g) * step
            before = g
            mse, g = task.loss(w)
            record.tell(w, mse)
