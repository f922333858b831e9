"""Ranges of a design: every length and angle is fixed, or free within a range."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, fields
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBounds
from pin_metaik.optimize.space import Box
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits
from pin_metaik.stewart.workspace.grid import as_range
from pin_metaik.toml import Span

SIDES = ("base", "platform")
LEG_DIMENSIONS = {"shortest", "longest", "horn", "rod", "directions"}
ANGLES_EACH = ("base_angles", "platform_angles", "directions")


@dataclass(frozen=True)
class Ranges:
    """Ranges of the free dimensions of a platform, in m and rad; None: fixed at the mechanism's value.

    Attributes:
        base_radius: rb.
        platform_radius: rm.
        base_angles: One for each base joint. When a joint moves on the circle, its servos turn with it.
        platform_angles: One for each platform joint.
        shortest: Length of a retracted leg.
        longest: Length of an extended leg.
        base: x, y and z of each base joint as a point, which need then not be on a circle.
        platform: x, y and z of each platform joint, likewise, in the platform's frame.
        horn: With servos: the length of all horns.
        rod: With servos: the length of all rods.
        directions: With servos: direction of each horn at angle 0, with its base joint as in the mechanism.

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
    horn: Span | None = None
    rod: Span | None = None
    directions: tuple[Span, ...] | None = None

    def __post_init__(self) -> None:
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            if value is None:
                continue
            if name in ANGLES_EACH:
                if not isinstance(value, (tuple, list)):
                    each = _owners(name)[:-1]
                    raise InvalidBounds(f"the range of {name} is one value or range for each {each}, got {value!r}")
                spans: object = tuple(_span(name, span) for span in value)
            elif name in SIDES:
                spans = _points(name, value)
            else:
                spans = _span(name, value)
                if not np.min(spans) > 0.0:
                    raise InvalidBounds(f"{name} is above zero, its range begins at {np.min(spans):g} m")
            object.__setattr__(self, name, spans)


def _nothing() -> Array:
    return np.empty(0)


def _nowhere() -> Array:
    return np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Dimensions:
    """The numbers a platform is made of, not yet known to make sense; what it does not have is left empty.

    Of each side there is a circle, or joints (k, 3); of the legs there are lengths or servos, of these a horn and a rod
    for all (1,) or for each (n,), and directions unless their axes are vectors.
    """

    base_radius: float = 0.0
    platform_radius: float = 0.0
    base_angles: Array = field(default_factory=_nothing)
    platform_angles: Array = field(default_factory=_nothing)
    base: Array = field(default_factory=_nowhere)
    platform: Array = field(default_factory=_nowhere)
    shortest: float = 0.0
    longest: float = 0.0
    horn: Array = field(default_factory=_nothing)
    rod: Array = field(default_factory=_nothing)
    directions: Array = field(default_factory=_nothing)


@dataclass(frozen=True, eq=False)
class Variables:
    """Between a point x (v,) of the search and the dimensions of a platform.

    Attributes:
        lower: Lower bounds of all dimensions, one after the other; where fixed, their value.
        upper: Upper bounds, likewise.
        shapes: The dimensions there are, in that order, and the shape of each; () for a single number.
    """

    lower: Array
    upper: Array
    shapes: dict[str, tuple[int, ...]]

    @classmethod
    def of(cls, ranges: Ranges, geometry: Geometry, limits: Limits) -> Variables:
        """The variables of these ranges; dimensions left out keep their values.

        Raises:
            InvalidBounds: Angles or points for more or fewer joints than there are, both for one side, dimensions that
                such legs do not have, or nothing is free.
        """
        anywhere = [side for side in SIDES if getattr(ranges, side) is not None or getattr(geometry, side) is not None]
        own = _dimensions(geometry, limits, anywhere)
        for name in sorted(LEG_DIMENSIONS - own.keys()):
            if getattr(ranges, name) is not None:
                legs = ", ".join(sorted(LEG_DIMENSIONS & own.keys()))
                raise InvalidBounds(f"these legs have no {name} to give a range; they have {legs}")
        for side in anywhere:
            for name in (f"{side}_radius", f"{side}_angles"):
                if getattr(ranges, name) is not None:
                    raise InvalidBounds(
                        f"the joints of the {side} are points: give {side} ranges of x, y, z, not {name}"
                    )
        ends, shapes = [], {}
        for name, value in own.items():
            given = getattr(ranges, name)
            if given is None:
                spans: list[Span] = np.ravel(value).tolist()
            elif name in ("horn", "rod"):  # one for all legs
                spans, value = [given], np.empty(1)
            elif not np.ndim(value):
                spans = [given]
            else:
                if len(given) != len(value):
                    raise InvalidBounds(f"{name} has {len(given)} ranges for {len(value)} {_owners(name)}")
                spans = [span for joint in given for span in joint] if name in SIDES else list(given)
            ends += [span if isinstance(span, tuple) else (span, span) for span in spans]
            shapes[name] = np.shape(value)
        lower, upper = np.array(ends, dtype=float).T.copy()
        if not (lower < upper).any():
            raise InvalidBounds("every dimension is fixed: give at least one a range [lower, upper]")
        return cls(lower, upper, shapes)

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
        """The most that a leg can become longer within the ranges, m: for servos, between shaft and platform joint."""
        lower, upper = self._split(self.lower), self._split(self.upper)
        if "horn" in upper:
            return 2.0 * float(min(upper["horn"].max(), upper["rod"].max()))
        return float(upper["longest"] - lower["shortest"])

    def dimensions(self, x: Array) -> Dimensions:
        """The dimensions at a point x (v,)."""
        p = self.lower.copy()
        p[self.free] = x
        parts: dict[str, Any] = {name: part if part.ndim else float(part) for name, part in self._split(p).items()}
        return Dimensions(**parts)

    def point(self, geometry: Geometry, limits: Limits) -> Array:
        """The point x (v,) of a platform, wherever its fixed dimensions are."""
        own = _dimensions(geometry, limits, [side for side in SIDES if side in self.shapes])
        values = (
            own[name] if np.size(own[name]) == np.prod(shape) else np.mean(own[name])
            for name, shape in self.shapes.items()
        )
        return np.asarray(np.hstack([np.ravel(value) for value in values])[self.free])

    def _split(self, p: Array) -> dict[str, Array]:
        """All dimensions p, one after the other, by their names."""
        sizes = [int(np.prod(shape)) for shape in self.shapes.values()]
        parts = np.split(p, np.cumsum(sizes)[:-1])
        return {name: part.reshape(shape) for (name, shape), part in zip(self.shapes.items(), parts, strict=True)}


def _dimensions(geometry: Geometry, limits: Limits, anywhere: Collection[str]) -> dict[str, Any]:
    """The dimensions that a platform has, by name: of joints anywhere no radius and no angles."""
    own: dict[str, Any] = {
        f"{side}_radius": getattr(geometry, f"{side}_radius") for side in SIDES if side not in anywhere
    }
    own |= {f"{side}_angles": np.array(getattr(geometry, f"{side}_angles")) for side in SIDES if side not in anywhere}
    joints = {"base": geometry.base_joints, "platform": geometry.platform_joints + geometry.reference}
    own |= {side: joints[side] for side in SIDES if side in anywhere}
    if geometry.servos is None:
        return own | dict(zip(("shortest", "longest"), limits.span, strict=True))
    own |= {name: np.atleast_1d(getattr(geometry.servos, name)) for name in ("horn", "rod")}
    return own | ({"directions": np.array(geometry.servos.directions)} if geometry.servos.directions else {})


def _owners(name: str) -> str:
    return "servos" if name == "directions" else "joints"


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
