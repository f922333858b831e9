"""Trained networks on disk: numbers and names in a ``.npz``, which nothing is run from when it is read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting, MetaIKError
from pin_metaik.files import read_arrays
from pin_metaik.learn.network import Network
from pin_metaik.learn.regressor import Regressor, Scale
from pin_metaik.learn.trainers import Training
from pin_metaik.output import writable

SUFFIX = ".npz"
VERSION = 1
NETWORK = "a saved network"  # what such a file is, in messages
KEYS = ("version", "layers", "weights", "inputs", "output", "trace", "trained")


@checked
def save_regressor(regressor: Regressor, file: str | Path) -> None:
    """Write a trained network: its weights, scales, and how it was trained.

    Args:
        regressor: The network.
        file: The file, ``.npz``.

    Raises:
        InvalidSetting: Another suffix.
        CannotWrite: The file cannot be written.
    """
    save_arrays(network_file(file), arrays_of(regressor))


@checked
def load_regressor(file: str | Path) -> Regressor:
    """Read a network that ``save_regressor`` wrote; its outputs are the same to the last bit.

    Raises:
        InvalidSetting: The file is missing, or does not hold a network.
    """
    return regressor_of(read_arrays(Path(file), InvalidSetting, NETWORK), str(file))


def network_file(file: str | Path) -> Path:
    """The path of a file that a network can be written to."""
    if Path(file).suffix.lower() != SUFFIX:
        raise InvalidSetting(f"a network is written as {SUFFIX}, not as {str(file)!r}")
    return writable(file)


def arrays_of(regressor: Regressor) -> dict[str, Any]:
    """A network as arrays by name."""
    training = regressor.training
    return {
        "version": VERSION,
        "layers": np.array(regressor.network.sizes),
        "weights": regressor.w,
        "inputs": np.array([regressor.inputs.lower, regressor.inputs.upper]),
        "output": np.array([regressor.output.lower, regressor.output.upper]),
        "trace": training.trace,
        "trained": np.array([training.mse, training.iterations, training.seconds, training.converged], dtype=float),
    }


def save_arrays(file: Path, arrays: Mapping[str, Any]) -> None:
    """Write arrays by name."""
    with file.open("wb") as opened:
        np.savez(opened, **{name: np.asarray(values) for name, values in arrays.items()})  # type: ignore[arg-type]


def regressor_of(arrays: Mapping[str, np.ndarray], place: str) -> Regressor:
    """The network in arrays by name."""
    if missing := [key for key in KEYS if key not in arrays]:
        raise InvalidSetting(f"{place} is not a saved network: it has no {', '.join(missing)}")
    try:
        if int(arrays["version"]) != VERSION:
            raise InvalidSetting(f"it is of version {int(arrays['version'])}, and {VERSION} is known")
        first, *hidden, last = (int(size) for size in arrays["layers"])
        network = Network(first, tuple(hidden))
        w = numbers(arrays["weights"], network.count)
        if last != 1:
            raise InvalidSetting(f"it has {last} outputs, not one")
        inputs, output = (Scale(*numbers(arrays[key], 2, n)) for key, n in (("inputs", first), ("output", 1)))
        mse, iterations, seconds, converged = numbers(arrays["trained"], 4).tolist()
        trace = numbers(arrays["trace"], np.size(arrays["trace"]))
    except (MetaIKError, ValueError, TypeError, OverflowError) as error:
        raise InvalidSetting(f"{place} is not a saved network: {error}") from None
    training = Training(w, mse, int(iterations), seconds, bool(converged), False, trace)
    return Regressor(network, w, inputs, output, training)


def numbers(values: np.ndarray, *shape: int) -> Array:
    """Finite numbers of a shape.

    Raises:
        InvalidSetting: They are not.
    """
    found = np.asarray(values, dtype=float)
    if found.shape != shape or not np.isfinite(found).all():
        raise InvalidSetting(f"expected finite numbers of shape {shape}, got shape {found.shape}")
    return found
