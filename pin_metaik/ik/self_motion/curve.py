"""One self-motion of a redundant chain: a curve of solutions, from end to end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidConfiguration, InvalidSetting
from pin_metaik.ik.criteria import Selection, Weighted, measure_of, weights_of
from pin_metaik.ik.problem import IKProblem, check_world
from pin_metaik.optimize.settings import positive

Values: TypeAlias = Callable[[Array], Array]  # of coordinates (k, n)

GOLDEN = 0.5 * (5.0**0.5 - 1.0)
NEAR, SHARP = 1e-4, 1e-7  # how far off a least value may be before it is sharpened; then its interval, rad or m
CUT = 1e-10  # rad or m of t: width of a place where an angle jumps by a whole turn
LOOKED = 20_000  # points of a curve after which no more are looked at for the best of the whole of it
BISECTIONS = 20  # of the place where a curve runs into an obstacle


class EndReason(StrEnum):
    """Why a self-motion goes no farther."""

    LIMIT = "LIMIT"
    """A joint is at a limit."""
    CLOSED = "CLOSED"
    """It has come back to where it began."""
    SINGULARITY = "SINGULARITY"
    """The Jacobian loses rank: curves meet, or a curve turns back in a point."""


class CurveEnd(NamedTuple):
    """One end of a self-motion.

    Attributes:
        reason: Why it ends.
        joint: The joint at its limit; None if there is none.
        upper: Whether that is its upper limit.
    """

    reason: EndReason
    joint: str | None = None
    upper: bool = False

    def __str__(self) -> str:
        return self.reason if self.joint is None else f"{self.joint} at its {'upper' if self.upper else 'lower'} limit"


class CurvePoint(NamedTuple):
    """A place on a self-motion, and what a criterion says of it.

    Attributes:
        t: Where on the curve, rad or m of joint motion from its beginning.
        q: (nq,) the configuration.
        value: Of the criterion; lower is better.
    """

    t: float
    q: Array
    value: float


@dataclass(frozen=True, eq=False)
class SelfMotionCurve:
    """A curve of solutions of one target, for a chain with one spare degree of freedom.

    A connected component of the self-motion manifold (Burdick 1989) inside the limits. Coordinates whose range is a
    whole turn or more are treated as angles on a circle: their limits do not end a curve, and they are given as the
    copy nearest to ``q0``.

    Attributes:
        problem: The problem with the target, which is met exactly.
        base: (nq,) configuration ``q0``: values of the joints that do not move, and where copies by whole turns are
            nearest to.
        x: (k, n) coordinates of points on the curve, in order; angles without jumps.
        t: (k,) length of the curve up to each point: sum of the distances between points, rad and m weighted alike.
        ends: Why the curve ends at its beginning and at its end.
    """

    problem: IKProblem = field(repr=False)
    base: Array = field(repr=False)
    x: Array = field(repr=False)
    t: Array = field(repr=False)
    ends: tuple[CurveEnd, CurveEnd]
    _tangents: Array = field(repr=False)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: configurations of the points, lengths in m, angles in rad."""
        ends = [{"reason": end.reason.value, "joint": end.joint, "upper": end.upper} for end in self.ends]
        return {"q": self.q(self.t).tolist(), "t": self.t.tolist(), "ends": ends}

    @property
    def closed(self) -> bool:
        """Whether the curve is closed: it comes back to its first point."""
        return self.ends[0].reason is EndReason.CLOSED

    @property
    def length(self) -> float:
        """Length of the curve in joint space, rad and m weighted alike."""
        return float(self.t[-1])

    def q(self, t: ArrayLike) -> Array:
        """Configurations (..., nq) at t (...), from 0 to ``length``; on a closed curve t is taken modulo ``length``.

        Raises:
            InvalidSetting: If t is not finite.
        """
        places = array("t", t, "...", error=InvalidSetting)
        X = self._turned(self._at(np.atleast_1d(places).ravel()))
        return self.problem.chain.q(X, self.base).reshape(*places.shape, self.problem.chain.model.nq)

    def sample(self, step: float) -> Array:
        """Configurations (k, nq), at most ``step`` (rad and m alike) of joint motion from one to the next.

        Raises:
            InvalidSetting: If the step is not above zero.
        """
        positive("step", step)
        return self.q(np.linspace(0.0, self.length, 1 + int(np.ceil(self.length / step))))

    @checked
    def nearest(self, q: ArrayLike, weights: Mapping[str, float] | None = None) -> CurvePoint:
        """The point nearest to a configuration (nq,), rad and m weighted alike; angles the shorter way round.

        It is the nearest of the whole curve to within 1e-4, because a distance changes by no more than the joints move,
        but for places where an angle comes to another copy by whole turns: there the curve is cut. With weights so
        large that this takes more than 20,000 points, it is the nearest of these.

        Args:
            q: The configuration.
            weights: Weights of coordinates by name, default 1; see ``Weighted``.

        Raises:
            InvalidConfiguration: If ``q`` is not one.
            UnknownName: If the chain has no joint of such a name.
            InvalidSetting: If a weight is below 0.
        """
        point = self._least(*self._distance(q, weights))
        assert point is not None
        return point

    @checked
    def best(self, criterion: Selection) -> CurvePoint:
        """The point where a criterion is least.

        Args:
            criterion: As for ``IKSolver.select``: a name, ``Weighted``, or a function of a configuration (nq,). For
                ``"nearest"`` (to ``q0``) and ``"limits"`` the result is the best of the whole curve to within 1e-4, or,
                where a joint's range is so short that this takes more than 20,000 points, the best of these. Any other
                criterion is evaluated at every point of ``x``, and minimised around each point that is better than its
                two neighbours.

        Raises:
            UnknownName: No criterion of that name.
            InvalidSetting: The function fails for a configuration, or does not return a number.
        """
        point = self._least(*self._criterion(criterion))
        assert point is not None
        return point

    @checked
    def free(self, world: CollisionWorld, step: float = 0.02) -> list[tuple[float, float]]:
        """Intervals (from, to) of t without a collision, sampled at points at most ``step`` (rad and m alike) apart.

        Raises:
            InvalidSetting: If the world is another model's, or the step is not above zero.
        """
        check_world(self.problem.chain, world)
        positive("step", step)
        count = 1 + max(1, int(np.ceil(self.length / step)))
        places = np.linspace(0.0, self.length, count)

        def clear(t: float) -> bool:
            return not world.checker.collides(self.q(t))

        def border(inside: float, outside: float) -> float:
            for _ in range(BISECTIONS):
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if clear(middle) else (inside, middle)
            return inside

        is_clear = [clear(t) for t in places]
        found: list[tuple[float, float]] = []
        begin = places[0] if is_clear[0] else None
        for i in range(1, count):
            if is_clear[i] and not is_clear[i - 1]:
                begin = border(places[i], places[i - 1])
            elif is_clear[i - 1] and not is_clear[i]:
                assert begin is not None
                found.append((float(begin), border(places[i - 1], places[i])))
        if is_clear[-1] and begin is not None:
            found.append((float(begin), self.length))
        return found

    def _turned(self, X: Array) -> Array:
        """Coordinates (k, n) inside the limits, angles on a circle as the copy nearest to ``q0``."""
        limits = self.problem.limits
        return np.where(limits.multi_turn, limits.nearest_turns(X, self._x0), limits.clip(X))

    def _distance(self, q: ArrayLike, weights: Mapping[str, float] | None) -> tuple[Values, float | None]:
        """The distances from a configuration (nq,), and their rate."""
        x = self.problem.chain.x(array("q", q, self.problem.chain.model.nq, error=InvalidConfiguration))
        near = Weighted("nearest", weights or {})
        measure = measure_of(near)
        return lambda X: measure(self.problem, self._turned(X), x), self._rate(near)

    def _criterion(self, criterion: Selection) -> tuple[Values, float | None]:
        """The values of a criterion, and their rate."""
        measure = measure_of(criterion)
        if not isinstance(criterion, (str, Weighted)):
            try:
                criterion(self.q(0.0))
            except TypeError as error:
                raise InvalidSetting(f"criterion is a function of a configuration q (nq,), but: {error}") from error
        return lambda X: measure(self.problem, self._turned(X), self._x0), self._rate(criterion)

    def _rate(self, criterion: Selection) -> float | None:
        """How much a criterion changes at most for each unit of joint motion; None: nothing is known."""
        limits = self.problem.limits
        if isinstance(criterion, Weighted):
            name, weights = criterion.criterion, weights_of(criterion, self.problem.chain.names)
        else:
            name, weights = criterion if isinstance(criterion, str) else "", np.ones(len(limits.lower))
        spans = np.where(limits.upper > limits.lower, limits.upper - limits.lower, np.inf)
        if not np.isfinite(spans).any():
            return None
        rates = {"nearest": weights, "limits": 2.0 * weights / spans}
        return (float(rates[name].max()) or None) if name in rates else None

    @cached_property
    def _x0(self) -> Array:
        return self.problem.chain.x(self.base)

    def _at(self, t: Array) -> Array:
        """Coordinates (k, n) at t (k,): between two points by Hermite's cubic, put back onto the curve."""
        from pin_metaik.kinematics.self_motion.trace import put_back

        t = t % self.length if self.closed else np.clip(t, 0.0, self.length)
        i = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 2)
        h = (self.t[i + 1] - self.t[i])[:, None]
        s = (t - self.t[i])[:, None] / h
        a, b, u, v = self.x[i], self.x[i + 1], h * self._tangents[i], h * self._tangents[i + 1]
        X = a + s * (u + s * (3.0 * (b - a) - 2.0 * u - v + s * (u + v - 2.0 * (b - a))))
        across = np.where(s < 0.5, self._tangents[i], self._tangents[i + 1])
        problem = self.problem
        put_back(problem.chain.bare, problem.records, problem.kernel_rows, X, across)
        return X

    @cached_property
    def _pieces(self) -> list[Array]:
        """Places t (k,), in order, on each piece of the curve where no angle jumps to another copy by whole turns."""
        limits = self.problem.limits
        if not (limits.multi_turn & ~limits.periodic).any():
            return [self.t]
        a, b = self._tangents[:-1], self._tangents[1:]
        turning = (a * b < 0.0) & limits.multi_turn  # where a coordinate turns back, it may look beyond a limit between
        row, c = np.nonzero(turning)
        vertices = self.t[row] + (self.t[row + 1] - self.t[row]) * a[row, c] / (a[row, c] - b[row, c])
        t = np.unique(np.append(self.t, vertices))
        before, behind = self._jumps(t)
        spans = zip(np.append(t[0], behind), np.append(before, t[-1]), strict=True)
        return [np.unique([a, *t[(t > a) & (t < b)], b]) for a, b in spans]

    def _jumps(self, t: Array) -> tuple[Array, Array]:
        """The places between points t (k,) where an angle jumps to another copy: just before each, and behind it."""
        turns = self._turns(t)
        i = np.flatnonzero((turns[:-1] != turns[1:]).any(axis=1))
        a, to, known, last = t[i], t[i + 1], turns[i], turns[i + 1]
        before, behind = np.empty(0), np.empty(0)
        while len(a):  # the first jump of each span, then what comes after it
            b, after = to, last
            while (b - a).max() > CUT:
                middle = 0.5 * (a + b)
                there = self._turns(middle)
                same = (there == known).all(axis=1)
                a, b = np.where(same, middle, a), np.where(same, b, middle)
                after = np.where(same[:, None], after, there)
            before, behind = np.append(before, a), np.append(behind, b)
            more = (after != last).any(axis=1)
            a, to, known, last = b[more], to[more], after[more], last[more]
        return np.sort(before), np.sort(behind)

    def _turns(self, t: Array) -> Array:
        """By how many whole turns each angle is given away from ``x`` at t (k,): (k, n)."""
        X = self._at(t)
        turns: Array = np.round((self._turned(X) - X) / (2.0 * np.pi))
        return turns

    def _least(self, values: Values, rate: float | None, below: float = np.inf) -> CurvePoint | None:
        """Where values are least; None where that is known not to be below a number.

        ``rate`` bounds how much values change for each unit of t; None: nothing does.
        """
        spans = self._lows(values) if rate is None else self._below(values, rate, below)
        if not spans:
            return None
        t, value = min((self._sharpened(values, *span) for span in spans), key=_value)
        return CurvePoint(t, self.q(t), value)

    def _lows(self, values: Values) -> list[tuple[float, float]]:
        """The spans round each point whose value is no greater than its neighbours'."""
        known = values(self.x)
        left, right = np.append(np.inf, known[:-1]), np.append(known[1:], np.inf)
        last = len(known) - 1
        lows = np.flatnonzero((known <= left) & (known <= right)).tolist()
        return [(float(self.t[max(i - 1, 0)]), float(self.t[min(i + 1, last)])) for i in lows]

    def _below(self, values: Values, rate: float, below: float) -> list[tuple[float, float]]:
        """A span round the least value: others cannot be less by more than NEAR (Piyavskii 1972).

        There is none where it is not below a number. Where the range of a joint is so short that others can hardly be
        ruled out, it is the least of those that were looked at.
        """
        pieces = self._pieces
        parts = [values(self.x) if piece is self.t else values(self._at(piece)) for piece in pieces]
        a, b = np.concatenate([t[:-1] for t in pieces]), np.concatenate([t[1:] for t in pieces])
        fa, fb = np.concatenate([f[:-1] for f in parts]), np.concatenate([f[1:] for f in parts])
        t, f = np.concatenate(pieces), np.concatenate(parts)
        best, at = float(f.min()), float(t[int(np.argmin(f))])
        if best >= below:
            best, at = below, np.nan
        looked = 0
        while looked < LOOKED:
            hopeful = 0.5 * (fa + fb - rate * (b - a)) < best - NEAR
            a, b, fa, fb = a[hopeful], b[hopeful], fa[hopeful], fb[hopeful]
            if not len(a):
                break
            middle, looked = 0.5 * (a + b), looked + len(a)
            f = values(self._at(middle))
            if f.min() < best:
                best, at = float(f.min()), float(middle[int(np.argmin(f))])
            a, b = np.append(a, middle), np.append(middle, b)
            fa, fb = np.append(fa, f), np.append(f, fb)
        if np.isnan(at):
            return []
        width = min(float(np.diff(self.t).max()), 2.0 * NEAR / rate + 1e-3)
        piece = next(t for t in pieces if t[0] <= at <= t[-1])
        return [(max(at - width, float(piece[0])), min(at + width, float(piece[-1])))]

    def _sharpened(self, values: Values, a: float, b: float) -> tuple[float, float]:
        """Where values are least between a and b, by golden sections, and how much they are there."""

        def value(t: float) -> float:
            return float(values(self._at(np.array([t])))[0])

        c, d = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
        fc, fd = value(c), value(d)
        while b - a > SHARP:
            if fc < fd:
                b, d, fd = d, c, fc
                c = b - GOLDEN * (b - a)
                fc = value(c)
            else:
                a, c, fc = c, d, fd
                d = a + GOLDEN * (b - a)
                fd = value(d)
        return min(((t, value(t)) for t in (a, b, c, d)), key=_value)


def _value(place: tuple[float, float]) -> float:
    return place[1]
