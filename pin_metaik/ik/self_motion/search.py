"""The search for all self-motions of one problem: curves through solutions, and boxes for what they leave."""

from __future__ import annotations

from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine import DLS
from pin_metaik.ik.self_motion.curve import CurveEnd, EndReason, SelfMotionCurve
from pin_metaik.kinematics.proofs.boxes import Boxes
from pin_metaik.optimize import Budget
from pin_metaik.randomness import DEFAULT_SEED
from pin_metaik.watching import Progress, Watch, tell

STEP = 0.05  # rad or m between the points of a curve, at most
POINTS = 20_000  # of a curve at most
CHUNK, MOST = 4_096, 8_192  # boxes looked at, and kept, at a time; kept in all
FINER = 8.0, 64.0, 512.0  # by how much smaller boxes that are far from all curves are looked at
SPREAD = 16  # of the boxes to which no curve comes, from which descents start first, at most
SEEDS = 512  # solutions to follow curves from, at a time
DRAWN, LOOKED_UP, DRAWN_MORE = 64, 128, 512  # configurations to descend from at first; where boxes have no end
SEED = DEFAULT_SEED, 0
SAME = 5e-3  # rad or m: a solution this near to a curve is on it


class Search:
    """The curves of one problem, as they are found.

    Attributes:
        curves: So far.
        spent: Evaluations and boxes so far.
        covered: Whether every box that may hold a solution is near a curve.
    """

    def __init__(self, problem: IKProblem, base: Array, resolution: float, budget: Budget, watch: Watch | None) -> None:
        limits = problem.limits
        self.curves: list[SelfMotionCurve] = []
        self.spent, self.covered = 0, False
        self._problem, self._base, self._resolution, self._watch = problem, base, resolution, watch
        self._total = budget.evaluations or 0
        self._until = np.inf if budget.seconds is None else perf_counter() + budget.seconds
        self._turning = limits.multi_turn.astype(np.int64)
        self._lower = np.where(limits.multi_turn, -np.inf, limits.lower)
        self._upper = np.where(limits.multi_turn, np.inf, limits.upper)

    def run(self) -> None:
        """Find curves from some random configurations, then those through the boxes that cover the limits.

        Where there are no boxes, or no end of them, more descents are made, from an atlas and at random.
        """
        target, chain, apart = self._problem.targets[0], self._problem.chain, 0.5 * self._resolution
        free = not target.counts[3], not target.counts[4], not target.counts[5]
        near = 0.0 if all(target.counts[:3]) else np.inf
        self._from(chain.sample(DRAWN, SEED), apart)
        if near == 0.0 or sum(free) < 2:
            boxes = chain._boxes(0, target.pose.homogeneous, near, 0.0, free, least=apart, shrink=True)
            self.covered = boxes is not None and self._is_covered(boxes)
        if not self.covered:
            self._from(np.concatenate([self._problem.near(LOOKED_UP), chain.sample(DRAWN_MORE, SEED)]), apart)

    def _is_covered(self, boxes: Boxes) -> bool:
        """Find the curves through all boxes that are kept; whether there is one near all of them.

        Descents start from those to which no curve comes, at first from some of them. Those that are far from all
        curves then are split again, as exclusion is weak where boxes are large.
        """
        kept = self._kept(boxes)
        for finer in (*FINER, None):
            if kept is None:
                return False
            for stride in (1 + len(kept) // SPREAD, 1):
                others = kept[~self._are_met(kept)][::stride]
                if len(others):
                    self._from(others[:, : self._problem.chain.n], boxes.least)
            far = kept[~self._are_near(kept)]
            if not len(far):
                return True
            if finer is not None:
                boxes = boxes.among(far, 0.5 * self._resolution / finer)
                kept = self._kept(boxes)
        return False

    def _kept(self, boxes: Boxes) -> Array | None:
        """Boxes (k, 2 m) that are kept; None, if the budget ends before, or there is no end of them."""
        kept: list[Array] = []
        while not boxes.done:
            before = boxes.looked
            if self._left == 0 or perf_counter() > self._until or sum(map(len, kept)) >= MOST:
                return None
            kept.append(boxes.look(min(CHUNK, self._left), CHUNK))
            self.spent += boxes.looked - before
            tell(self._watch, Progress(self.spent, self._total))
        return np.concatenate(kept) if kept else np.empty((0, boxes.arm.whole.shape[1]))

    def _are_near(self, kept: Array) -> NDArray[np.bool_]:
        """(k,) whether all of each box (k, 2 m) is within the resolution of a point of a curve."""
        return self._marked(kept, 1.0, self._resolution)

    def _are_met(self, kept: Array) -> NDArray[np.bool_]:
        """(k,) whether a curve comes to each box (k, 2 m), or nearly: where none does there may be another one."""
        return self._marked(kept, -1.0, STEP)

    def _marked(self, kept: Array, side: float, distance: float) -> NDArray[np.bool_]:
        from pin_metaik.kinematics.self_motion.near import mark_near

        near = np.zeros(len(kept), np.int64)
        for curve in self.curves:
            mark_near(kept, curve.x, self._turning, side, distance, near)
        marked: NDArray[np.bool_] = near == 1
        return marked

    @property
    def _left(self) -> int:
        """Evaluations and boxes left."""
        return max(0, self._total - self.spent)

    def _from(self, starts: Array, apart: float) -> None:
        """Descend from starts (s, n) to solutions that are so far apart, and follow the curves that are new."""
        found = np.empty((min(len(starts), SEEDS), self._problem.chain.n))
        starts = self._problem.limits.clip(starts)
        spent, known, _ = (
            DLS().descent().gather(self._problem, starts, found, 0, apart, len(starts) + 1, self._left, branch=False)
        )
        self.spent += spent
        for x in found[:known]:
            if not any(self._is_on(curve, x) for curve in self.curves):
                curve = self._followed(x)
                self.curves += [] if curve is None else [curve]

    def _is_on(self, curve: SelfMotionCurve, x: Array) -> bool:
        """Whether coordinates x (n,) lie on a curve: near to the line from one of its points to the next."""
        from pin_metaik.kinematics.self_motion.near import is_on_curve

        return bool(is_on_curve(x, curve.x, self._turning, SAME))

    def _followed(self, x: Array) -> SelfMotionCurve | None:
        """The curve through a solution x (n,), from end to end; None in a singularity, and for a point alone."""
        from pin_metaik.kinematics.self_motion.trace import put_back

        problem = self._problem
        start, tangent = x[None].copy(), null_direction(problem.linearize(x)[1])[None]
        if put_back(problem.chain.bare, problem.records, problem.kernel_rows, start, tangent) == 0:
            return None
        start = np.clip(start, self._lower, self._upper)
        first = self._trace(start[0], tangent[0], 1.0)
        if first[2].reason is EndReason.CLOSED:
            points, tangents, ends = first[0], first[1], (first[2], first[2])
        else:
            last = self._trace(start[0], tangent[0], -1.0)
            points = np.concatenate([last[0][:0:-1], first[0]])
            tangents = np.concatenate([-last[1][:0:-1], first[1]])
            ends = last[2], first[2]
        t = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
        if t[-1] == 0.0:
            return None
        distinct = np.append(True, np.diff(t) > 0.0)  # a curve that begins at a limit may have its end twice
        points, tangents, t = points[distinct], tangents[distinct], t[distinct]
        return SelfMotionCurve(self._problem, self._base, points, t, ends, tangents)

    def _trace(self, start: Array, tangent: Array, way: float) -> tuple[Array, Array, CurveEnd]:
        """Points (k, n) of the curve from a point (n,) on along its tangent, or against it, and how it ends."""
        from pin_metaik.kinematics.self_motion.trace import AT_LIMIT, CLOSED, trace

        problem = self._problem
        given = problem.chain.bare, problem.records, problem.kernel_rows, self._lower, self._upper, self._turning
        points, tangents = np.empty((POINTS, len(start))), np.empty((POINTS, len(start)))
        tangents[0] = tangent
        count, why, limit, spent = trace(*given, start, way, STEP, self._left, points, tangents)
        self.spent += spent
        end = CurveEnd(EndReason.CLOSED if why == CLOSED else EndReason.SINGULARITY)
        if why == AT_LIMIT:
            end = CurveEnd(EndReason.LIMIT, problem.chain.names[limit // 2], bool(limit % 2))
        return points[:count].copy(), tangents[:count].copy(), end


def null_direction(J: Array) -> Array:
    """The unit vector (n,) that a Jacobian, given as its transpose (n, n - 1), maps to zero."""
    direction: Array = np.linalg.svd(J.T)[2][-1]
    return np.ascontiguousarray(direction)
