"""The protocol of a trainer: a fit whose error it reduces, and a record that keeps the best weights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.learn.network import Network
from pin_metaik.plain import fields_of
from pin_metaik.watching import Progress, Watch, tell


@dataclass(frozen=True, eq=False)
class TrainingTask:
    """A network and the data it shall fit: mean squared error, residuals and their derivatives.

    Attributes:
        network: Its layers.
        X: Inputs (n, d).
        y: Outputs (n,).
    """

    network: Network
    X: Array
    y: Array

    def residuals(self, w: Array) -> Array:
        """Errors (n,)."""
        return self.network.outputs(w, self.X) - self.y

    def jacobian(self, w: Array) -> Array:
        """Their derivatives by the weights (n, count)."""
        return self.network.jacobian(w, self.X)

    def loss(self, w: Array) -> tuple[float, Array]:
        """Mean squared error and its gradient (count,)."""
        return self.network.gradient(w, self.X, self.y)


class Record:
    """What happened so far. A trainer tells it every iteration; it counts, keeps the best, and stops by an exception.

    Attributes:
        w: Best weights.
        mse: Their mean squared error.
        trace: Error after every iteration.
    """

    def __init__(self, w: Array, mse: float, iterations: int, watch: Watch | None) -> None:
        self.w, self.mse = w.copy(), mse
        self.trace: list[float] = []
        self._iterations, self._watch = iterations, watch

    def tell(self, w: Array, mse: float) -> None:
        """One more iteration led to weights w with this error.

        Raises:
            Finished: It was the last one allowed.
            Stopped: The watch says so.
        """
        if mse < self.mse:
            self.w, self.mse = w.copy(), mse
        self.trace.append(mse)
        tell(self._watch, Progress(len(self.trace), self._iterations, mse))
        if len(self.trace) >= self._iterations:
            raise Finished


class Finished(Exception):
    """The iterations are spent."""


@dataclass(frozen=True, eq=False)
class Training:
    """How a network was trained.

    Attributes:
        w: Best weights found (count,).
        mse: Their mean squared error on the scaled data.
        iterations: Iterations made.
        seconds: Time taken, s.
        converged: Whether the trainer ended by itself, before its iterations were spent.
        interrupted: Whether Ctrl-C or a watch ended it.
        trace: Error after every iteration (i,).
    """

    w: Array
    mse: float
    iterations: int
    seconds: float
    converged: bool
    interrupted: bool
    trace: np.ndarray

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return fields_of(self, "w", "mse", "iterations", "seconds", "converged", "interrupted", "trace")


@runtime_checkable
class Trainer(Protocol):
    """A method that improves weights step by step; its settings are fields of a frozen dataclass."""

    def run(self, task: TrainingTask, w: Array, record: Record, iterations: int) -> None:
        """Improve the weights w (count,), reporting to ``record`` after every iteration; return when nothing improves.

        Args:
            task: What to fit.
            w: Where to begin.
            record: Called after every iteration; it ends the training when the iterations are spent.
            iterations: Largest number of iterations, for trainers that must know it beforehand.
        """
        ...
