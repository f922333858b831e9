"""Trainers of networks under one interface: write one file with a `run` method and add its line to ``TRAINERS``."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.learn.network import Network
from pin_metaik.learn.trainers.bfgs import BFGS
from pin_metaik.learn.trainers.levenberg import LevenbergMarquardt
from pin_metaik.learn.trainers.minpack import Minpack
from pin_metaik.learn.trainers.protocol import Finished, Record, Trainer, Training, TrainingTask
from pin_metaik.learn.trainers.rprop import Rprop
from pin_metaik.learn.trainers.scg import SCG
from pin_metaik.lookup import lookup
from pin_metaik.watching import Watch, ended

TRAINERS: dict[str, type[Trainer]] = {
    "lm": LevenbergMarquardt,
    "minpack": Minpack,
    "bfgs": BFGS,
    "rprop": Rprop,
    "scg": SCG,
}


@checked
def make_trainer(trainer: str | Trainer) -> Trainer:
    """A trainer from its name, with its default settings; an object is returned unchanged.

    Raises:
        UnknownName: No trainer of that name.
    """
    if not isinstance(trainer, str):
        return trainer
    return lookup("trainer", trainer, TRAINERS)()


@checked
def train(
    trainer: str | Trainer,
    network: Network,
    X: Array,
    y: Array,
    w: Array,
    iterations: int,
    watch: Watch | None = None,
) -> Training:
    """Train a network from weights w.

    Args:
        trainer: By name or as an object.
        network: The layers.
        X: Inputs (n, d), scaled.
        y: Outputs (n,), scaled.
        w: First weights (count,).
        iterations: At most.
        watch: Called after every iteration with their number and the mean squared error; True ends the training.

    Raises:
        UnknownName: No trainer of that name.
        InvalidSetting: Fewer than one iteration, or fewer data than weights.
        Interrupted: Ctrl-C; its ``result`` is the training so far, with the best weights.
    """
    trainer = make_trainer(trainer)
    X, w = array("X", X, "n", network.inputs), array("w", w, network.count)
    y = array("y", y, len(X))
    if iterations < 1:
        raise InvalidSetting(f"iterations must be at least 1, not {iterations!r}")
    if len(X) < network.count:
        raise InvalidSetting(f"{len(X)} data are too few for the {network.count} weights of {network}")
    task = TrainingTask(network, X, y)
    record = Record(w, task.loss(w)[0], iterations, watch)
    began = perf_counter()

    def trained(converged: bool, interrupted: bool = False) -> Training:
        seconds, trace = perf_counter() - began, np.array(record.trace)
        return Training(record.w, record.mse, len(trace), seconds, converged, interrupted, trace)

    try:
        trainer.run(task, w, record, iterations)
    except Finished:
        return trained(converged=False)
    except KeyboardInterrupt as stop:
        return ended(stop, trained(converged=False, interrupted=True))
    return trained(converged=True)


__all__ = [
    "BFGS",
    "SCG",
    "TRAINERS",
    "LevenbergMarquardt",
    "Minpack",
    "Rprop",
    "Trainer",
    "Training",
    "make_trainer",
    "train",
]
