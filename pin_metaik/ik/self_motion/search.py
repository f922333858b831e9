"""The search for all self-motions of one problem: curves through solutions, and boxes for what they leave."""

from __future__ import annotations

from collections.abc import Callable
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
POINTS = 20_000  # of a curve at most, either way
CHUNK, MOST = 4_096, 8_192  # boxes looked at, and kept, at a time; kept in all
FINER = 8.0, 64.0, 512.0  # by how much smaller boxes that are far from all curves are looked at
SPREAD = 16  # of the boxes to which no curve comes, or that are beside all, from which descents start first, at most
THROUGH = 1e-4  # rad or m: a curve that is farther from a box does not go through it
SEEDS = 512  # solutions to follow curves from, at a time
DRAWN, LOOKED_UP, DRAWN_MORE = 64, 128, 512  # configurations to descend from at first; where boxes have no end
SEED = DEFAULT_SEED, 0


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
        self._equations = problem.chain.bare, problem.records, problem.kernel_rows
        self._turning = limits.multi_turn.astype(np.int64)
        n = problem.chain.n
        self._ways = np.empty((4, POINTS, n))
        self._curve = np.empty((2 * POINTS, n)), np.empty((2 * POINTS, n)), np.empty(2 * POINTS)
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

        Descents start from those to which no curve comes, at first from some of them, and from some beside the curves,
        as there may be others very near to these. Those that are far from all curves then are split again, as exclusion
        is weak where boxes are large.
        """
        kept = self._kept(boxes)
        for finer in (*FINER, None):
            if kept is None:
                return False
            for stride in (1 + len(kept) // SPREAD, 1):
                others = kept[~self._are_met(kept)][::stride]
                if len(others):
                    self._from(others[:, : self._problem.chain.n], boxes.least)
            beside = kept[~self._are_crossed(kept)]
            if len(beside):
                self._from(beside[:: 1 + len(beside) // SPREAD, : self._problem.chain.n], 0.0)
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
        from pin_metaik.kinematics.self_motion.near import mark_near

        return self._marked(kept, lambda x, _, on: mark_near(kept, x, self._turning, 1.0, self._resolution, on))

    def _are_met(self, kept: Array) -> NDArray[np.bool_]:
        """(k,) whether a curve comes to each box (k, 2 m), or nearly: where none does there may be another one."""
        from pin_metaik.kinematics.self_motion.near import mark_near

        return self._marked(kept, lambda x, _, on: mark_near(kept, x, self._turning, -1.0, STEP, on))

    def _are_crossed(self, kept: Array) -> NDArray[np.bool_]:
        """(k,) whether a curve goes through each box (k, 2 m), so that nothing else need be in it."""
        from pin_metaik.kinematics.self_motion.near import mark_crossed

        return self._marked(kept, lambda x, along, on: mark_crossed(kept, x, along, self._turning, THROUGH, on))

    def _marked(self, kept: Array, mark: Callable[[Array, Array, NDArray[np.int64]], None]) -> NDArray[np.bool_]:
        """(k,) which boxes ``mark`` marks by the points (p, n) and the tangents there of some curve."""
        marks = np.zeros(len(kept), np.int64)
        for curve in self.curves:
            mark(curve.x, curve._tangents, marks)
        marked: NDArray[np.bool_] = marks == 1
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
        looked = len(self.curves)
        self._add(found[:known])
        while looked < len(self.curves):
            new, looked = self.curves[looked:], len(self.curves)
            self._add(np.concatenate([self._beside(curve) for curve in new]))

    def _add(self, solutions: Array) -> None:
        """Follow the curves through solutions (k, n) that are on none of those that are known."""
        on = np.zeros(len(solutions), np.int64)
        for curve in self.curves:
            self._mark_on(curve, solutions, on)
        for k, x in enumerate(solutions):
            new = self._followed(x) if on[k] == 0 else None
            if new is not None:
                self.curves.append(new)
                self._mark_on(new, solutions, on)

    def _beside(self, curve: SelfMotionCurve) -> Array:
        """Solutions (k, n) inside the limits that are near to a curve, but on another one, as for an elbow's sides."""
        from pin_metaik.kinematics.self_motion.twins import EVERY, find_twins

        twins = np.empty((1 + len(curve.x) // EVERY, self._problem.chain.n))
        twins = twins[: find_twins(*self._equations, curve.x, curve._tangents, twins)]
        self.spent += len(curve.x) // EVERY
        return twins[((twins >= self._lower) & (twins <= self._upper)).all(axis=1)]

    def _mark_on(self, curve: SelfMotionCurve, solutions: Array, on: NDArray[np.int64]) -> None:
        """Mark with 1 the solutions (k, n) that are on a curve."""
        from pin_metaik.kinematics.self_motion.on_curve import mark_on

        mark_on(*self._equations, self._turning, solutions, curve.x, curve._tangents, on)

    def _followed(self, x: Array) -> SelfMotionCurve | None:
        """The curve through a solution x (n,), from end to end; None in a singularity, and for a point alone."""
        from pin_metaik.kinematics.self_motion.follow import follow

        points, tangents, t = self._curve
        given = *self._equations, self._lower, self._upper, self._turning
        count, *ends, spent = follow(*given, x.copy(), STEP, self._left, self._ways, points, tangents, t)
        self.spent += spent
        if count < 2:
            return None
        begin, end = self._end(*ends[:2]), self._end(*ends[2:])
        found = points[:count].copy(), t[:count].copy(), (begin, end), tangents[:count].copy()
        return SelfMotionCurve(self._problem, self._base, *found)

    def _end(self, how: int, limit: int) -> CurveEnd:
        """How a curve ends, as ``follow`` says it."""
        from pin_metaik.kinematics.self_motion.trace import AT_LIMIT, CLOSED

        if how == AT_LIMIT:
            return CurveEnd(EndReason.LIMIT, self._problem.chain.names[limit // 2], bool(limit % 2))
        return CurveEnd(EndReason.CLOSED if how == CLOSED else EndReason.SINGULARITY)
