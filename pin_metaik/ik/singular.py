"""Solutions in singularities: which of them are points of a curve, as joints can move while the frame stands still.

In a singularity the Jacobian loses rank, and to first order some joints move freely. Whether they do is seen by moving
them: a step along the null space is put back onto the target across it, by Gauss and Newton's method in the space of
the singular values that are left. Where that meets the target, solutions are not separate; where it does not, as with
an elbow that is stretched, two solutions have become one. What is so near to a singularity that joints may move within
half the tolerance counts as singular: descents find points all along the way.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.ik.problem import IKProblem

NEARLY = 1e-3  # singular value below which a solution may be one of a curve, before it is put onto it ...
SINGULAR = 1e-6  # ... and there
EXACT = 1e-9  # least length of the weighted residual of a point on a curve ...
SLACK, SHARE = 5e-6, 0.5  # ... and greatest, and as a share of the tolerances
STEP, SHORTEST = 0.05, 1e-3  # rad or m from point to point; the last step, before a limit
CORRECTIONS = 12
POINTS = 2_000  # of a curve, each way


def dimensions_at(problem: IKProblem, X: Array) -> tuple[int, ...]:
    """How many degrees of freedom the solutions near each x of X (k, n) have: 0 where it is separate, 1 on a curve.

    A chain with spare coordinates has as many, here and elsewhere. In a singularity of any other a motion is tried.
    """
    spare = problem.chain.n - problem.m
    if spare > 0:
        return (spare,) * len(X)
    motions = NullMotions.of(problem)
    return tuple(motions.dimension(x) for x in X)


@dataclass(frozen=True)
class NullMotions:
    """Motions of the joints that leave the frame where it is, or move it by no more than a slack.

    Attributes:
        problem: To be met exactly.
        slack: Greatest length of its residual.
        singular: Singular value of the Jacobian below which nothing moves.
    """

    problem: IKProblem
    slack: float
    singular: float

    @staticmethod
    def of(problem: IKProblem) -> NullMotions:
        """Motions of a turn or so within half of a problem's tolerances."""
        finite = [least for target in problem.targets for least in target.allowance if np.isfinite(least)]
        slack = float(np.clip(SHARE * min(finite, default=0.0), EXACT, SLACK))
        return NullMotions(problem.exact, slack, max(SINGULAR, slack))

    @property
    def shorter(self) -> NullMotions:
        """Motions of a step or so as well, within all of the tolerances."""
        return NullMotions(self.problem, self.slack / SHARE, max(SINGULAR, self.slack / STEP))

    def dimension(self, x: Array) -> int:
        """How many independent ones there are at x (n,): 0 where the solution is separate."""
        point = self._beside(x)
        if point is None:
            return 0
        free = self._free(point)
        dimension = sum(self._moves(point, way) for way in free)
        both = dimension > 1 and self._moves(point, free.sum(axis=0) / np.sqrt(len(free)))
        return int(dimension if both else min(dimension, 1))  # two curves may cross without a surface between them

    def curve(self, x: Array) -> Array | None:
        """Points (k, n) of the curve that x (n,) is on, from end to end or once round; None if it is none.

        On a surface of solutions they are a curve on it.
        """
        point = self._beside(x)
        if point is None:
            return None
        for way in self._free(point):
            forth, closed = self._follow(point, way)
            back = [] if closed else self._follow(point, -way)[0]
            if forth or back:
                return np.array([*back[::-1], point, *forth])
        return None

    def _svd(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """The residual r (m,) and U (m, n), S (n,), V (n, n) of the Jacobian; of missing rows S is 0."""
        r, J = self.problem.linearize(x)
        U, S, Vt = np.linalg.svd(J.T)
        n = len(x)
        return r, U[:, : len(S)], np.append(S, np.zeros(n - len(S))), Vt.T

    def _beside(self, x: Array) -> Array | None:
        """The singular solution (n,) next to x (n,); None without one."""
        return self._put_onto(x, int((self._svd(x)[2] > NEARLY).sum()))

    def _put_onto(self, x: Array, rank: int) -> Array | None:
        """The solution (n,) next to x (n,) across the directions that ``rank`` singular values leave, or None."""
        if rank == len(x):
            return None
        for _ in range(CORRECTIONS):
            r, U, S, V = self._svd(x)
            if np.linalg.norm(r) < self.slack:
                return x
            x = x - V[:, :rank] @ ((U[:, :rank].T @ r) / S[:rank])
        return None

    def _free(self, x: Array) -> Array:
        """The directions (k, n) in which nothing moves to first order."""
        _, _, S, V = self._svd(x)
        return V[:, self.singular > S].T

    def _moves(self, x: Array, way: Array) -> bool:
        """Whether there is another solution a step from x (n,) along, or against, a direction (n,)."""
        return any(self._next(x, side * way, STEP) is not None for side in (1.0, -1.0))

    def _next(self, x: Array, way: Array, step: float) -> Array | None:
        """The point (n,) of a curve a step farther; None, where it ends or leaves the limits."""
        rank = len(x) - len(self._free(x))
        point = self._put_onto(x + step * way, rank)
        if point is None or not self._inside(point) or not 0.5 * step < np.linalg.norm(point - x) < 2.0 * step:
            return None
        return point if len(self._free(point)) else None

    def _inside(self, x: Array) -> bool:
        """Whether x (n,) is inside the limits; coordinates with room for a whole turn always are."""
        limits = self.problem.limits
        return bool(((limits.lower - EXACT <= x) & (x <= limits.upper + EXACT) | limits.multi_turn).all())

    def _follow(self, x: Array, way: Array) -> tuple[list[Array], bool]:
        """The points of a curve from x (n,) on, without it, and whether it comes back to it."""
        points = list(self._points(x, way))
        return points, bool(points) and bool(self.problem.limits.separation(points[-1], x).max() < 0.75 * STEP)

    def _points(self, start: Array, way: Array) -> Iterator[Array]:
        x, step = start, STEP
        for count in range(POINTS):
            point = self._next(x, way, step)
            if point is None:
                step *= 0.5
                if step < SHORTEST:
                    return
                continue
            yield point
            if count > 2 and self.problem.limits.separation(point, start).max() < 0.75 * STEP:
                return
            free, before = self._free(point), point - x
            along = free.T @ (free @ before)
            x, way = point, along / np.linalg.norm(along)


class Continua:
    """Solutions of a problem that are separate, and curves of others, as they are found.

    Attributes:
        separate: Coordinates (n,) of each of the first.
        curves: Points (k, n) of each of the others; a surface is one point alone, as only one is told apart.
    """

    def __init__(self, problem: IKProblem, apart: float) -> None:
        """None so far, of a problem; solutions nearer than ``apart`` in each coordinate are one."""
        self.separate: list[Array] = []
        self.curves: list[Array] = []
        self._ways: list[Array] = []  # from separate ones, within the tolerances
        self._problem, self._apart, self._on_surface = problem, apart, False
        self._motions = NullMotions.of(problem)

    def add(self, X: Array) -> int:
        """Add what is new of solutions X (k, n), first those that are met best; how many of them are new."""
        return sum(self._is_new(x) for x in X)

    def nearest(self, x0: Array) -> Array:
        """(s, n) the separate ones, and of each curve the point nearest to x0 (n,), where they are apart."""
        kept = list(self.separate)
        for curve in self.curves:  # within the tolerances two of them may touch
            x = self._nearest(curve, x0)
            if not any(self._are_one(x, other) for other in kept):
                kept.append(x)
        return np.reshape(kept, (len(kept), len(x0)))

    def _is_new(self, x: Array) -> bool:
        from pin_metaik.kinematics.self_motion.near import is_near_curve

        multi_turn = self._problem.limits.multi_turn.astype(np.int64)
        if any(self._are_one(x, other) for other in self.separate):
            return False
        met = np.linalg.norm(self._motions.problem.linearize(x)[0]) < EXACT
        known = self.curves if met else [*self.curves, *self._ways]  # a motion may lead to another that is met exactly
        if any(is_near_curve(x, curve, multi_turn, self._apart) for curve in known):
            return False
        dimension = self._motions.dimension(x)
        if dimension > 1:
            new, self._on_surface = not self._on_surface, True
            self.curves += [x[None]] if new else []
            return new
        curve = self._motions.curve(x) if dimension else None
        if curve is not None:
            self.curves.append(curve)
            return True
        self.separate.append(x)
        way = self._motions.shorter.curve(x)
        self._ways += [] if way is None else [way]
        return True

    def _are_one(self, x: Array, other: Array) -> bool:
        return bool(self._problem.limits.separation(x, other).max() <= self._apart)

    def _nearest(self, curve: Array, x0: Array) -> Array:
        X = self._problem.limits.nearest_turns(curve, x0)
        nearest: Array = X[np.argmin(np.linalg.norm(X - x0, axis=1))]
        return nearest
