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
from pin_metaik.stewart.geometry import Geometry
from pin_metaik.stewart.grid import Range, as_range
from pin_metaik.stewart.limits import LegLimits

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

    Raises:
        InvalidBounds: A range that is not two finite numbers, the lower first; a length that may not be above zero.
    """

    base_radius: Span | None = None
    platform_radius: Span | None = None
    base_angles: tuple[Span, ...] | None = None
    platform_angles: tuple[Span, ...] | None = None
    shortest: Span | None = None
    longest: Span | None = None

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            value = getattr(self, name)
            if value is None:
                continue
            if name.endswith("angles"):
                if not isinstance(value, (tuple, list)):
                    raise InvalidBounds(f"the range of {name} is one value or range for each joint, got {value!r}")
                spans: object = tuple(_span(name, span) for span in value)
            else:
                spans = _span(name, value)
                if not np.min(spans) > 0.0:
                    raise InvalidBounds(f"{name} is above zero, its range begins at {np.min(spans):g} m")
            object.__setattr__(self, name, spans)


@dataclass(frozen=True, eq=False)
class Dimensions:
    """The numbers a platform is made of, not yet known to make sense."""

    base_radius: float
    platform_radius: float
    base_angles: Array
    platform_angles: Array
    shortest: float
    longest: float


@dataclass(frozen=True, eq=False)
class Variables:
    """Between a point x (v,) of the search and the dimensions of a platform.

    Attributes:
        lower: Lower bounds of all dimensions, one after the other; where fixed, their value.
        upper: Upper bounds, likewise.
        bases: How many of them are angles of base joints.
        platforms: How many are angles of platform joints.
    """

    lower: Array
    upper: Array
    bases: int
    platforms: int

    @classmethod
    def of(cls, ranges: Ranges, geometry: Geometry, limits: LegLimits) -> Variables:
        """The variables of these ranges; what they leave out is fixed as it is.

        Raises:
            InvalidBounds: Angles for more or fewer joints than there are, or nothing is free.
        """
        spans: list[Span] = []
        own = _dimensions(geometry, limits)
        for name in (field.name for field in fields(ranges)):
            given, value = getattr(ranges, name), getattr(own, name)
            if name.endswith("angles"):
                if given is not None and len(given) != len(value):
                    raise InvalidBounds(f"{name} has {len(given)} ranges for {len(value)} joints")
                spans += value.tolist() if given is None else given
            else:
                spans.append(value if given is None else given)
        ends = np.array([span if isinstance(span, tuple) else (span, span) for span in spans])
        if not (ends[:, 0] < ends[:, 1]).any():
            raise InvalidBounds("every dimension is fixed: give at least one a range [lower, upper]")
        return cls(ends[:, 0], ends[:, 1], len(own.base_angles), len(own.platform_angles))

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
        rest = p[2:]
        return Dimensions(
            float(p[0]),
            float(p[1]),
            rest[: self.bases],
            rest[self.bases : self.bases + self.platforms],
            float(p[-2]),
            float(p[-1]),
        )

    def point(self, geometry: Geometry, limits: LegLimits) -> Array:
        """The point x (v,) of a platform, wherever its fixed dimensions are."""
        own = _dimensions(geometry, limits)
        p = np.hstack([getattr(own, field.name) for field in fields(own)])
        return np.asarray(p[self.free])


def _dimensions(geometry: Geometry, limits: LegLimits) -> Dimensions:
    return Dimensions(
        geometry.base_radius,
        geometry.platform_radius,
        np.array(geometry.base_angles),
        np.array(geometry.platform_angles),
        limits.shortest,
        limits.longest,
    )


def _span(name: str, value: object) -> Span:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(number(name, value, InvalidBounds))
    return as_range(name, value)
