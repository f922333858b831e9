"""Servos that move legs (6-RSS): horns on shafts with any axes, and rods of fixed length."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked_as, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry

LEVEL = 1e-9  # sine of the angle below which two directions count as one
Vector = tuple[float, float, float]


@checked_as(InvalidGeometry)
@dataclass(frozen=True)
class Servos:
    """Servos with horns and rods, one for each leg. Lengths in m, angles in rad.

    Their axes are given by ``directions``, in the plane of the base, or by ``axes`` and ``zeros``, any vectors in the
    base frame.

    Attributes:
        horn: Length of a horn, from the shaft to the joint of the rod; one for all legs, or one each.
        rod: Length of a rod between its joints, likewise.
        directions: Directions of the horns at angle 0, one each, as angles from the x axis seen from above: the axes
            lie in the plane of the base, and positive angles raise the horns.
        axes: Axes of the shafts, one vector each, of any length; a positive angle turns right-handed about it.
        zeros: Directions of the horns at angle 0, one vector each, of which the component normal to the axis is used.
            None: horizontal, so that positive angles raise the horns; not possible for vertical axes.
        branches: Which of the two possible angles each servo has, +1 or -1; one for all legs, or one each. On branch +1
            a horn that turns to larger angles pushes its rod, on -1 it pulls.

    Raises:
        InvalidGeometry: A length that is not above zero, neither ``directions`` nor ``axes`` or both of them, an axis
            of length zero, a vector of ``zeros`` along its axis, another branch, or values for more or fewer legs than
            there are.
    """

    horn: float | tuple[float, ...]
    rod: float | tuple[float, ...]
    directions: tuple[float, ...] = ()
    axes: tuple[Vector, ...] | None = None
    zeros: tuple[Vector, ...] | None = None
    branches: int | tuple[int, ...] = 1

    def __post_init__(self) -> None:
        for name in ("horn", "rod"):
            object.__setattr__(self, name, _lengths(f"the {name} of a servo", getattr(self, name)))
        object.__setattr__(self, "directions", tuple(_numbers("directions of servos", self.directions)))
        for name in ("axes", "zeros"):
            if (given := getattr(self, name)) is not None:
                vectors = array(f"{name} of servos", given, "legs", 3, error=InvalidGeometry)
                object.__setattr__(self, name, tuple(map(tuple, vectors.tolist())))
        if (self.axes is None) == (not self.directions):
            raise InvalidGeometry("servos have either directions or axes, one for each leg")
        if self.zeros is not None and self.axes is None:
            raise InvalidGeometry("zeros of servos go with axes; directions say where horns point at angle 0")
        if not set(np.ravel(self.branches).tolist()) <= {1, -1}:
            raise InvalidGeometry(f"branches of servos are 1 or -1, got {self.branches!r}")
        for name in ("horn", "rod", "zeros", "branches"):
            value = getattr(self, name)
            if isinstance(value, tuple) and len(value) != self.legs:
                raise InvalidGeometry(f"{name} of servos: {len(value)} for {self.legs} axes")
        _ = self.frames  # says what is wrong with axes and zeros

    @property
    def legs(self) -> int:
        """How many legs have an axis."""
        return len(self.directions or self.axes or ())

    @cached_property
    def frames(self) -> Array:
        """Unit vectors u, w, a of each servo as rows, in the base frame (n, 3, 3)."""
        if self.axes is None:
            angles = np.array(self.directions)
            u = np.column_stack((np.cos(angles), np.sin(angles), np.zeros_like(angles)))
            w = np.tile([0.0, 0.0, 1.0], (len(angles), 1))
            return np.stack((u, w, np.cross(u, w)), axis=1)
        a = _units("axes", np.array(self.axes))
        if self.zeros is None:
            level = np.cross([0.0, 0.0, 1.0], a)
            for leg in np.flatnonzero(np.linalg.norm(level, axis=1) < LEVEL):
                raise InvalidGeometry(f"the axis of servo {leg + 1} is vertical: give zeros, where horns point at 0")
        else:
            given = _units("zeros", np.array(self.zeros))
            level = given - (given * a).sum(axis=1, keepdims=True) * a
            for leg in np.flatnonzero(np.linalg.norm(level, axis=1) < LEVEL):
                raise InvalidGeometry(f"zeros of servos: that of servo {leg + 1} points along its axis")
        u = level / np.linalg.norm(level, axis=1, keepdims=True)
        return np.stack((u, np.cross(a, u), a), axis=1)

    @cached_property
    def rows(self) -> Array:
        """Each servo for the compiled functions: u, w, a, horn, rod, branch (n, 12)."""
        parts = (self.frames.reshape(-1, 9), *(each(self, name) for name in ("horn", "rod", "branches")))
        return np.column_stack(parts)


def each(servos: Servos, name: str) -> Array:
    """The horn, the rod or the branch of each leg (n,)."""
    return np.broadcast_to(np.asarray(getattr(servos, name), dtype=float), servos.legs)


def turned(servos: Servos, angles: Array) -> Servos:
    """Servos, each turned about the vertical by an angle in rad (n,), as if its joint went round a circle."""
    if servos.axes is None:
        return replace(servos, directions=tuple((np.array(servos.directions) + angles).tolist()))
    cos, sin = np.cos(angles), np.sin(angles)
    ways: dict[str, Any] = {}
    for name in ("axes", "zeros"):
        if getattr(servos, name) is not None:
            x, y, z = np.array(getattr(servos, name)).T
            ways[name] = tuple(map(tuple, np.column_stack((cos * x - sin * y, sin * x + cos * y, z)).tolist()))
    return replace(servos, **ways)


def _numbers(name: str, values: Any) -> list[float]:
    if isinstance(values, str) or not np.iterable(values):
        raise InvalidGeometry(f"{name} are a list of numbers, got {values!r}")
    return [float(number(name, value, InvalidGeometry)) for value in values]


def _lengths(name: str, value: Any) -> float | tuple[float, ...]:
    each = not isinstance(value, str) and np.iterable(value)
    numbers = _numbers(name, value if each else [value])
    for one in numbers:
        if not one > 0.0:
            raise InvalidGeometry(f"{name} is longer than zero, got {one:g} m")
    return tuple(numbers) if each else numbers[0]


def _units(name: str, vectors: ArrayLike) -> Array:
    given = np.asarray(vectors, dtype=float)
    sizes = np.linalg.norm(given, axis=1, keepdims=True)
    for leg in np.flatnonzero(~(sizes[:, 0] > 0.0)):
        raise InvalidGeometry(f"{name} of servos: that of servo {leg + 1} has no direction")
    return np.asarray(given / sizes)
