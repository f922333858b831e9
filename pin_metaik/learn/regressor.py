"""A network fitted to data: scaling, training, and a warning for inputs outside the training data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import wrapped
from pin_metaik.learn.network import Network
from pin_metaik.learn.tables import as_table
from pin_metaik.learn.trainers import Trainer, Training, train
from pin_metaik.said import warn
from pin_metaik.watching import Watch

EDGE = 1e-9  # of the range; as far outside is still inside


class OutsideTraining(UserWarning):
    """A network was evaluated outside the range of its training data, where its error is unknown."""


@dataclass(frozen=True, eq=False)
class Scale:
    """Columns mapped from their range to [-1, 1].

    Attributes:
        lower: (d,).
        upper: (d,).
    """

    lower: Array
    upper: Array

    @staticmethod
    def of(table: Array) -> Scale:
        """The scale of a table's own range."""
        return Scale(table.min(axis=0), table.max(axis=0))

    @property
    def half(self) -> Array:
        """Half of the range (d,); 1 for a constant input."""
        width = np.asarray(self.upper - self.lower)
        return np.where(width > 0, width / 2, 1.0)

    def down(self, table: Array) -> Array:
        """To [-1, 1]."""
        scaled: Array = (table - (self.lower + self.upper) / 2) / self.half
        return scaled

    def up(self, table: Array) -> Array:
        """From [-1, 1]."""
        unscaled: Array = table * self.half + (self.lower + self.upper) / 2
        return unscaled


@dataclass(frozen=True, eq=False)
class Regressor:
    """A trained network from inputs to one number.

    Attributes:
        network: Its layers.
        w: Its weights.
        inputs: Scale of the inputs: the training range.
        output: Scale of the output.
        training: How it was trained.
    """

    network: Network
    w: Array
    inputs: Scale
    output: Scale
    training: Training

    def __call__(self, X: ArrayLike) -> Array:
        """Outputs (n,) for inputs X (n, d).

        Warns:
            OutsideTraining: Inputs lie outside the training range.

        Raises:
            InvalidSetting: Inputs that are no table of finite numbers with d columns.
        """
        table = as_table("the inputs", X)
        if table.shape[1] != self.network.inputs:
            raise InvalidSetting(f"the network {self.network} takes {self.network.inputs} inputs, got {table.shape[1]}")
        outside = ~self.covers(table)
        if outside.any():
            warn(
                f"{outside.sum()} of {len(table)} inputs lie outside the training range "
                f"{self.inputs.lower} to {self.inputs.upper}, e.g. {table[outside][0]}: the error there is unknown",
                OutsideTraining,
            )
        return self.predict(table)

    def predict(self, X: Array) -> Array:
        """Outputs (n,) for inputs X (n, d), without a warning outside the training range."""
        return self.output.up(self.network.outputs(self.w, self.inputs.down(self._given(X)))[:, None])[:, 0]

    def covers(self, X: Array) -> NDArray[np.bool_]:
        """Whether each of the inputs X (n, d) lies in the training range (n,)."""
        return np.asarray((np.abs(self.inputs.down(self._given(X))) <= 1 + EDGE).all(axis=1))

    def _given(self, X: Array) -> Array:
        """Inputs (n, d) of a caller, checked."""
        return array("X", X, "n", self.network.inputs, finite=False)


@checked
def fit(
    X: ArrayLike,
    y: ArrayLike,
    hidden: Sequence[int] = (5,),
    trainer: str | Trainer = "lm",
    iterations: int = 1000,
    rng: int | np.random.Generator | None = 0,
    watch: Watch | None = None,
) -> Regressor:
    """Fit a network to data; inputs and output are scaled to [-1, 1] and the mean squared error is minimised.

    Args:
        X: Inputs (n, d).
        y: Outputs (n,).
        hidden: Neurons of each hidden layer.
        trainer: By name or as an object.
        iterations: Largest number of iterations; what an iteration is depends on the trainer.
        rng: Seed or generator of the first weights; ``None`` is a fixed seed.
        watch: Called after every iteration with the number of iterations and the error; returning True ends the
            training.

    Raises:
        InvalidSetting: Data that do not fit together.
        UnknownName: No trainer of that name.
        Interrupted: Ctrl-C; its ``result`` is the network with the best weights so far.
    """
    X = as_table("the inputs", X)
    Y = array("the outputs", y, "n")[:, None]
    if len(X) != len(Y):
        raise InvalidSetting(f"{len(X)} inputs and {len(Y)} outputs: they must match")
    network, inputs, output = Network(X.shape[1], tuple(hidden)), Scale.of(X), Scale.of(Y)
    x, z, first = inputs.down(X), output.down(Y)[:, 0], network.initial(rng)
    return wrapped(
        lambda: train(trainer, network, x, z, first, iterations, watch),
        lambda training: Regressor(network, training.w, inputs, output, training),
    )
