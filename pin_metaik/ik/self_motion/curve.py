"""One self-motion of a redundant chain: a curve of solutions, from end to end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.collision import CollisionWorld
from pin_metaik.errors import InvalidConfiguration, InvalidSetting, UnknownName
from pin_metaik.ik.criteria import CRITERIA
from pin_metaik.ik.problem import IKProblem, check_world
from pin_metaik.optimize.settings import positive

Criterion: TypeAlias = str | Callable[[Array], float]
Values: TypeAlias = Callable[[Array], Array]  # of coordinates (k, n)

GOLDEN = 0.5 * (5.0**0.5 - 1.0)
NEAR, SHARP = 1e-4, 1e-8  # how far a least value may be off before it is sharpened; width of its interval then, rad or m
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


@checked
@dataclass(frozen=True, eq=False)
class SelfMotionCurve:
    """All solutions that a chain with one spare degree of freedom reaches from one of them while its frame stands still.

    A connected component of the self-motion manifold (Burdick 1989) inside the limits. Coordinates whose limits leave
    room for a whole turn are taken as angles on a circle: they end no curve, and come as the copy nearest to ``q0``.

    Attributes:
        problem: The target, to be met exactly.
        base: (nq,) the joints that do not move, and what copies are nearest to.
        x: (k, n) coordinates of points on the curve, in order; angles on a circle without jumps.
        t: (k,) how far the joints have moved up to each: the sum of the distances between the points, rad and m alike.
        ends: Of the beginning and of the end.
    """

    problem: IKProblem = field(repr=False)
    base: Array = field(repr=False)
    x: Array = field(repr=False)
    t: Array = field(repr=False)
    ends: tuple[CurveEnd, CurveEnd]
    _tangents: Array = field(repr=False)

    @property
    def closed(self) -> bool:
        """Whether it comes back to where it began."""
        return self.ends[0].reason is EndReason.CLOSED

    @property
    def length(self) -> float:
        """How far the joints move from end to end, rad and m alike."""
        return float(self.t[-1])

    def q(self, t: ArrayLike) -> Array:
        """Configurations (..., nq) at t (...), from 0 to ``length``; round and round on a closed curve.

        Raises:
            InvalidSetting: If t is not finite.
        """
        places = array("t", t, "...", error=InvalidSetting)
        x = self._at(np.atleast_1d(places).ravel())
        return self._configurations(x).reshape(*places.shape, -1)

    def sample(self, step: float) -> Array:
        """Configurations (k, nq), at most ``step`` (rad and m alike) of joint motion from one to the next.

        Raises:
            InvalidSetting: If the step is not above zero.
        """
        positive("step", step)
        return self.q(np.linspace(0.0, self.length, 1 + int(np.ceil(self.length / step))))

    def nearest(self, q: ArrayLike) -> CurvePoint:
        """The point with the least distance from a configuration (nq,), rad and m alike; angles the shorter way round.

        It is the nearest of the whole curve, to 1e-4: a distance changes by no more than the joints move.
        """
        x = self.problem.chain.x(array("q", q, self.problem.chain.model.nq, error=InvalidConfiguration))
        winds = self.problem.limits.winds

        def distances(X: Array) -> Array:
            ways = X - x
            ways = np.where(winds, ways - 2.0 * np.pi * np.round(ways / (2.0 * np.pi)), ways)
            found: Array = np.linalg.norm(ways, axis=1)
            return found

        return self._least(distances, 1.0)

    def best(self, criterion: Criterion) -> CurvePoint:
        """The point where a criterion is least.

        Args:
            criterion: ``"nearest"`` to ``q0``, farthest from the ``"limits"``, of greatest ``"manipulability"``, of least
                gravity ``"torque"``; or a function of a configuration (nq,), to be least. Of the first two the least
                value of the whole curve is found; the others are looked at in every point ``x``, and sharpened at each
                that is lower than its neighbours.

        Raises:
            UnknownName: No criterion of that name.
        """
        if callable(criterion):
            return self._least(lambda X: np.array([float(criterion(q)) for q in self._configurations(X)]), None)
        if criterion == "nearest":
            return self.nearest(self.base)
        if criterion not in CRITERIA:
            raise UnknownName("criterion", criterion, {"nearest", *CRITERIA})
        known = CRITERIA[criterion]
        return self._least(lambda X: known.values(self.problem, X), known.rate(self.problem))

    def free(self, world: CollisionWorld, step: float = 0.02) -> list[tuple[float, float]]:
        """Intervals (from, to) of t without a collision, as far as points at most ``step`` apart show.

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

    def _configurations(self, X: Array) -> Array:
        """Configurations (k, nq) of coordinates (k, n), inside the limits."""
        chain = self.problem.chain
        near = chain.limits.nearest_turns(chain.limits.clip(X) if not chain.limits.winds.any() else X, self._x0)
        return chain.q(near, self.base)

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
        put_back(problem.chain.bare, problem.tasks, problem.descended, X, across)
        return X

    def _least(self, values: Values, rate: float | None) -> CurvePoint:
        """Where values are least; ``rate`` bounds how much they change for each unit of t, None: nothing does."""
        known = values(self.x)
        if rate is None:
            lower = np.pad(known, 1, mode="wrap" if self.closed else "constant", constant_values=np.inf) if False else known
            left, right = np.append(np.inf, lower[:-1]), np.append(lower[1:], np.inf)
            low = np.flatnonzero((known <= left) & (known <= right))
            spans = [(self.t[max(i - 1, 0)], self.t[min(i + 1, len(known) - 1)]) for i in low]
            found = [self._sharpened(values, *span) for span in spans]
        else:
            a, b, fa, fb = self.t[:-1], self.t[1:], known[:-1], known[1:]
            best = known.min()
            at = float(self.t[np.argmin(known)])
            while True:
                hopeful = 0.5 * (fa + fb - rate * (b - a)) < best - NEAR
                a, b, fa, fb = a[hopeful], b[hopeful], fa[hopeful], fb[hopeful]
                if not len(a):
                    break
                middle = 0.5 * (a + b)
                f = values(self._at(middle))
                if f.min() < best:
                    best, at = float(f.min()), float(middle[np.argmin(f)])
                a, b = np.append(a, middle), np.append(middle, b)
                fa, fb = np.append(fa, f), np.append(f, fb)
            width = 0.5 * float(np.diff(self.t).max())
            found = [(at, float(best)), self._sharpened(values, max(at - width, 0.0), min(at + width, self.length))]
        t, value = min(found, key=lambda place: place[1])
        return CurvePoint(t, self.q(t), value)

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
        return min(((t, value(t)) for t in (a, b, c, d)), key=lambda place: place[1])
