"""The goal of a frame on a line, or on a part of it."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import OfFrame
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.vectors import Direction, across, as_direction, as_point, check_range


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class OnLine(OfFrame):
    """A frame's origin on a line through a point, or on a segment of it: y = B (p - point).

    The rows of B are two unit vectors normal to the line, and its direction; the first two of y are 0, the third is
    between ``least`` and ``most``.

    Attributes:
        point: A point (3,) of the line, m.
        direction: Direction of the line: ``"x"``, ``"-z"``, ..., or a vector (3,).
        least: Lower bound of the distance (m) from the point along the direction.
        most: Upper bound of that distance, m.

    Raises:
        InvalidTarget: If the point or the direction is not a finite vector (3,), or ``least`` is above ``most``.
    """

    point: ArrayLike
    direction: Direction
    _: KW_ONLY
    least: float = -math.inf
    most: float = math.inf
    _origin: Array = field(init=False, repr=False)
    _across: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        direction = as_direction("direction", self.direction)
        if (self.least, self.most) != (-math.inf, math.inf):
            check_range("the part of the line", self.least, self.most)
        object.__setattr__(self, "_origin", as_point("point", self.point))
        object.__setattr__(self, "_across", np.concatenate([across(direction), direction[None]]))

    def _values(self, at: Placed) -> Array:
        away: Array = self._across @ (self._point(at) - self._origin)
        return away

    def _slopes(self, at: Placed) -> Array:
        return self._across @ self._speeds(at)

    def _bounds(self, at: Placed) -> tuple[Array, Array]:
        return np.array([0.0, 0.0, self.least]), np.array([0.0, 0.0, self.most])
