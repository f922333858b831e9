"""Joint limits in the coordinates that a search moves in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked_as, number
from pin_metaik.errors import InvalidBounds
from pin_metaik.kinematics.kernel.layout import Bounds
from pin_metaik.optimize import Box

UNBOUNDED = 1e300
"""Pinocchio writes "no limit" as the largest float; anything beyond this is infinite."""


@checked_as(InvalidBounds)
@dataclass(frozen=True, eq=False)
class Limits:
    """Lower and upper limits of n joint coordinates.

    Attributes:
        lower: (n,) rad or m, ``-inf`` without a limit.
        upper: (n,) rad or m, ``inf`` without a limit.
        velocity: (n,) rad/s or m/s, ``inf`` without a limit.
        rotates: (n,) True for an angle, False for a travel.
        multi_turn: (n,) True for an angle whose range is a whole turn or more, so that it has copies of the same pose.
        names: The joint of each coordinate, for messages.
    """

    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    velocity: NDArray[np.float64]
    rotates: NDArray[np.bool_]
    multi_turn: NDArray[np.bool_]
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        """Refuse limits that no configuration can keep.

        Raises:
            InvalidBounds: If a limit is NaN or a lower limit is above its upper one; the joint is named.
        """
        for name in ("lower", "upper", "velocity", "rotates", "multi_turn"):
            if (given := getattr(self, name)).shape != (len(self.names),):
                raise InvalidBounds(
                    f"{name} has an entry for each of {len(self.names)} joints, got shape {given.shape}"
                )
        for name, lower, upper in zip(self.names, self.lower, self.upper, strict=True):
            if np.isnan(lower) or np.isnan(upper):
                raise InvalidBounds(f"joint {name!r} has limits [{lower}, {upper}]: NaN is not a limit")
            if lower > upper:
                raise InvalidBounds(f"joint {name!r} has its lower limit {lower} above its upper limit {upper}")

    @cached_property
    def _pairs(self) -> list[tuple[float, float]]:
        return list(zip(self.lower.tolist(), self.upper.tolist(), strict=True))

    @cached_property
    def arrays(self) -> Bounds:
        """Lower, upper and multi_turn as arguments of the compiled functions."""
        return Bounds(self.lower, self.upper, self.multi_turn.astype(np.int64))

    @cached_property
    def stuck(self) -> tuple[str, ...]:
        """Names of the joints whose limits are equal: they cannot move."""
        return tuple(name for name, (low, high) in zip(self.names, self._pairs, strict=True) if low == high)

    @property
    def rigid(self) -> bool:
        """Whether no joint can move."""
        return len(self.stuck) == len(self.names)

    @cached_property
    def periodic(self) -> NDArray[np.bool_]:
        """(n,) True for a continuous joint: an angle without limits."""
        return self.multi_turn & np.isinf(self.lower) & np.isinf(self.upper)

    def box(self) -> Box:
        """The finite box to sample in: the limits, or one turn of an angle without limits.

        Raises:
            InvalidBounds: If any other joint has no finite limits, as it then has no natural range to search.
        """
        lower, upper = self.lower.copy(), self.upper.copy()
        for i in np.flatnonzero(np.isinf(lower) | np.isinf(upper)):
            if not self.multi_turn[i]:
                raise InvalidBounds(
                    f"joint {self.names[i]!r} has limits [{lower[i]}, {upper[i]}]: a search needs finite ones; "
                    f"pass them with Chain(..., limits={{{self.names[i]!r}: (lower, upper)}})"
                )
            if np.isinf(lower[i]):
                lower[i] = -np.pi if np.isinf(upper[i]) else upper[i] - 2.0 * np.pi
            if np.isinf(upper[i]):
                upper[i] = lower[i] + 2.0 * np.pi
        return Box(lower, upper)

    def one_turn(self) -> Limits:
        """The same limits with every angle of more than one turn restricted to the turn in the middle of its range."""
        spare = np.maximum(0.5 * (self.upper - self.lower) - np.pi, 0.0)
        wide = self.multi_turn & np.isfinite(spare)
        lower, upper = self.lower.copy(), self.upper.copy()
        lower[wide] += spare[wide]
        upper[wide] -= spare[wide]
        return Limits(lower, upper, self.velocity, self.rotates, self.multi_turn, self.names)

    def clip(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """The nearest coordinates inside the limits; periodic ones are left as they are."""
        return np.minimum(np.maximum(self._given("x", x), self.lower), self.upper)

    def nearest_turns(self, x: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates x (..., n), each multi-turn angle moved by whole turns nearest to x0 inside its limits."""
        turn = 2.0 * np.pi
        x, x0 = self._given("x", x), array("x0", x0, len(self.names), finite=False)
        turns = np.round((x0 - x) / turn)
        turns = np.minimum(np.maximum(turns, np.ceil((self.lower - x) / turn)), np.floor((self.upper - x) / turn))
        return np.where(self.multi_turn, self.clip(x + turn * turns), x)

    def way(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
        """Joint steps b - a (..., n), rad or m; a continuous joint takes the shorter way round."""
        step = self._given("b", b) - self._given("a", a)
        around = step[..., self.periodic]
        step[..., self.periodic] = around - 2.0 * np.pi * np.round(around / (2.0 * np.pi))
        return step

    def separation(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distance (..., n) of each coordinate of a and b (..., n), rad or m, modulo whole turns."""
        step = self._given("b", b) - self._given("a", a)
        turns = 2.0 * np.pi * np.round(step / (2.0 * np.pi))
        return np.abs(np.where(self.multi_turn, step - turns, step))

    def contains(self, x: NDArray[np.float64], tolerance: float = 0.0) -> bool:
        """Whether every coordinate is inside its limits, up to ``tolerance`` (rad or m)."""
        # Plain floats: on a handful of numbers three times quicker than numpy's reductions.
        x = array("x", x, len(self.names), finite=False)
        if type(tolerance) is not float:
            tolerance = number("tolerance", tolerance)
        return all(
            low - tolerance <= v <= high + tolerance for (low, high), v in zip(self._pairs, x.tolist(), strict=True)
        )

    def _given(self, name: str, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (..., n) of the caller, checked."""
        return array(name, x, "...", len(self.names), finite=False)

    @checked_as(InvalidBounds)
    def replace(self, limits: dict[str, tuple[float, float]]) -> Limits:
        """The same limits with some joints' ranges replaced, e.g. ``{"joint_2": (-1.0, 1.0)}``.

        Raises:
            InvalidBounds: If a name is not a joint of this chain, or a range is crossed or NaN.
        """
        lower, upper = self.lower.copy(), self.upper.copy()
        for name, span in limits.items():
            if name not in self.names:
                raise InvalidBounds(
                    f"limits given for {name!r}, which this chain does not move: {', '.join(self.names)}"
                )
            i = self.names.index(name)
            lower[i], upper[i] = _pair(name, span)
        multi_turn = self.multi_turn & (upper - lower >= 2.0 * np.pi)
        return Limits(lower, upper, self.velocity, self.rotates, multi_turn, self.names)

    @checked_as(InvalidBounds)
    def bound(self, leader: str, line: tuple[float, float], follower: str, span: tuple[float, float]) -> Limits:
        """The same limits, narrowed so that a joint that follows at scale x + shift stays in a range of its own.

        Args:
            leader: The joint of these limits that is followed.
            line: Scale and shift (rad or m).
            follower: The joint that follows.
            span: Its range, rad or m.

        Raises:
            InvalidBounds: If the range is crossed or NaN, or leaves the leader no room.
        """
        if leader not in self.names:
            raise InvalidBounds(f"{leader!r} is not one of the joints of these limits: {', '.join(self.names)}")
        scale, shift = _pair(follower, line)
        low, high = _pair(follower, span)
        if not np.isfinite([scale, shift]).all():
            raise InvalidBounds(f"scale and shift of joint {follower!r} are finite, got {line!r}")
        if not low <= high:
            raise InvalidBounds(f"joint {follower!r} has its lower limit {low} above its upper limit {high}")
        i = self.names.index(leader)
        ends = sorted(((low - shift) / scale, (high - shift) / scale)) if scale else [-np.inf, np.inf]
        least, most = max(ends[0], self.lower[i]), min(ends[1], self.upper[i])
        if least > most or not (scale or low <= shift <= high):
            raise InvalidBounds(
                f"joint {follower!r} is at {scale:g} {leader!r} + {shift:g}: its limits [{low:g}, {high:g}] leave no "
                f"room to {leader!r}, whose own are [{self.lower[i]:g}, {self.upper[i]:g}]"
            )
        return self.replace({leader: (least, most)})


def finite_or_infinite(values: ArrayLike) -> NDArray[np.float64]:
    """Limits as Pinocchio stores them, with its "no limit" turned into an infinity."""
    array = np.array(values, dtype=float)
    array[array >= UNBOUNDED] = np.inf
    array[array <= -UNBOUNDED] = -np.inf
    return array


def _pair(name: str, span: Sequence[float]) -> tuple[float, float]:
    try:
        low, high = (float(v) for v in span)
    except (TypeError, ValueError):
        raise InvalidBounds(f"limits of joint {name!r} are (lower, upper), got {span!r}") from None
    return low, high
