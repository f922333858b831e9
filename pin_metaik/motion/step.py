"""The result of one tick of a follower."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.plain import fields_of


class FollowerStatus(StrEnum):
    """State of a follower after a tick."""

    ON_TARGET = "ON_TARGET"
    """The targets are met, within their tolerances."""
    UNDER_WAY = "UNDER_WAY"
    """It moves towards the targets as fast as its limits allow."""
    AT_LIMITS = "AT_LIMITS"
    """Joints are at limits that the motion would cross: here the branch ends; see ``Follower.switch``."""
    NO_DIRECTION = "NO_DIRECTION"
    """No joint motion leads towards the target: a singularity, or the boundary of the workspace."""
    NEAR_COLLISION = "NEAR_COLLISION"
    """It is slowed down or stopped because bodies come near each other."""


@dataclass(eq=False, slots=True)
class FollowerStep:
    """The outcome of one control tick.

    Attributes:
        q: (nq,) configuration at the end of the tick: the command for the joints.
        v: (n,) speeds of the chain's coordinates during the tick, rad/s or m/s.
        status: Whether the targets are met and, if not, why.
        position_error: Of the worst frame at q, m; NaN of a tick that moves to a configuration.
        orientation_error: Of the worst frame at q, rad; NaN of a tick that moves to a configuration.
        speed: Share of the desired change of speed that the world permitted, 0 to 1.
        at_limits: Names of the joints at a limit that the motion towards the target would cross.
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
        """Whether this branch of solutions ends here; another branch may lead on."""
        return self.status in (FollowerStatus.AT_LIMITS, FollowerStatus.NO_DIRECTION)
