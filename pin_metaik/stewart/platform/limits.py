"""Limits of the legs: their travel, the angles of their joints, and their distance from each other."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TypeAlias

import numpy as np

from pin_metaik.arguments import array, checked, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.stewart.platform.geometry import Geometry

ROUNDING = 1e-12  # of a length: what decimals of a file leave


class JointLimits:
    """What legs of every kind are limited by: angles of their joints, and the distance between them."""

    base_angle: float
    platform_angle: float
    distance: float
    home: tuple[float, float, float] | None
    speed: float | None

    @property
    def span(self) -> tuple[float, float]:
        """The least and the greatest coordinate of a leg: lengths in m, or angles in rad."""
        raise NotImplementedError

    @property
    def beyond_lengths(self) -> bool:
        """Whether anything but the lengths of the legs is limited."""
        return min(self.base_angle, self.platform_angle) < pi or self.distance > 0.0

    @checked
    def joint_axes(self, geometry: Geometry) -> Array:
        """Unit axes (2, n, 3) of the joints that begin links and of the platform joints (platform frame).

        The first are in the base frame; those at the tip of a horn along the horn, the way it moves, and its axis.

        Raises:
            InvalidGeometry: Limits of another kind of legs; a leg has no length at ``home``, or does not reach it.
        """
        fit(self, geometry)
        if self.home is None:
            shape = (geometry.n, 3)
            return np.array([np.broadcast_to(axes, shape) for axes in (geometry.actuation.upright, (0.0, 0.0, -1.0))])
        v = np.array(self.home) + geometry.m - geometry.b
        links = geometry.actuation.links(geometry.b, v[None])
        if links.why:
            raise InvalidGeometry(f"at home {links.why}")
        d = np.linalg.norm(links.vectors[0], axis=1, keepdims=True)
        for leg in np.flatnonzero(d[:, 0] == 0.0):
            raise InvalidGeometry(f"leg {leg + 1} has no length at home, so no direction for its joints' axes")
        return np.array([geometry.actuation.in_first_joint(links)[0], -links.vectors[0] / d])

    def _read(self, *own: str) -> None:
        """Make numbers of the fields, and sure that they are in their ranges."""
        for name in (*own, "base_angle", "platform_angle", "distance"):
            object.__setattr__(self, name, float(number(f"{name} of the legs", getattr(self, name), InvalidGeometry)))
        for name in ("base_angle", "platform_angle"):
            if not 0.0 < getattr(self, name) <= pi:
                raise InvalidGeometry(f"{name} lies above 0 and up to pi rad, got {getattr(self, name):g}")
        if self.distance < 0.0:
            raise InvalidGeometry(f"the distance between legs is not below zero, got {self.distance:g} m")
        if self.speed is not None:
            object.__setattr__(self, "speed", float(number("speed of the legs", self.speed, InvalidGeometry)))
            if not self.speed > 0.0:
                raise InvalidGeometry(f"speed of the legs is above zero, got {self.speed:g}")
        if self.home is not None:
            home = array("home is the position x, y, z of P", self.home, 3, error=InvalidGeometry)
            object.__setattr__(self, "home", tuple(home.tolist()))


@dataclass(frozen=True)
class LegLimits(JointLimits):
    """Limits of every leg of a platform. Lengths in m, angles in rad.

    Attributes:
        shortest: Length of a leg that is retracted.
        longest: Length of a leg that is extended.
        base_angle: Largest angle between a leg and the axis of its base joint, 0 to pi; pi is no limit.
        platform_angle: The same at its platform joint.
        distance: Least distance between the axes of two legs (their diameter plus clearance). Legs that share a joint
            are not compared.
        home: Position of P, with the platform level, at which the axes of all joints point along their legs. Without
            it the axes are normal to the base and to the platform, each towards the other.
        dead_length: Length of a retracted leg minus its stroke (its ends, nut and motor), so that ``longest <= 2
            shortest - dead_length``. None: not checked, as for legs of several stages.
        speed: Largest rate of a leg's length, m/s; None: not checked.

    Raises:
        InvalidGeometry: ``shortest`` is not above zero, or is above ``longest``; or a limit is out of its range.
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
        self._read("shortest", "longest")
        if not self.shortest > 0.0:
            raise InvalidGeometry(f"the shortest leg is longer than zero, got {self.shortest:g} m")
        if self.shortest > self.longest:
            raise InvalidGeometry(
                f"the shortest leg, {self.shortest:g} m, is longer than the longest, {self.longest:g} m"
            )
        if self.dead_length is not None:
            dead = float(number("dead_length of the legs", self.dead_length, InvalidGeometry))
            object.__setattr__(self, "dead_length", dead)
            if dead < 0.0:
                raise InvalidGeometry(f"dead_length of the legs is not below zero, got {dead:g}")
        if self.too_long > 0.0:
            raise InvalidGeometry(
                f"the longest leg, {self.longest:g} m, is more than twice the shortest, {self.shortest:g} m, less the "
                f"dead length, {self.dead_length:g} m: it can be {self.longest - self.too_long:g} m"
            )

    @property
    def span(self) -> tuple[float, float]:
        """The shortest and the longest leg, m."""
        return self.shortest, self.longest

    @property
    def stroke(self) -> float:
        """How far a leg extends, m."""
        return self.longest - self.shortest

    @property
    def too_long(self) -> float:
        """By how much, m, ``longest`` exceeds what ``shortest`` and ``dead_length`` allow; 0 if it does not."""
        return 0.0 if self.dead_length is None else excess(self.shortest, self.longest, self.dead_length)


