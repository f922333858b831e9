"""All self-motions of a target: every curve of solutions inside the limits, and the proof that none is missing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBudget, InvalidSetting
from pin_metaik.ik.criteria import Selection
from pin_metaik.ik.goals.pose import TargetLike
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine import DLS
from pin_metaik.ik.self_motion.curve import CurveEnd, CurvePoint, EndReason, SelfMotionCurve
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.proofs.boxes import Boxes
from pin_metaik.optimize import Budget
from pin_metaik.optimize.settings import positive
from pin_metaik.plain import fields_of
from pin_metaik.randomness import DEFAULT_SEED
from pin_metaik.watching import Progress, Stopped, Watch, tell

MOTION_BUDGET = Budget(evaluations=400_000)
RESOLUTION = 0.3  # rad or m
STEP = 0.05  # rad or m between the points of a curve, at most
POINTS = 20_000  # of a curve at most
CHUNK, MOST = 4_096, 8_192  # boxes looked at, and kept, at a time; kept in all
FINER = 8.0, 64.0, 512.0  # by how much smaller boxes that are far from all curves are looked at
SPREAD = 16  # of the boxes that are far from all curves, from which descents start first
SEEDS = 512  # solutions to follow curves from, at a time
DRAWN, LOOKED_UP, DRAWN_MORE = 64, 128, 512  # configurations to descend from at first; where boxes have no end
SEED = DEFAULT_SEED, 0
SAME = 5e-3  # rad or m: a solution this near to a curve is on it
TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class SelfMotions:
    """The self-motions of a chain with one spare degree of freedom for one target.

    Attributes:
        curves: The curves, the longest first.
        complete: ``Proof.BOXES``: every solution inside the limits is within ``resolution`` of a point of one of the
            curves, so that a missing curve would be that close to these all along. Of a spherical wrist not its three
            coordinates are compared but only the side to which it is bent, but for places where it may be straight:
            there its coordinates are, too. ``None``: nothing is proved.
        resolution: rad or m; see ``complete``.
        evaluations: Forward kinematics computed, and boxes looked at.
        seconds: Time taken, s.
        interrupted: Whether a watch ended the search.
    """

    curves: tuple[SelfMotionCurve, ...]
    complete: Proof | None
    resolution: float
    evaluations: int
    seconds: float
    interrupted: bool = False

    def __len__(self) -> int:
        return len(self.curves)

    def __iter__(self) -> Iterator[SelfMotionCurve]:
        return iter(self.curves)

    def nearest(self, q: ArrayLike, weights: Mapping[str, float] | None = None) -> CurvePoint:
        """The point of all curves with the least distance from a configuration (nq,); see ``SelfMotionCurve.nearest``.

        Raises:
            InvalidSetting: There is no curve.
        """
        return min((curve.nearest(q, weights) for curve in self._some()), key=_value)

    @checked
    def best(self, criterion: Selection) -> CurvePoint:
        """The point of all curves where a criterion is least; see ``SelfMotionCurve.best``.

        Raises:
            InvalidSetting: There is no curve.
        """
        return min((curve.best(criterion) for curve in self._some()), key=_value)

    def _some(self) -> tuple[SelfMotionCurve, ...]:
        if not self.curves:
            raise InvalidSetting("there is no self-motion to choose from: the target has no solution that was found")
        return self.curves

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        plain = fields_of(self, "complete", "resolution", "interrupted", "evaluations", "seconds")
        return {"curves": [curve.as_dict() for curve in self.curves], **plain}


def _value(point: CurvePoint) -> float:
    return point.value


@checked
def self_motions(
    chain: Chain,
    target: TargetLike | Sequence[TargetLike],
    q0: ArrayLike | None = None,
    *,
    resolution: float = RESOLUTION,
    budget: Budget = MOTION_BUDGET,
    watch: Watch | None = None,
) -> SelfMotions:
    """Find every curve of solutions of a target that leaves a chain one spare degree of freedom.

    Boxes of configurations that cannot be excluded cover all solutions. From each box that no known curve comes near, a
    descent leads to a point of another curve, which is followed in both directions to its ends.

    Args:
        chain: The joints to move and the frame to place.
        target: As for ``solve_ik``; it must constrain one axis less than the chain has coordinates. The curves meet the
            middle of its tolerances.
        q0: (nq,) configuration that gives the values of joints outside the chain and of locked ones, and to which
            copies by whole turns are nearest; default: the chain's reference.
        resolution: rad or m; how close to the curves found a missing one would have to be (``SelfMotions.complete``).
        budget: Evaluations that may be spent, and seconds.
        watch: Called between boxes with evaluations spent and allowed; True ends the search.

    Raises:
        InvalidTarget: If the target is not a pose, position or orientation.
        InvalidConfiguration: If ``q0`` is not a configuration of the model.
        InvalidSetting: If the chain has none or several spare degrees of freedom, or ``resolution`` is not above zero.
        InvalidBudget: If the budget has no limit on evaluations.
    """
    positive("resolution", resolution)
    if budget.evaluations is None:
        raise InvalidBudget("finding self-motions needs a budget of evaluations: Budget(evaluations=...)")
    chain = chain if q0 is None else chain.at(q0)
    problem = IKProblem.of(chain, target).exact
    if not has_curves(problem):
        spare = chain.n - problem.m
        raise InvalidSetting(
            f"self-motions are curves where one coordinate is spare and one frame is placed; here {spare} are, of "
            f"{len(chain.frames)} frames: solve_ik_all samples the solutions"
        )
    base = chain.reference if q0 is None else chain.configuration(q0)
    return find_self_motions(problem, base, resolution, budget, watch)


def has_curves(problem: IKProblem) -> bool:
    """Whether a problem's solutions are curves: one frame, one spare coordinate, and nothing but a target."""
    return len(problem.targets) == 1 and problem.chain.n == problem.m + 1 and not problem.goals


