"""The goal of a frame in a box."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import OfFrame
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.kinematics.pose import as_pose


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class InBox(OfFrame):
    """A frame's origin in a box: y = R'(p - t), for a box at the pose (R, t).

    Attributes:
        lower: Lower corner (3,) of the box in its own coordinates, m; ``-inf`` for no bound.
        upper: Upper corner (3,), likewise.
        pose: Pose of the box in the world, or in the reference frame: ``pin.SE3`` or (4, 4); ``None``: the identity.

    Raises:
        InvalidTarget: If the box is empty or has no bound, or the pose is not a finite rigid transform.
    """

    lower: ArrayLike
    upper: ArrayLike
    _: KW_ONLY
    pose: pin.SE3 | ArrayLike | None = None
    _into: pin.SE3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        lower, upper = (
            array(name, given, 3, error=InvalidTarget, finite=False).copy()
            for name, given in (("lower", self.lower), ("upper", self.upper))
        )
        if not (lower <= upper).all() or (lower == np.inf).any() or (upper == -np.inf).any():
            raise InvalidTarget(f"a box is from its lower to its upper corner, got {lower} to {upper}: it is empty")
        if not (np.isfinite(lower).any() or np.isfinite(upper).any()):
            raise InvalidTarget("this box has no bound: give at least one")
        into = pin.SE3.Identity() if self.pose is None else as_pose(self.pose).placement.inverse()
        for name, value in (("lower", lower), ("upper", upper), ("_into", into)):
            object.__setattr__(self, name, value)

    def _values(self, at: Placed) -> Array:
        inside: Array = self._into.act(self._point(at))
        return inside

    def _slopes(self, at: Placed) -> Array:
        return np.asarray(self._into.rotation @ self._speeds(at))

    def _bounds(self, at: Placed) -> tuple[Array, Array]:
        return np.asarray(self.lower), np.asarray(self.upper)
