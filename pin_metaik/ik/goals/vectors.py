"""Checks of points, directions and ranges."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget

Direction: TypeAlias = str | ArrayLike
"""``"x"``, ``"y"``, ``"z"``, ``"-x"``, ``"-y"``, ``"-z"``, or any vector (3,) that is not zero."""

AXES = {"x": 0, "y": 1, "z": 2}
LEAST = 1e-9  # length of a vector that still has a direction


def as_point(name: str, given: ArrayLike) -> Array:
    """A point (3,) in m, as an array of its own.

    Raises:
        InvalidTarget: It is none.
    """
    return array(name, given, 3, error=InvalidTarget).copy()


def as_direction(name: str, given: Direction) -> Array:
    """A unit vector (3,).

    Raises:
        InvalidTarget: It is no name of an axis, no vector, or too short to have a direction.
    """
    if isinstance(given, str):
        if given.removeprefix("-") not in AXES:
            raise InvalidTarget(f"{name} is x, y, z, -x, -y, -z or a vector (3,), got {shown(given)}")
        axis: Array = np.eye(3)[AXES[given[-1]]]
        return -axis if given.startswith("-") else axis
    vector = array(name, given, 3, error=InvalidTarget)
    size = math.hypot(*vector)
    if not LEAST <= size < math.inf:
        raise InvalidTarget(f"{name} is a vector (3,) with a direction, got {vector}")
    unit: Array = vector / size
    return unit


def check_range(name: str, least: float, most: float) -> None:
    """Raise InvalidTarget for a range with nothing in it, or with no bound at all."""
    if not least <= most or least == math.inf or most == -math.inf:
        raise InvalidTarget(f"{name} is a range from the least to the most, got {least:g} to {most:g}")
    if least == -math.inf and most == math.inf:
        raise InvalidTarget(f"{name} from -inf to inf is always met: give a bound")


def across(direction: Array) -> Array:
    """Two unit vectors (2, 3) that are normal to a unit vector (3,) and to each other."""
    first = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])