def find_self_motions(
    problem: IKProblem, base: Array, resolution: float, budget: Budget, watch: Watch | None = None
) -> SelfMotions:
    """``self_motions`` of a problem that has curves, to be met exactly."""
    began = perf_counter()
    search = _Search(problem, base, resolution, budget, watch)
    interrupted = False
    try:
        search.run()
    except Stopped:
        interrupted = True
    curves = tuple(sorted(search.curves, key=lambda curve: -curve.length))
    complete = Proof.BOXES if search.covered and not interrupted else None
    return SelfMotions(curves, complete, resolution, search.spent, perf_counter() - began, interrupted)


class _Search:
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

        Descents start from those that are far from all curves, at first from some of them. Those that still are then
        are split again, as exclusion is weak where boxes are large.
        """
        kept = self._kept(boxes)
        for finer in (*FINER, None):
            if kept is None:
                return False
            far = kept[~self._is_near(boxes, kept)]
            for stride in (1 + len(far) // SPREAD, 1):
                if len(far):
                    self._from(far[::stride, : self._problem.chain.n], boxes.least)
                    far = far[~self._is_near(boxes, far)]
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

    def _is_near(self, boxes: Boxes, kept: Array) -> NDArray[np.bool_]:
        """(k,) whether all of each box (k, 2 m) is within the resolution of a point of a curve.

        Where a box is long in the coordinates of a wrist, these are left out, but the point must have it bent to the
        side that all of the box does.
        """
        from pin_metaik.kinematics.self_motion.near import mark_near

        n, wrist = self._problem.chain.n, boxes.arm.wrist
        near, side = np.zeros(len(kept), np.int64), np.zeros(len(kept))
        every, others = np.arange(n), np.setdiff1d(np.arange(n), wrist)
        wide = (kept[:, kept.shape[1] // 2 + wrist] > boxes.least).any(axis=1)
        if wide.any():
            side[wide] = np.sign(self._bends(boxes, kept[wide, :n]))
        for curve in self.curves:
            bent = np.sign(self._bends(boxes, curve.x)) if wide.any() else side
            for which in (-1.0, 0.0, 1.0):
                at = np.flatnonzero((side == which) & (near == 0))
                if len(at):
                    x = curve.x if which == 0.0 else curve.x[bent == which]
                    marks = np.zeros(len(at), np.int64)
                    mark_near(kept[at], x, others if which else every, self._turning, self._resolution, marks)
                    near[at] = marks
        marked: NDArray[np.bool_] = near == 1
        return marked

    def _bends(self, boxes: Boxes, X: Array) -> Array:
        """Triple product (k,) of a wrist's axes at coordinates X (k, n): 0 where it is straight."""
        from pin_metaik.kinematics.self_motion.near import bends

        joints, wiring, _, tip, *_ = boxes.arm.arrays
        bent = np.empty(len(X))
        bends(joints, wiring, tip, np.ascontiguousarray(X), bent)
        return bent

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
