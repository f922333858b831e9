"""What one tick of a follower comes to."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.plain import fields_of


class FollowerStatus(StrEnum):
    """Why a follower is where it is after a tick."""

    ON_TARGET = "ON_TARGET"
    """The targets are met, within their tolerances."""
    UNDER_WAY = "UNDER_WAY"
    """It moves as fast as its limits let it; nothing else is in the way."""
    AT_LIMITS = "AT_LIMITS"
    """Joints stand at their limits, and the way on leads beyond: here the branch ends; see ``Follower.switch``."""
    NO_DIRECTION = "NO_DIRECTION"
    """The joints cannot go where the target is, not even slowly: a singularity, or the edge of what the arm reaches."""
    NEAR_COLLISION = "NEAR_COLLISION"
    """It is slower than it would be, or stands, because bodies come near each other."""


@dataclass(eq=False, slots=True)
class FollowerStep:
    """The outcome of one control tick.

    Attributes:
        q: (nq,) where to be at its end.
        v: (n,) speeds of the chain's coordinates during the tick, rad/s or m/s.
        status: Why it is there.
        position_error: Of the worst frame at q, m; NaN of a tick that moves to a configuration.
        orientation_error: Of the worst frame at q, rad; NaN of a tick that moves to a configuration.
        speed: Which part of the change of speed that it wanted the world let it have, 0 to 1.
        at_limits: Names of the joints that stand at a limit which the way on leads beyond.
    """

    q: NDArray[np.float64]
    v: NDArray[np.float64]
    status: FollowerStatus
    position_error: float
    orientation_error: float
    speed: float = 1.0
    at_limits: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        """Whether it is on target."""
        return self.status is FollowerStatus.ON_TARGET

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad, None for NaN."""
        return fields_of(self, "q", "v", "status", "position_error", "orientation_error", "speed", "at_limits")

    @property
    def branch_ends(self) -> bool:
        """Whether this branch of solutions leads no farther: another one may."""
        return self.status in (FollowerStatus.AT_LIMITS, FollowerStatus.NO_DIRECTION)
