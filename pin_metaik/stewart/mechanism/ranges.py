"""What a design may change: every length and angle is fixed, or free within a range."""

from __future__ import annotations

from dataclasses import dataclass, fields
from numbers import Real
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import number
from pin_metaik.errors import InvalidBounds
from pin_metaik.optimize.space import Array, Box
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import LegLimits
from pin_metaik.stewart.workspace.grid import Range, as_range

SIDES = ("base", "platform")
Span: TypeAlias = float | Range
"""A value that is fixed, or the range of one that is free."""


@dataclass(frozen=True)
class Ranges:
    """The free and the fixed dimensions of a platform. Lengths in m, angles in rad; None: as the mechanism has it.

    Attributes:
        base_radius: rb.
        platform_radius: rm.
        base_angles: One for each base joint.
        platform_angles: One for each platform joint.
        shortest: Length of a retracted leg.
        longest: Length of an extended leg.
        base: x, y and z of each base joint, for joints anywhere; a circle is given up for them.
        platform: x, y and z of each platform joint, likewise, in the platform's frame.

    Raises:
        InvalidBounds: A range that is not two finite numbers, the lower first; a length that may not be above zero.
    """

    base_radius: Span | None = None
    platform_radius: Span | None = None
    base_angles: tuple[Span, ...] | None = None
    platform_angles: tuple[Span, ...] | None = None
    shortest: Span | None = None
    longest: Span | None = None
    base: tuple[tuple[Span, Span, Span], ...] | None = None
    platform: tuple[tuple[Span, Span, Span], ...] | None = None

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            value = getattr(self, name)
            if value is None:
                continue
            if name.endswith("angles"):
                if not isinstance(value, (tuple, list)):
                    raise InvalidBounds(f"the range of {name} is one value or range for each joint, got {value!r}")
                spans: object = tuple(_span(name, span) for span in value)
            elif name in SIDES:
                spans = _points(name, value)
            else:
                spans = _span(name, value)
                if not np.min(spans) > 0.0:
                    raise InvalidBounds(f"{name} is above zero, its range begins at {np.min(spans):g} m")
            object.__setattr__(self, name, spans)


@dataclass(frozen=True, eq=False)
class Dimensions:
    """The numbers a platform is made of, not yet known to make sense: of each side a circle, or joints (k, 3)."""

    base_radius: float
    platform_radius: float
    base_angles: Array
    platform_angles: Array
    base: Array
    platform: Array
    shortest: float
    longest: float


@dataclass(frozen=True, eq=False)
class Variables:
    """Between a point x (v,) of the search and the dimensions of a platform.

    Attributes:
        lower: Lower bounds of all dimensions, one after the other; where fixed, their value.
        upper: Upper bounds, likewise.
        counts: How many of them are base angles, platform angles, coordinates of base joints and of platform joints.
    """

    lower: Array
    upper: Array
    counts: tuple[int, int, int, int]

    @classmethod
    def of(cls, ranges: Ranges, geometry: Geometry, limits: LegLimits) -> Variables:
        """The variables of these ranges; what they leave out is fixed as it is.

        Raises:
            InvalidBounds: Angles or points for more or fewer joints than there are, both for one side, or nothing is
                free.
        """
        anywhere = [getattr(ranges, side) is not None or getattr(geometry, side) is not None for side in SIDES]
        own = _dimensions(geometry, limits, *anywhere)
        spans: list[Span] = []
        for name in (field.name for field in fields(own)):
            given, value = getattr(ranges, name), getattr(own, name)
            side = name.split("_")[0]
            if given is not None and side in SIDES and name != side and anywhere[SIDES.index(side)]:
                raise InvalidBounds(f"the joints of the {side} are anywhere: give {side} ranges of x, y, z, not {name}")
            if isinstance(value, np.ndarray):
                if given is not None and len(given) != len(value):
                    raise InvalidBounds(f"{name} has {len(given)} ranges for {len(value)} joints")
                listed = value.tolist() if given is None else given
                spans += [span for joint in listed for span in joint] if name in SIDES else listed
            else:
                spans.append(value if given is None else given)
        ends = np.array([span if isinstance(span, tuple) else (span, span) for span in spans])
        if not (ends[:, 0] < ends[:, 1]).any():
            raise InvalidBounds("every dimension is fixed: give at least one a range [lower, upper]")
        counts = (own.base_angles.size, own.platform_angles.size, own.base.size, own.platform.size)
        return cls(ends[:, 0], ends[:, 1], counts)

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which of all dimensions are free."""
        free: NDArray[np.bool_] = self.lower < self.upper
        return free

    @property
    def box(self) -> Box:
        """The box (v,) of the free ones."""
        return Box(self.lower[self.free], self.upper[self.free])

    @property
    def longest_stroke(self) -> float:
        """The most a leg can extend within the ranges, m."""
        return float(self.upper[-1] - self.lower[-2])

    def dimensions(self, x: Array) -> Dimensions:
        """The dimensions at a point x (v,)."""
        p = self.lower.copy()
        p[self.free] = x
        base_angles, platform_angles, base, platform = np.split(p[2:-2], np.cumsum(self.counts)[:-1])
        points = base.reshape(-1, 3), platform.reshape(-1, 3)
        return Dimensions(float(p[0]), float(p[1]), base_angles, platform_angles, *points, float(p[-2]), float(p[-1]))

    def point(self, geometry: Geometry, limits: LegLimits) -> Array:
        """The point x (v,) of a platform, wherever its fixed dimensions are."""
        own = _dimensions(geometry, limits, self.counts[2] > 0, self.counts[3] > 0)
        p = np.hstack([np.ravel(getattr(own, field.name)) for field in fields(own)])
        return np.asarray(p[self.free])


def _dimensions(geometry: Geometry, limits: LegLimits, base_anywhere: bool, platform_anywhere: bool) -> Dimensions:
    """The dimensions of a platform; of joints anywhere no radius and no angles."""
    none, nowhere = np.empty(0), np.empty((0, 3))
    return Dimensions(
        0.0 if base_anywhere else geometry.base_radius,
        0.0 if platform_anywhere else geometry.platform_radius,
        none if base_anywhere else np.array(geometry.base_angles),
        none if platform_anywhere else np.array(geometry.platform_angles),
        geometry.base_joints if base_anywhere else nowhere,
        geometry.platform_joints + geometry.reference if platform_anywhere else nowhere,
        limits.shortest,
        limits.longest,
    )


def _points(name: str, value: object) -> tuple[tuple[Span, Span, Span], ...]:
    try:
        joints = [tuple(joint) for joint in value]  # type: ignore[attr-defined]  # what is no list is told
    except TypeError:
        joints = [()]
    if not all(len(joint) == 3 for joint in joints):
        raise InvalidBounds(f"the ranges of {name} are x, y, z of each joint, each a value or a range, got {value!r}")
    return tuple((_span(name, x), _span(name, y), _span(name, z)) for x, y, z in joints)


def _span(name: str, value: object) -> Span:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(number(name, value, InvalidBounds))
    return as_range(name, value)
