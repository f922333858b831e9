"""The goal of a frame on a plane, or on one side of it."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field

from numpy.typing import ArrayLike

from pin_metaik.arguments import checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import OfFrame
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.vectors import Direction, as_direction, as_point, check_range


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class OnPlane(OfFrame):
    """A frame's origin on a plane, or between two parallel planes: y = normal . (p - point).

    ``OnPlane(frame, point, "z", most=inf)`` is the half space above a point.

    Attributes:
        point: A point (3,) of the plane, m.
        normal: Normal of the plane: ``"x"``, ``"-z"``, ..., or a vector (3,).
        least: Lower bound of the height (m) over the plane.
        most: Upper bound of that height, m.

    Raises:
        InvalidTarget: If the point or the normal is not a finite vector (3,), or ``least`` is above ``most``.
    """

    point: ArrayLike
    normal: Direction
    _: KW_ONLY
    least: float = 0.0
    most: float = 0.0
    _origin: Array = field(init=False, repr=False)
    _normal: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        check_range("the height over the plane", self.least, self.most)
        object.__setattr__(self, "_origin", as_point("point", self.point))
        object.__setattr__(self, "_normal", as_direction("normal", self.normal)[None])

    def _values(self, at: Placed) -> Array:
        height: Array = self._normal @ (self._point(at) - self._origin)
        return height

    def _slopes(self, at: Placed) -> Array:
        return self._normal @ self._speeds(at)

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return self.least, self.most
