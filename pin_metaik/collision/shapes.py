"""Solid shapes in metres, each in a frame of its own: what obstacles and grasped objects are made of."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeAlias

import coal
import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.collision.mesh import Mesh
from pin_metaik.errors import InvalidGeometry


@dataclass(frozen=True)
class Box:
    """A box around the origin.

    Attributes:
        size: Edge lengths along x, y and z, m.
    """

    size: tuple[float, float, float]

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless the size is three finite lengths above 0."""
        if np.shape(self.size) != (3,):
            raise InvalidGeometry(f"the size of a box is three lengths in m, got {self.size!r}")
        object.__setattr__(self, "size", tuple(length("box", "size", edge) for edge in self.size))

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
        length("sphere", "radius", self.radius)

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
        length(kind, "radius", self.radius)
        length(kind, "length", self.length)


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
        size = float(np.linalg.norm(np.asarray(self.normal, dtype=float))) if np.shape(self.normal) == (3,) else 0.0
        if not (math.isfinite(size) and size > 0.0 and math.isfinite(self.offset)):
            raise InvalidGeometry(
                f"a {kind} has a direction (3,) and a finite offset, got {self.normal!r}, {self.offset!r}"
            )

    def _plane(self) -> tuple[NDArray[np.float64], float]:
        normal = np.asarray(self.normal, dtype=float)
        size = float(np.linalg.norm(normal))
        return normal / size, self.offset / size


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


Shape: TypeAlias = Box | Sphere | Cylinder | Capsule | Cone | HalfSpace | Plane | Mesh


def length(kind: str, name: str, value: ArrayLike) -> float:
    """A length in m that is finite and above zero.

    Raises:
        InvalidGeometry: It is not.
    """
    try:
        number = float(value)  # type: ignore[arg-type]  # whatever was given: what float refuses is told
    except (TypeError, ValueError):
        number = math.nan
    if not 0.0 < number < math.inf:
        raise InvalidGeometry(f"the {name} of a {kind} is a length above 0 in m, got {value!r}")
    return number
