"""Legs moved by servos (6-RSS): a horn on a shaft, and a rod of fixed length between its tip and the platform joint.

The shaft of leg i stands in the base joint b_i along a unit axis a_i, and its horn of length h points along u_i at
angle 0, along u_i cos(q) + w_i sin(q) at angle q, with w_i = a_i x u_i. A rod of length l reaches a platform joint at
v_i from b_i if h^2 + |v_i|^2 - 2 h (u_i'v_i cos q + w_i'v_i sin q) = l^2: with r and phi the polar coordinates of v_i
in the plane of the horn,

    q = phi -+ arccos(c / r),   c = (|v_i|^2 + h^2 - l^2) / (2 h),

one angle for each branch. Where |c| > r the rod is too short or too long (Eisele 2019 for axes in the base plane).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, number
from pin_metaik.errors import InvalidGeometry
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.platform.actuation import Links

LEVEL = 1e-9  # sine of the angle below which two directions count as one
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Servos:
    """Servos with horns and rods, one a leg. Lengths in m, angles in rad.

    Their axes are anywhere: by ``directions``, in the plane of the base, or by ``axes`` and ``zeros``, as vectors in
    the base frame.

    Attributes:
        horn: From the shaft to the joint of the rod; one for all legs, or one each.
        rod: Between the joints of a rod, likewise.
        directions: Where horns point at angle 0, seen from above and counted from the x axis, one each: the axes lie in
            the plane of the base, and positive angles raise the horns.
        axes: Axes of the shafts, one vector each, of any length; a positive angle turns right-handed about it.
        zeros: Where horns point at angle 0, one vector each: of them counts what is square to the axis. None: level, so
            that positive angles raise the horns, which vertical axes do not have.
        branches: Which of its two angles each servo has, +1 or -1; one for all legs, or one each. On branch +1 a horn
            that turns to larger angles pushes its rod, on -1 it pulls.

    Raises:
        InvalidGeometry: A length that is not above zero, no axes or two kinds of them, an axis of no direction, a zero
            along its axis, another branch, or numbers for more or fewer legs than there are.
    """

    horn: float | tuple[float, ...]
    rod: float | tuple[float, ...]
    directions: tuple[float, ...] = ()
    axes: tuple[Vector, ...] | None = None
    zeros: tuple[Vector, ...] | None = None
    branches: int | tuple[int, ...] = 1

    upright = (0.0, 1.0, 0.0)  # square to the horn, the way it moves

    def __post_init__(self) -> None:
        for name in ("horn", "rod"):
            object.__setattr__(self, name, _lengths(f"the {name} of a servo", getattr(self, name)))
        object.__setattr__(self, "directions", tuple(_numbers("directions of servos", self.directions)))
        for name in ("axes", "zeros"):
            if (given := getattr(self, name)) is not None:
                vectors = array(f"{name} of servos", given, "legs", 3, error=InvalidGeometry)
                object.__setattr__(self, name, tuple(map(tuple, vectors.tolist())))
        if (self.axes is None) == (not self.directions):
            raise InvalidGeometry("servos have either directions or axes, one for each leg")
        if self.zeros is not None and self.axes is None:
            raise InvalidGeometry("zeros of servos go with axes; directions say where horns point at angle 0")
        branches = self.branches
        listed = (branches,) if isinstance(branches, (int, np.integer)) else tuple(branches)
        if not listed or any(isinstance(one, bool) or one not in (1, -1) for one in listed):
            raise InvalidGeometry(f"branches of servos are 1 or -1, got {branches!r}")
        kept = int(listed[0]) if isinstance(branches, (int, np.integer)) else tuple(int(one) for one in listed)
        object.__setattr__(self, "branches", kept)
        self.check(self.legs)

    @property
    def legs(self) -> int:
        """How many legs have an axis."""
        return len(self.directions or self.axes or ())

    def check(self, legs: int) -> None:
        """Raise InvalidGeometry unless there is an axis for each of so many legs, and numbers for all or each."""
        for name in ("horn", "rod", "zeros", "branches"):
            value = getattr(self, name)
            if isinstance(value, tuple) and len(value) != self.legs:
                raise InvalidGeometry(f"{name} of servos: {len(value)} for {self.legs} axes")
        if legs != self.legs:
            raise InvalidGeometry(f"servos have {self.legs} axes for {legs} legs: one each")
        _ = self.frames

    @cached_property
    def frames(self) -> Array:
        """Unit vectors u, w, a of each servo as rows, in the base frame (n, 3, 3)."""
        if self.axes is None:
            angles = np.array(self.directions)
            u = np.column_stack((np.cos(angles), np.sin(angles), np.zeros_like(angles)))
            w = np.tile([0.0, 0.0, 1.0], (len(angles), 1))
            return np.stack((u, w, np.cross(u, w)), axis=1)
        a = _units("axes", np.array(self.axes))
        if self.zeros is None:
            level = np.cross([0.0, 0.0, 1.0], a)
            for leg in np.flatnonzero(np.linalg.norm(level, axis=1) < LEVEL):
                raise InvalidGeometry(f"the axis of servo {leg + 1} is vertical: give zeros, where horns point at 0")
        else:
            given = _units("zeros", np.array(self.zeros))
            level = given - (given * a).sum(axis=1, keepdims=True) * a
            for leg in np.flatnonzero(np.linalg.norm(level, axis=1) < LEVEL):
                raise InvalidGeometry(f"zeros of servos: that of servo {leg + 1} points along its axis")
        u = level / np.linalg.norm(level, axis=1, keepdims=True)
        return np.stack((u, np.cross(a, u), a), axis=1)

    @cached_property
    def rows(self) -> Array:
        """Each servo as the compiled loops take it: u, w, a, horn, rod, branch (n, 12)."""
        parts = (self.frames.reshape(-1, 9), *(self.each(name) for name in ("horn", "rod", "branches")))
        return np.column_stack(parts)

    def span(self) -> tuple[float, float]:
        """Least and greatest distance between a shaft and a platform joint, m."""
        horn, rod = self.each("horn"), self.each("rod")
        return float(np.abs(rod - horn).min()), float((rod + horn).max())

    def links(self, b: Array, v: Array) -> Links:
        """The servos' angles on their branches, the tips of their horns and the rods."""
        horn, rod, branch = (self.each(name) for name in ("horn", "rod", "branches"))
        x, y, along = (np.einsum("nc,knc->kn", self.frames[:, row], v) for row in range(3))
        r = np.hypot(x, y)
        phi = np.arctan2(y, x)
        c = (r**2 + along**2 + horn**2 - rod**2) / (2.0 * horn)  # r cos(phi - q)
        missing = np.where(c > r, np.hypot(along, r - horn) - rod, np.where(c < -r, np.hypot(along, r + horn) - rod, 0))
        sine = np.sqrt(np.maximum((r - c) * (r + c), 0.0))  # r sin(phi - q), but for its sign
        q = phi - branch * np.arctan2(sine, c)
        closed = missing == 0.0
        q = np.where(closed, (q + np.pi) % (2.0 * np.pi) - np.pi, np.nan)
        cos, sin = (np.where(closed, value, 0.0) for value in (np.cos(q), np.sin(q)))
        nearest = np.where(missing < 0.0, -1.0, 1.0)  # towards the joint, or away from it
        cos, sin = np.where(closed, cos, nearest * np.cos(phi)), np.where(closed, sin, nearest * np.sin(phi))
        tips = horn[:, None] * (cos[..., None] * self.frames[:, 0] + sin[..., None] * self.frames[:, 1])
        pushes = np.where(closed, branch * horn * sine / rod, np.nan)
        return Links(q, b + tips, v - tips, pushes, missing)

    def held(self, b: Array, q: Array) -> tuple[Array, Array]:
        """From the tips of the horns, as long as the rods."""
        horn = self.each("horn")[:, None]
        tips = horn * (np.cos(q)[..., None] * self.frames[:, 0] + np.sin(q)[..., None] * self.frames[:, 1])
        return b + tips, np.broadcast_to(self.each("rod"), q.shape)

    def in_first_joint(self, links: Links) -> Array:
        """Rods along the horn, the way it moves, and along the axis."""
        u, w, a = (self.frames[:, row] for row in range(3))
        cos, sin = np.cos(links.coordinates)[..., None], np.sin(links.coordinates)[..., None]
        rods = links.vectors / np.linalg.norm(links.vectors, axis=-1, keepdims=True)
        horns = np.stack((cos * u + sin * w, cos * w - sin * u, np.broadcast_to(a, rods.shape)), axis=-2)
        directions: Array = np.einsum("knrc,knc->knr", horns, rods)
        return directions

    def turned(self, angles: Array) -> Servos:
        """These servos, each turned about the vertical by an angle in rad (n,), as if its joint went round a circle."""
        if self.axes is None:
            return replace(self, directions=tuple((np.array(self.directions) + angles).tolist()))
        cos, sin = np.cos(angles), np.sin(angles)
        turned: dict[str, Any] = {}
        for name in ("axes", "zeros"):
            if getattr(self, name) is not None:
                x, y, z = np.array(getattr(self, name)).T
                ways = np.column_stack((cos * x - sin * y, sin * x + cos * y, z))
                turned[name] = tuple(map(tuple, ways.tolist()))
        return replace(self, **turned)

    def each(self, name: str) -> Array:
        """The horn, the rod or the branch of each leg (n,)."""
        return np.broadcast_to(np.asarray(getattr(self, name), dtype=float), self.legs)


def _numbers(name: str, values: Any) -> list[float]:
    if isinstance(values, str) or not np.iterable(values):
        raise InvalidGeometry(f"{name} are a list of numbers, got {values!r}")
    return [float(number(name, value, InvalidGeometry)) for value in values]


def _lengths(name: str, value: Any) -> float | tuple[float, ...]:
    each = not isinstance(value, str) and np.iterable(value)
    numbers = _numbers(name, value if each else [value])
    for one in numbers:
        if not one > 0.0:
            raise InvalidGeometry(f"{name} is longer than zero, got {one:g} m")
    return tuple(numbers) if each else numbers[0]


def _units(name: str, vectors: ArrayLike) -> Array:
    given = np.asarray(vectors, dtype=float)
    sizes = np.linalg.norm(given, axis=1, keepdims=True)
    for leg in np.flatnonzero(~(sizes[:, 0] > 0.0)):
        raise InvalidGeometry(f"{name} of servos: that of servo {leg + 1} has no direction")
    return np.asarray(given / sizes)
