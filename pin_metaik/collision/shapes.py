"""Solid shapes in metres, each in a frame of its own: what obstacles and grasped objects are made of."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeAlias

import coal
import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.clouds import HeightField, Octree, PointCloud
from pin_metaik.collision.mesh import Mesh
from pin_metaik.collision.numbers import real, three
from pin_metaik.errors import InvalidGeometry


@dataclass(frozen=True)
class Box:
    """A solid box centred at the origin; ``mik.Box`` is another class, the search space of an optimisation.

    Attributes:
        size: Edge lengths along x, y and z, m.
    """

    size: tuple[float, float, float]

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless the size is three finite lengths above 0."""
        edges = three(self.size)
        if edges is None:
            raise InvalidGeometry(f"the size of a box is three lengths in m, got {self.size!r}")
        object.__setattr__(self, "size", tuple(length("box", "size", edge) for edge in edges))

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Box(*self.size)


@dataclass(frozen=True)
class Sphere:
    """A ball around the origin.

    Attributes:
        radius: m.
    """

    radius: float

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless the radius is finite and above 0."""
        object.__setattr__(self, "radius", length("sphere", "radius", self.radius))

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Sphere(self.radius)


@dataclass(frozen=True)
class _Round:
    """What cylinders, capsules and cones share: a radius about the z axis, and a length along it."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless radius and length are finite and above 0."""
        kind = type(self).__name__.lower()
        object.__setattr__(self, "radius", length(kind, "radius", self.radius))
        object.__setattr__(self, "length", length(kind, "length", self.length))


@dataclass(frozen=True)
class Cylinder(_Round):
    """A cylinder about the z axis, centred at the origin.

    Attributes:
        radius: m.
        length: m.
    """

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Cylinder(self.radius, self.length)


@dataclass(frozen=True)
class Capsule(_Round):
    """A cylinder about the z axis with half a ball at each end, centred at the origin.

    Attributes:
        radius: m.
        length: m, without the balls.
    """

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Capsule(self.radius, self.length)


@dataclass(frozen=True)
class Cone(_Round):
    """A cone about the z axis: its base at z = -length / 2, its tip at z = length / 2.

    Attributes:
        radius: m, of the base.
        length: m, from the base to the tip.
    """

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Cone(self.radius, self.length)


@dataclass(frozen=True)
class _Flat:
    """What planes and half-spaces share: the points p with normal . p = offset."""

    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless the normal is a finite direction and the offset finite."""
        kind = type(self).__name__.lower()
        normal, offset = three(self.normal), real(self.offset)
        size = math.inf if normal is None else math.hypot(*normal)
        if not 0.0 < size < math.inf:
            raise InvalidGeometry(f"the normal of a {kind} is a direction (3,), got {self.normal!r}")
        if not math.isfinite(offset / size):
            raise InvalidGeometry(f"the offset of a {kind} is a finite number, got {self.offset!r}")
        object.__setattr__(self, "normal", normal)
        object.__setattr__(self, "offset", offset)

    def _plane(self) -> tuple[NDArray[np.float64], float]:
        size = math.hypot(*self.normal)
        return np.array(self.normal) / size, self.offset / size


@dataclass(frozen=True)
class HalfSpace(_Flat):
    """Everything on one side of a plane: the points p with normal . p <= offset. A floor is ``HalfSpace()``.

    Attributes:
        normal: Direction out of the solid; any length.
        offset: normal . p on its surface.
    """

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Halfspace(*self._plane())


@dataclass(frozen=True)
class Plane(_Flat):
    """A sheet without thickness or end: the points p with normal . p = offset.

    Attributes:
        normal: Direction across it; any length.
        offset: normal . p on it.
    """

    def geometry(self) -> Any:
        """The shape as coal has it."""
        return coal.Plane(*self._plane())


Shape: TypeAlias = (
    Box | Sphere | Cylinder | Capsule | Cone | HalfSpace | Plane | Mesh | PointCloud | Octree | HeightField
)


LARGEST = 1e6
"""m; coal's distances of larger bodies are rounded to more than a tenth of a millimetre."""


def length(kind: str, name: str, value: object) -> float:
    """A length in m that is above zero and at most ``LARGEST``.

    Raises:
        InvalidGeometry: It is not.
    """
    number = real(value)
    if not 0.0 < number < math.inf:
        raise InvalidGeometry(f"the {name} of a {kind} is a length above 0 in m, got {value!r}")
    if number > LARGEST:
        raise InvalidGeometry(
            f"the {name} of a {kind} is at most {LARGEST:g} m, got {value!r}; a floor or a wall "
            "without end is a HalfSpace"
        )
    return number
