"""Test functions with a known optimum that is not at the origin, for tests, benchmarks and first tries.

Shifted, because some algorithms drift to the origin (the update of GWO contains ``|C leader - x|``): with the optimum
there, they would be praised for a fault.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import lookup
from pin_metaik.optimize.settings import whole
from pin_metaik.optimize.space import Box


def sphere(Z: Array) -> Array:
    """``sum z^2``: one bowl."""
    return np.asarray((Z**2).sum(axis=-1))


def rosenbrock(Z: Array) -> Array:
    """``sum 100 (y_{i+1} - y_i^2)^2 + (1 - y_i)^2`` with y = z + 1: a bent valley; a bowl in one dimension."""
    if Z.shape[-1] == 1:
        return sphere(Z)
    y, y_next = Z[..., :-1] + 1, Z[..., 1:] + 1
    return np.asarray((100 * (y_next - y**2) ** 2 + (1 - y) ** 2).sum(axis=-1))


def rastrigin(Z: Array) -> Array:
    """``sum z^2 - 10 cos(2 pi z) + 10``: a bowl full of dents, one at every whole number."""
    return np.asarray((Z**2 - 10 * np.cos(2 * np.pi * Z) + 10).sum(axis=-1))


def ackley(Z: Array) -> Array:
    """``20 - 20 exp(-0.2 rms z) + e - exp(mean cos(2 pi z))``: a funnel in a dented plain."""
    funnel = 20 * np.exp(-0.2 * np.sqrt((Z**2).mean(axis=-1)))
    return np.asarray(20 - funnel + np.e - np.exp(np.cos(2 * np.pi * Z).mean(axis=-1)))


FUNCTIONS: dict[
    str, tuple[Callable[[Array], Array], float]
] = {  # the formula, least at z = 0, and half the box's width
    "sphere": (sphere, 100.0),
    "rosenbrock": (rosenbrock, 5.0),
    "rastrigin": (rastrigin, 5.12),
    "ackley": (ackley, 32.0),
}


@dataclass(frozen=True, eq=False)
class Shifted:
    """A test function moved so that its least cost, 0, is at `optimum`.

    Attributes:
        name: Its name in FUNCTIONS.
        box: Where to search: the usual box around the origin.
        optimum: Its best point (n,), inside the box.
    """

    name: str
    box: Box
    optimum: Array

    def __call__(self, X: Array) -> Array:
        """Costs (k,) of points X (k, n)."""
        formula, _ = FUNCTIONS[self.name]
        return formula(X - self.optimum)


def shifted(name: str, dimension: int, shift: ArrayLike | None = None) -> Shifted:
    """A test function by name.

    Args:
        name: One of FUNCTIONS.
        dimension: Number of coordinates n.
        shift: Where to put the optimum: (n,) or one number for all coordinates. By default at irregular places, up to
            half-way from the middle of the box to its walls.

    Raises:
        UnknownName: No function of that name.
        InvalidSetting: A dimension below 1, or a shift that leaves the box.
    """
    _, half = lookup("test function", name, FUNCTIONS)
    whole("dimension", dimension, 1)
    box = Box(np.full(dimension, -half), np.full(dimension, half))
    if shift is None:
        shift = 0.5 * half * np.cos(np.arange(2, dimension + 2))
    optimum = np.zeros(dimension) + np.asarray(shift, dtype=float)
    if not box.contains(optimum):
        raise InvalidSetting(f"shift {shift} puts the optimum of {name} outside its box of +-{half:g}")
    return Shifted(name, box, optimum)
