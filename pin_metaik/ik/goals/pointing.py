"""The goal of an axis of a frame that points in a direction, or within a cone around it."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import pinocchio as pin

from pin_metaik.arguments import checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import OfFrame
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.vectors import Direction, as_direction


@dataclass(frozen=True, eq=False)
class Aimed(OfFrame):
    """A frame's axis a along a direction d: y = a - d, a chord, of length 2 sin(angle / 2).

    The tolerance (rad) is half the opening of the cone around the direction that the axis may be in.
    """

    _axis: Array = field(init=False, repr=False)
    unit: ClassVar[str] = "rad"

    def _aim_with(self, axis: Direction) -> None:
        """Take an axis of the frame; raises InvalidTarget for none, or a tolerance of half a turn and more."""
        if self.tolerance >= math.pi:
            raise InvalidTarget(f"tolerance is below pi rad, as every direction is within pi, got {self.tolerance:g}")
        object.__setattr__(self, "_axis", as_direction("axis", axis))

    @abstractmethod
    def _aim(self, at: Placed) -> tuple[Array, Array | float]:
        """The direction d (3,), of length 1, and its derivative (3, n), or 0 where it is fixed."""

    @cached_property
    def _radius(self) -> float:
        return 2.0 * math.sin(0.5 * self.tolerance)

    def _values(self, at: Placed) -> Array:
        chord: Array = at.pose(self.frame, self.reference).rotation @ self._axis - self._aim(at)[0]
        return chord

    def _slopes(self, at: Placed) -> Array:
        axis = at.pose(self.frame, self.reference).rotation @ self._axis
        slopes: Array = -pin.skew(axis) @ at.jacobian(self.frame, self.reference)[3:] - self._aim(at)[1]
        return slopes

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return 0.0, 0.0

    def off(self, at: Placed) -> dict[str, float]:
        """The angle between axis and direction."""
        return {self.unit: 2.0 * math.asin(min(0.5 * self._excess(at), 1.0))}


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Pointing(Aimed):
    """An axis of a frame points in a direction; the tolerance is the half opening (rad) of the cone around it.

    ``Pointing("hand", "z", "-z")`` points down, ``Pointing("hand", "z", "z", tolerance=0.1)`` carries a cup upright.

    Attributes:
        axis: Axis of the frame: ``"x"``, ``"-z"``, ..., or a vector (3,) in the frame's coordinates.
        direction: Likewise, in the world or in the reference frame.

    Raises:
        InvalidTarget: If the axis or the direction is not a finite vector (3,), or the tolerance is half a turn or
            more.
    """

    axis: Direction
    direction: Direction
    _direction: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        self._aim_with(self.axis)
        object.__setattr__(self, "_direction", as_direction("direction", self.direction))

    def _aim(self, at: Placed) -> tuple[Array, float]:
        return self._direction, 0.0