@dataclass(frozen=True)
class ServoLimits(JointLimits):
    """Limits of every leg of a platform moved by servos. Lengths in m, angles in rad.

    Attributes:
        lowest: Least angle of a servo, not below -pi.
        highest: Greatest angle of a servo, up to pi.
        base_angle: Largest angle between a rod and the axis of its joint at the horn, 0 to pi; pi is no limit.
        platform_angle: The same at its platform joint.
        distance: Least distance between the axes of two rods; horns are not checked. Legs that share a joint are not
            compared.
        home: Position of P, with the platform level, at which the axes of all joints point along their rods. Without it
            the axis at a horn is normal to the horn, in its direction of motion (on branch -1 the opposite one), and
            the axes at the platform are normal to it. The joint at a horn turns with the horn.
        speed: Largest angular rate of a servo, rad/s; None: not checked.

    Raises:
        InvalidGeometry: Angles that are not numbers or in the wrong order, or a limit out of its range.
    """

    lowest: float
    highest: float
    base_angle: float = pi
    platform_angle: float = pi
    distance: float = 0.0
    home: tuple[float, float, float] | None = None
    speed: float | None = None

    def __post_init__(self) -> None:
        self._read("lowest", "highest")
        if not -pi * (1 + ROUNDING) <= self.lowest < self.highest <= pi * (1 + ROUNDING):
            raise InvalidGeometry(
                f"the angles of a servo lie between -pi and pi, the lowest first, got {self.lowest:g} and "
                f"{self.highest:g} rad"
            )

    @property
    def span(self) -> tuple[float, float]:
        """The lowest and the highest angle, rad."""
        return self.lowest, self.highest

    @property
    def beyond_lengths(self) -> bool:
        """True: whether a rod reaches does not follow from the distance between shaft and platform joint alone."""
        return True


Limits: TypeAlias = LegLimits | ServoLimits


def fit(limits: JointLimits, geometry: Geometry) -> None:
    """Raise InvalidGeometry unless these are limits of such legs."""
    kind, needed = ("linear actuators", LegLimits) if geometry.servos is None else ("servos", ServoLimits)
    if not isinstance(limits, needed):
        raise InvalidGeometry(f"legs that are {kind} have {needed.__name__}, got {type(limits).__name__}")


def lengths(limits: Limits, geometry: Geometry) -> tuple[float, float]:
    """The least and the greatest distance in m that a leg leaves between its base and its platform joint."""
    return geometry.actuation.span() or limits.span


def excess(shortest: float, longest: float, dead_length: float) -> float:
    """How much longer a leg is, at its longest, than its body allows, m; 0 but for rounding if it is not."""
    over = longest - (2.0 * shortest - dead_length)
    return over if over > ROUNDING * longest else 0.0
