"""The goal of a frame that looks at a point."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.pointing import Aimed
from pin_metaik.ik.goals.vectors import Direction, as_point

NEAREST = 1e-9  # m, of a point that still is in some direction


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class LookAt(Aimed):
    """An axis of a frame points from its origin p to a point c: d = (c - p) / |c - p|. The roll about it is free.

    With a ``reference`` the point is given in that frame: ``LookAt("camera", (0, 0, 0), reference="gripper")`` keeps
    the gripper in view. The tolerance is an angle (rad): half the opening of the cone around the axis in which the
    point may be.

    Attributes:
        point: (3,), m, in the world or in the reference frame.
        axis: Viewing axis in the frame, by default z.

    Raises:
        InvalidTarget: If the point or the axis is not a finite vector (3,), or the tolerance is half a turn or more.
    """

    point: ArrayLike
    axis: Direction = "z"
    _origin: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        self._aim_with(self.axis)
        object.__setattr__(self, "_origin", as_point("point", self.point))

    def _aim(self, at: Placed) -> tuple[Array, Array]:
        away = self._origin - self._point(at)
        size = max(math.hypot(*away), NEAREST)
        d = away / size
        return d, (np.outer(d, d) - np.eye(3)) @ self._speeds(at) / size
