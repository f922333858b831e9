"""What the legs allow: their lengths, the angles of their joints, and the distance they keep from each other."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from math import cos, pi

import numpy as np

from pin_metaik.arguments import array, checked, number
from pin_metaik.errors import InvalidGeometry
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.platform.geometry import Geometry


class PoseState(IntEnum):
    """What a pose is to a platform: reached, or the first limit that forbids it, in the order they are looked at."""

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
}


ROUNDING = 1e-12  # of a length: what decimals of a file leave


@dataclass(frozen=True)
class LegLimits:
    """Limits of every leg of a platform. Lengths in m, angles in rad.

    Attributes:
        shortest: Length of a leg that is retracted.
        longest: Length of a leg that is extended.
        base_angle: Largest angle between a leg and the axis of its base joint, 0 to pi; pi is no limit.
        platform_angle: The same at its platform joint.
        distance: Least distance between the axes of two legs (their diameter and what clearance they need). Legs that
            share a joint are not compared.
        home: Position of P, with the platform level, at which the axes of all joints point along their legs. Without
            it they stand square on their plates, towards the other plate.
        dead_length: What a leg is longer than its stroke when it is retracted (its ends, nut and motor), so that
            ``longest <= 2 shortest - dead_length``. None: it is not looked at, as for legs of several stages.
        speed: How fast a leg can change its length, m/s; None: that is not looked at.

    Raises:
        InvalidGeometry: A shortest length that is not above zero or above the longest, or a limit out of its range.
    """

    shortest: float
    longest: float
    base_angle: float = pi
    platform_angle: float = pi
    distance: float = 0.0
    home: tuple[float, float, float] | None = None
    dead_length: float | None = None
    speed: float | None = None

    def __post_init__(self) -> None:
        for name in ("shortest", "longest", "base_angle", "platform_angle", "distance"):
            object.__setattr__(self, name, float(number(f"{name} of the legs", getattr(self, name), InvalidGeometry)))
        if not self.shortest > 0.0:
            raise InvalidGeometry(f"the shortest leg is longer than zero, got {self.shortest:g} m")
        if self.shortest > self.longest:
            raise InvalidGeometry(
                f"the shortest leg, {self.shortest:g} m, is longer than the longest, {self.longest:g} m"
            )
        for name in ("base_angle", "platform_angle"):
            if not 0.0 < getattr(self, name) <= pi:
                raise InvalidGeometry(f"{name} lies above 0 and up to pi rad, got {getattr(self, name):g}")
        if self.distance < 0.0:
            raise InvalidGeometry(f"the distance between legs is not below zero, got {self.distance:g} m")
        for name, least in (("dead_length", "not below"), ("speed", "above")):
            if (value := getattr(self, name)) is None:
                continue
            object.__setattr__(self, name, float(number(f"{name} of the legs", value, InvalidGeometry)))
            if value < 0.0 or (least == "above" and value == 0.0):
                raise InvalidGeometry(f"{name} of the legs is {least} zero, got {value:g}")
        if self.too_long > 0.0:
            raise InvalidGeometry(
                f"the longest leg, {self.longest:g} m, is more than twice the shortest, {self.shortest:g} m, less the "
                f"dead length, {self.dead_length:g} m: it can be {self.longest - self.too_long:g} m"
            )
        if self.home is not None:
            home = array("home is the position x, y, z of P", self.home, 3, error=InvalidGeometry)
            object.__setattr__(self, "home", tuple(home.tolist()))

    @property
    def stroke(self) -> float:
        """How far a leg extends, m."""
        return self.longest - self.shortest

    @property
    def too_long(self) -> float:
        """How much longer the longest leg is than a retracted one with its dead length could become, m; 0 if not."""
        return 0.0 if self.dead_length is None else excess(self.shortest, self.longest, self.dead_length)

    @property
    def beyond_lengths(self) -> bool:
        """Whether anything but the lengths of the legs is limited."""
        return min(self.base_angle, self.platform_angle) < pi or self.distance > 0.0

    @property
    def array(self) -> Array:
        """The limits (5,) as the compiled loops take them."""
        angles = [cos(angle) if angle < pi else -1.0 for angle in (self.base_angle, self.platform_angle)]
        return np.array([self.shortest, self.longest, *angles, self.distance])

    @checked
    def sockets(self, geometry: Geometry) -> Array:
        """Unit axes (2, n, 3) of the base joints (base frame) and of the platform joints (platform frame).

        Raises:
            InvalidGeometry: A leg has no length at ``home``.
        """
        if self.home is None:
            return np.array([[[0.0, 0.0, 1.0]], [[0.0, 0.0, -1.0]]]) * np.ones((2, geometry.n, 1))
        v = np.array(self.home) + geometry.m - geometry.b
        d = np.linalg.norm(v, axis=1, keepdims=True)
        for leg in np.flatnonzero(d[:, 0] == 0.0):
            raise InvalidGeometry(f"leg {leg + 1} has no length at home, so no direction for its joints' axes")
        return np.array([v / d, -v / d])


def excess(shortest: float, longest: float, dead_length: float) -> float:
    """How much longer a leg is, at its longest, than its body allows, m; 0 but for rounding if it is not."""
    over = longest - (2.0 * shortest - dead_length)
    return over if over > ROUNDING * longest else 0.0
