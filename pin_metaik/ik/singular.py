"""Solutions in singularities: which of them are points of a curve, as joints can move while the frame stands still.

In a singularity the Jacobian loses rank, and to first order some joints move freely. Whether they do is seen by moving
them: a step along the null space is put back onto the target across it, by Gauss and Newton's method in the space of
the singular values that are left. Where that meets the target exactly, solutions are not separate; where it does not,
as with an elbow that is stretched, two solutions have become one.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.ik.problem import IKProblem

NEARLY = 1e-3  # singular value below which a solution may be one of a curve, before it is put onto it ...
SINGULAR = 1e-6  # ... and there
EXACT = 1e-9  # length of the weighted residual of a point on a curve
STEP, SHORTEST = 0.05, 1e-3  # rad or m from point to point; the last step, before a limit
CORRECTIONS = 12
POINTS = 2_000  # of a curve, each way
TURN = 2.0 * np.pi


def dimension_at(problem: IKProblem, x: Array) -> int:
    """How many degrees of freedom the solutions near x (n,) have: 0 where it is separate, 1 on a curve.

    A chain with spare coordinates has as many, here and elsewhere. In a singularity of any other a motion is tried.
    """
    spare = problem.chain.n - problem.m
    if spare > 0:
        return spare
    point = _beside(problem, x)
    if point is None:
        return 0
    free = _free(problem, point)
    dimension = sum(_moves(problem, point, way) for way in free)
    both = dimension > 1 and _moves(problem, point, free.sum(axis=0) / np.sqrt(len(free)))
    return int(dimension if both else min(dimension, 1))  # two curves may cross without a surface between them


def curve_through(problem: IKProblem, x: Array) -> Array | None:
    """Points (k, n) of the curve of solutions that x (n,) is on, from limit to limit or once round; None if it is none.

    On a surface of solutions they are a curve on it.
    """
    point = _beside(problem, x)
    if point is None:
        return None
    for way in _free(problem, point):
        forth, closed = _follow(problem, point, way)
        back = [] if closed else _follow(problem, point, -way)[0]
        if forth or back:
            return np.array([*back[::-1], point, *forth])
    return None


class Continua:
    """Solutions of a problem that are separate, and curves of others, as they are found.

    Attributes:
        separate: Coordinates (n,) of each of the first.
        curves: Points (k, n) of each of the others; a surface is one point alone, as only one is told apart.
    """

    def __init__(self, problem: IKProblem, apart: float) -> None:
        """None so far, of a problem to be met exactly; solutions nearer than ``apart`` in each coordinate are one."""
        self.separate: list[Array] = []
        self.curves: list[Array] = []
        self._problem, self._apart, self._on_surface = problem, apart, False

    def add(self, X: Array) -> int:
        """Add what is new of solutions X (k, n); how many of them are."""
        return sum(self._is_new(x) for x in X)

    def nearest(self, x0: Array) -> Array:
        """(s, n) the separate ones, and of each curve the point nearest to x0 (n,)."""
        return np.array([*self.separate, *(self._nearest(curve, x0) for curve in self.curves)])

    def _is_new(self, x: Array) -> bool:
        from pin_metaik.kinematics.self_motion.near import is_on_curve

        limits, multi_turn = self._problem.limits, self._problem.limits.multi_turn.astype(np.int64)
        if any(limits.separation(x, other).max() <= self._apart for other in self.separate):
            return False
        if any(is_on_curve(x, curve, multi_turn, self._apart) for curve in self.curves):
            return False
        dimension = dimension_at(self._problem, x)
        if dimension > 1:
            new, self._on_surface = not self._on_surface, True
            self.curves += [x[None]] if new else []
            return new
        curve = curve_through(self._problem, x) if dimension else None
        if curve is None:
            self.separate.append(x)
        else:
            self.curves.append(curve)
        return True

    def _nearest(self, curve: Array, x0: Array) -> Array:
        X = self._problem.limits.nearest_turns(curve, x0)
        nearest: Array = X[np.argmin(np.linalg.norm(X - x0, axis=1))]
        return nearest


def _svd(problem: IKProblem, x: Array) -> tuple[Array, Array, Array, Array]:
    """The residual r (m,) and U (m, n), S (n,), V (n, n) of the Jacobian; of missing rows S is 0."""
    r, J = problem.linearize(x)
    U, S, Vt = np.linalg.svd(J.T)
    n = len(x)
    return r, U[:, : len(S)], np.append(S, np.zeros(n - len(S))), Vt.T


def _beside(problem: IKProblem, x: Array) -> Array | None:
    """The singular solution (n,) next to x (n,); None without one."""
    return _put_onto(problem, x, int((_svd(problem, x)[2] > NEARLY).sum()))


def _put_onto(problem: IKProblem, x: Array, rank: int) -> Array | None:
    """The solution (n,) next to x (n,) across the directions that ``rank`` singular values leave; None without one."""
    if rank == len(x):
        return None
    for _ in range(CORRECTIONS):
        r, U, S, V = _svd(problem, x)
        if np.linalg.norm(r) < EXACT:
            return x
        x = x - V[:, :rank] @ ((U[:, :rank].T @ r) / S[:rank])
    return None


def _free(problem: IKProblem, x: Array) -> Array:
    """The directions (k, n) in which nothing moves to first order."""
    _, _, S, V = _svd(problem, x)
    return V[:, S < SINGULAR].T


def _moves(problem: IKProblem, x: Array, way: Array) -> bool:
    """Whether there is another solution a step from x (n,) along, or against, a direction (n,)."""
    return any(_next(problem, x, side * way, STEP) is not None for side in (1.0, -1.0))


def _next(problem: IKProblem, x: Array, way: Array, step: float) -> Array | None:
    """The point (n,) of a curve a step farther; None, where it ends or leaves the limits."""
    rank = len(x) - len(_free(problem, x))
    point = _put_onto(problem, x + step * way, rank)
    if point is None or not _inside(problem, point) or not 0.5 * step < np.linalg.norm(point - x) < 2.0 * step:
        return None
    return point if len(_free(problem, point)) else None


def _inside(problem: IKProblem, x: Array) -> bool:
    """Whether x (n,) is inside the limits; coordinates with room for a whole turn always are."""
    limits = problem.limits
    return bool(((limits.lower - EXACT <= x) & (x <= limits.upper + EXACT) | limits.multi_turn).all())


def _follow(problem: IKProblem, x: Array, way: Array) -> tuple[list[Array], bool]:
    """The points of a curve from x (n,) on, without it, and whether it comes back to it."""
    points = list(_points(problem, x, way))
    return points, bool(points) and bool(problem.limits.separation(points[-1], x).max() < 0.75 * STEP)


def _points(problem: IKProblem, start: Array, way: Array) -> Iterator[Array]:
    x, step = start, STEP
    for count in range(POINTS):
        point = _next(problem, x, way, step)
        if point is None:
            step *= 0.5
            if step < SHORTEST:
                return
            continue
        yield point
        if count > 2 and problem.limits.separation(point, start).max() < 0.75 * STEP:
            return
        free, before = _free(problem, point), point - x
        along = free.T @ (free @ before)
        x, way = point, along / np.linalg.norm(along)
