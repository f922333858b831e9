"""The solutions of every pose of a path: those followed from the pose before and after it, and some found afresh."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, FREE, Tolerance
from pin_metaik.ik.leaves import leaves
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.solver import DEFAULT_SOLVER, IKSolver
from pin_metaik.ik.starts import drawn
from pin_metaik.randomness import Rng
from pin_metaik.watching import Progress, Watch, tell

WIDEST, MOST, LEAVES = 48, 72, 144  # solutions in a layer, in one that is widened, and in one with self-motions
AROUND = 64  # poses before and after a break whose layers are widened
TRACED, POINTS = 12, 72  # poses whose self-motions are traced, and points of these for one pose
FRESH = 24  # starts from the atlas and as many random ones for a layer of its own
APART = 1e-2  # rad or m between solutions of one layer
EVALUATIONS = 10_000  # for one layer, each way, if no solver says otherwise
INSIDE = 0.9  # of a tolerance: how far off the middle other targets within it are
DRIFT = 0.5  # of the longest step of a joint: how far a redundant chain is moved among the solutions of one pose
TINY = 1e-12  # of a unit vector: what counts as not moving a joint

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Layers:
    """Solutions of k poses.

    Attributes:
        problems: What each pose asks for.
        base: (nq,) where the joints that the chain does not move are.
        bound: (n,) the longest step of each joint between two poses, rad or m.
        solver: How solutions are found; None: by damped least squares.
        rng: Seed or generator of the starts.
        found: Solutions (s, n) of each pose; none where none was found, in a world none that is free.
        colliding: One solution (n,) in collision of poses that have no free one, by their number.
    """

    problems: list[IKProblem]
    base: Floats
    bound: Floats
    solver: IKSolver | None
    rng: Rng
    found: list[Floats] = field(init=False, default_factory=list)
    colliding: dict[int, Floats] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        """Every layer is empty until it is filled."""
        self.found[:] = [self._none for _ in self.problems]

    def fill(self, near: bool, watch: Watch | None) -> None:
        """Find solutions of every pose; ``near``: followed from where the base has the chain.

        Raises:
            Stopped: The watch says so; the layers are those so far.
        """
        x0 = self.problems[0].chain.x(self.base)
        followed = x0[None] if near else self._none
        for i, problem in enumerate(self.problems):
            if i:
                tell(watch, Progress(i, len(self.problems)))
            if problem.refuted not in (None, Proof.LIMITS):
                continue
            fresh = problem.branches(followed[0] if len(followed) else x0)
            if not len(fresh):
                fresh = np.concatenate([problem.near(FRESH), drawn(problem.chain, self.rng, i, FRESH)])
            self._add(i, problem, followed, WIDEST)
            self._add(i, problem, fresh, WIDEST // 2)
            if not len(self.found[i]):  # nothing in the middle of the tolerances
                self._add(i, problem.whole, followed, WIDEST)
                self._add(i, problem.whole, fresh, WIDEST // 2)
            if not len(self.found[i]) and self.solver is not None:
                self._solve(i, self.solver, followed[0] if len(followed) else x0)
            followed = self.found[i] if len(self.found[i]) else followed
        for i in range(len(self.problems) - 2, -1, -1):  # what only a later pose found may have begun earlier
            self._add(i, self.problems[i], self.found[i + 1], WIDEST)
        if watch is not None:
            watch(Progress(len(self.problems), len(self.problems)))  # there is nothing left to end

    @property
    def flexible(self) -> bool:
        """Whether any pose leaves a choice: tolerances that are not small, or more joints than it needs."""
        return any(problem.loose or problem.chain.n > problem.m for problem in self.problems)

    def widen(self, breaks: Collection[int], watch: Watch | None) -> None:
        """Find more solutions where poses leave a choice: off the middle of tolerances, and along self-motions.

        Args:
            breaks: Poses that are not reached from the one before; these and poses without a solution, and some before
                and after them, get more solutions.
            watch: Called with poses done and in all.

        Raises:
            Stopped: The watch says so; the layers are those so far.
        """
        open_ones = np.array([problem.refuted in (None, Proof.LIMITS) for problem in self.problems])
        wanted = np.array([not len(layer) for layer in self.found]) & open_ones
        wanted[list(breaks)] = True
        near = np.convolve(wanted, np.ones(2 * AROUND + 1), "same") > 0.5
        chosen = np.flatnonzero(near[: len(wanted)] & open_ones).tolist()
        for done, i in enumerate(chosen):
            tell(watch, Progress(done, len(chosen), label="within the tolerances"))
            problem, before = self.problems[i], self.found[i - 1] if i else self._none
            self._add(i, problem.whole, before, WIDEST)
            starts = np.concatenate([before, self._drifted(i)])
            for aim in self._aims(problem):
                self._add(i, aim, starts if len(starts) else problem.near(FRESH), MOST)
        for i in reversed(chosen):
            if i + 1 < len(self.problems):
                self._add(i, self.problems[i].whole, self.found[i + 1], MOST)

    def trace(self, breaks: Collection[int], watch: Watch | None) -> None:
        """Add points of the self-motions of some poses, and follow each to the poses before and after.

        Args:
            breaks: Poses that are not reached from the one before; the self-motions of both, and of poses that still
                have no solution, are traced.
            watch: Called with poses done and in all.

        Raises:
            Stopped: The watch says so; the layers are those so far.
        """
        ends = {i for k in breaks for i in (k - 1, k)}
        wanted = sorted(ends | {i for i, layer in enumerate(self.found) if not len(layer)})
        traced = 0
        for done, i in enumerate(wanted):
            tell(watch, Progress(done, len(wanted), label="along self-motions"))
            problem, helped = self.problems[i], i not in ends and len(self.found[i])
            if traced == TRACED or helped or problem.refuted not in (None, Proof.LIMITS):
                continue
            points = self._beside(i, leaves(problem, self.base, DRIFT * float(self.bound.min()), POINTS))
            traced += bool(len(points))
            self._take(i, points[: LEAVES - len(self.found[i])])
            for way in (1, -1):
                self._follow(i, way)

    def _follow(self, i: int, way: int) -> None:
        """Follow the solutions of a pose to those after (``way`` 1) or before (-1) it, as far as any lead."""
        for k in range(i + way, i + way * (AROUND + 1), way):
            if not 0 <= k < len(self.problems) or not len(self.found[k - way]):
                break
            self._add(k, self.problems[k], self.found[k - way], LEAVES)

    def _beside(self, i: int, X: Floats) -> Floats:
        """Solutions X (s, n) of a pose as the copies by whole turns nearest to what is known there or next to it."""
        known = [layer for layer in self.found[max(i - 1, 0) : i + 2] if len(layer)]
        return self.problems[i].limits.nearest_turns(X, known[0][0]) if known else X

    @property
    def _none(self) -> Floats:
        return np.empty((0, self.problems[0].chain.n))

    def _drifted(self, i: int) -> Floats:
        """The solutions of a pose moved a little along their self-motions, each way; they need not be solutions."""
        problem, X = self.problems[i], self.found[i]
        spare = problem.chain.n - problem.m
        if spare <= 0 or not len(X):
            return self._none
        J = np.array([problem.linearize(x)[1].T for x in X])  # (s, m, n)
        free = np.linalg.svd(J)[2][:, -spare:]  # (s, n - m, n)
        steps = free * (DRIFT * self.bound / np.maximum(np.abs(free), TINY)).min(axis=2, keepdims=True)
        moved = np.concatenate([X[:, None] + steps, X[:, None] - steps])
        return problem.limits.clip(moved.reshape(-1, problem.chain.n))

    def _aims(self, problem: IKProblem) -> list[IKProblem]:
        """The problem itself, and ones that aim at other targets within its tolerances."""
        if not problem.loose or len(problem.targets) > 1:
            return [problem]
        target = problem.targets[0]
        still, aims = np.zeros(3), [problem]
        offsets = [(shift, still) for shift in _off(target.position_tolerance)]
        offsets += [(still, turn) for turn in _off(target.orientation_tolerance)]
        for shift, turn in offsets:
            pose = target.pose * pin.SE3(pin.exp3(turn), shift)
            aim = replace(
                target,
                pose=pose,
                position_tolerance=_tight(target.position_tolerance),
                orientation_tolerance=_tight(target.orientation_tolerance),
            )
            aims.append(IKProblem.of(problem.chain, [aim, *problem.goals.each], problem.world))
        return aims

    def _add(self, i: int, aim: IKProblem, starts: Floats, room: int) -> None:
        """Add the solutions that these starts (s, n) lead to, if they are new, accepted, and there is room."""
        layer = self.found[i]
        if len(layer) >= room or not len(starts):
            return
        found = np.empty((room, aim.chain.n))
        found[: len(layer)] = layer
        new = found[len(layer) : self._gather(aim, starts, found, len(layer))]
        if self.problems[i].world is not None or aim is not self.problems[i]:
            self._take(i, new)
        else:
            self.found[i] = np.concatenate([layer, new])

    def _take(self, i: int, new: Floats) -> None:
        """Add those coordinates new (s, n) to a layer that are accepted."""
        problem, layer = self.problems[i], self.found[i]
        verdicts = [problem.verdict(q) for q in problem.chain.q(new, self.base)]
        touching = [x for x, verdict in zip(new, verdicts, strict=True) if verdict.collides]
        if touching and not len(layer):
            self.colliding.setdefault(i, touching[0])
        new = new[[verdict.accepted for verdict in verdicts]]
        if len(new):
            self.found[i] = np.concatenate([layer, new])
            self.colliding.pop(i, None)

    def _gather(self, aim: IKProblem, starts: Floats, found: Floats, known: int) -> int:
        """Write new solutions behind the ``known`` ones in ``found``; how many there are then."""
        solver = DEFAULT_SOLVER if self.solver is None else self.solver
        most = EVALUATIONS if self.solver is None else self.solver.budget.evaluations or EVALUATIONS
        _, taken, _ = solver.descent.gather(aim, starts, found, known, APART, len(starts) + 1, most, branch=False)
        return taken

    def _solve(self, i: int, solver: IKSolver, x: Floats) -> None:
        """Let the solver search for a pose that descents have not met."""
        problem = self.problems[i]
        q = problem.chain.q(x, self.base)
        result = solver.solve(problem, q, self.rng)
        if result.success:
            self.found[i] = result.x[None]


def _off(tolerance: Tolerance) -> list[Floats]:
    """Offsets (3,) from a middle, m or rad: each way along the axes that have a tolerance."""
    each = tolerance if isinstance(tolerance, tuple) else (tolerance,) * 3
    sizes = np.array([INSIDE * t if DEFAULT_TOLERANCE < t < FREE else 0.0 for t in each])
    return [sign * np.where(np.arange(3) == k, sizes, 0.0) for k in np.flatnonzero(sizes) for sign in (1.0, -1.0)]


def _tight(tolerance: Tolerance) -> Tolerance:
    """The same tolerance with the default one where it is larger and not free."""
    if isinstance(tolerance, tuple):
        x, y, z = (t if t == FREE else min(t, DEFAULT_TOLERANCE) for t in tolerance)
        return x, y, z
    return tolerance if tolerance == FREE else min(tolerance, DEFAULT_TOLERANCE)
