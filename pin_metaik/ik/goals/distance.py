"""The goal of a frame at a distance from a point, or between two distances."""

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
from pin_metaik.ik.goals.vectors import as_point, check_range


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Distance(OfFrame):
    """A frame's origin between two distances from a point: y = |p - point|.

    With a ``reference`` the point is given in that frame: ``Distance(hand, (0, 0, 0), reference=other, least=0.2)``
    keeps two hands apart.

    Attributes:
        point: (3,), m.
        least: The least distance, m.
        most: The largest distance, m; equal to ``least`` for exactly that distance.

    Raises:
        InvalidTarget: If the point is not (3,) finite numbers, a distance is below zero, ``least`` is above ``most``,
            or neither bounds anything.
    """

    point: ArrayLike
    _: KW_ONLY
    least: float = 0.0
    most: float = math.inf
    _origin: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        check_range("the distance", self.least, self.most)
        if self.least < 0.0:
            raise InvalidTarget(f"a distance is at least 0, got {self.least:g}")
        if self.least == 0.0 and self.most == math.inf:
            raise InvalidTarget("a distance from 0 to inf is always met: give least or most")
        object.__setattr__(self, "_origin", as_point("point", self.point))

    def _values(self, at: Placed) -> Array:
        return np.array([math.hypot(*(self._point(at) - self._origin))])

    def _slopes(self, at: Placed) -> Array:
        away = self._point(at) - self._origin
        size = math.hypot(*away)
        outward = away / size if size > 0.0 else np.array([1.0, 0.0, 0.0])  # from the point itself any way leads out
        return outward[None] @ self._speeds(at)

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return self.least, self.most
