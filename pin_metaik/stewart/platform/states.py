"""States of a pose: reached, or forbidden by a limit."""

from __future__ import annotations

from enum import IntEnum


class PoseState(IntEnum):
    """State of a pose: reached, or the first limit that forbids it.

    Limits are checked in this order, but the angle of a servo right after its rod's reach, without which it has none.
    """

    UNSEEN = 0
    """Not looked at: the survey was interrupted."""
    POSITIVE = 1
    """Reached, det J > 0; with fewer than six legs, just reached."""
    NEGATIVE = 2
    """Reached, det J < 0. Between poses of either sign lies a singularity; which sign it is means nothing."""
    SINGULAR = 3
    """Reached, but det J = 0: the legs do not hold the platform."""
    TOO_SHORT = 4
    TOO_LONG = 5
    BASE_ANGLE = 6
    PLATFORM_ANGLE = 7
    TOO_CLOSE = 8
    SERVO_ANGLE = 9

    @property
    def reached(self) -> bool:
        """Whether the limits allow the pose."""
        return PoseState.POSITIVE <= self <= PoseState.SINGULAR

    @property
    def words(self) -> str:
        """In words, after "a pose that is"."""
        return _WORDS[self]


_WORDS = {
    PoseState.UNSEEN: "not looked at",
    PoseState.POSITIVE: "reached with det J > 0",
    PoseState.NEGATIVE: "reached with det J < 0",
    PoseState.SINGULAR: "singular",
    PoseState.TOO_SHORT: "too near for a leg",
    PoseState.TOO_LONG: "too far for a leg",
    PoseState.BASE_ANGLE: "beyond the angle of a base joint",
    PoseState.PLATFORM_ANGLE: "beyond the angle of a platform joint",
    PoseState.TOO_CLOSE: "where two legs come too close",
    PoseState.SERVO_ANGLE: "beyond the angle of a servo",
}
