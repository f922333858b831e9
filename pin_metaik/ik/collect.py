"""A search for all solutions of one target, and for what proves that there are no others."""

from __future__ import annotations

from itertools import count
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.dexterity import singular_values
from pin_metaik.ik.exclude import Exclusion
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine.descent import Descent
from pin_metaik.ik.singular import SINGULAR, Continua
from pin_metaik.ik.starts import drawn
from pin_metaik.ik.state import SearchState
from pin_metaik.kinematics.kernel.layout import SLACK, WEIGHT
from pin_metaik.kinematics.proofs.boxes import Boxes
from pin_metaik.optimize import Budget
from pin_metaik.randomness import Rng
from pin_metaik.watching import Progress, Stopped, Watch, tell

VAIN = 60  # consecutive starts without a new solution ...
VAIN_EACH = 15  # ... and as many more for each solution known, before a search for others ends
BATCH = 128  # starts between two looks at what came of them
IN_VAIN = 180_000  # evaluations without any solution after which a search for the first one ends
MIDDLE = 5000  # evaluations for a solution in the middle of loose tolerances before all of them is aimed at
ROOTS_SHARE = 0.5  # of the budget, to find all roots of six joints; what is left is to descend from them
ROOM = 0.1  # of the distance between distinct solutions: tolerances that may move a solution so far
HALF = 0.25  # of it: half width of the boxes that cover all configurations
COVERED = 16_384  # boxes that a cover may keep; more are a curve of solutions
AT_A_TIME = 50_000  # boxes between two looks at the clock and at what a watch says
FINEST, FINER = 1e-7, 20_000  # rad or m, boxes: how closely a kept box without a solution is looked at


def collect(
    problem: IKProblem,
    x0: Array,
    descent: Descent,
    rng: Rng,
    *,
    limit: int,
    apart: float,
    budget: Budget,
    certify: bool = True,
    watch: Watch | None = None,
) -> tuple[IKProblem, Array, Proof | None, int]:
    """Distinct solutions (s, n), what proves that they are all, and the evaluations spent.

    They are in the middle of the tolerances; if nothing is, anywhere in them, which is returned as the problem first.

    Raises:
        Stopped: The watch says so; its ``result`` is the solutions so far and the evaluations spent.
    """
    began, spent = perf_counter(), 0
    for aim in (problem, problem.whole):
        state = SearchState(aim, budget, began, x0)
        state.spent = spent
        collection = Collection(state, descent, rng, limit, apart, certify, watch)
        collection.run()
        spent = state.spent
        if collection.known or state.over():
            break
    return aim, collection.solutions, collection.complete, spent


class Collection:
    """The solutions of one problem, as they are found.

    Attributes:
        problem: What is searched for.
        state: What was spent of which budget, and what proves that there is nothing to be found.
        known: How many solutions there are so far.
        complete: What proves that there are no others, if anything does.
    """

    def __init__(
        self,
        state: SearchState,
        descent: Descent,
        rng: Rng,
        limit: int,
        apart: float,
        certify: bool = True,
        watch: Watch | None = None,
    ) -> None:
        """Begin with no solution, at the state's coordinates; a joint that does not matter stays where it has it.

        ``certify`` says whether boxes may be looked at to prove that nothing is missing.
        """
        self.problem, self.state = state.problem, state
        self.known = 0
        self.complete: Proof | None = None
        self._x0, self._descent, self._rng, self._apart, self._watch = state.x, descent, rng, apart, watch
        self._certify = certify
        self._found = np.empty((limit, state.problem.chain.n))
        self._vain = 0

    @property
    def solutions(self) -> Array:
        """(s, n) so far."""
        return self._found[: self.known]

    def run(self) -> None:
        """Search until there is a proof, nothing new appears, or there is no budget or room left."""
        problem, state = self.problem, self.state
        if problem.limits.rigid:
            self._add_from(problem.limits.lower[None], patience=1, branch=False)
            self.complete = Proof.LIMITS
            return
        self.complete = state.proof = problem.refuted
        if state.proof is not None:
            return
        formed = problem.form_branches
        if formed is not None and self._by_closed_form(formed.boxes):
            return
        whole = len(problem.targets) == 1 and all(problem.targets[0].counts) and not problem.goals
        if not (whole and self._by_roots()) or formed is not None:  # in a singularity, beside the roots
            self._by_descents()
        if whole and problem.chain.n <= problem.m and not problem.loose and self.complete is None:
            if self._certify:
                self._keep_exact()
            if not self._by_curves() and self._certify:
                known = self.known
                self._by_cover()
                if self.known > known:
                    if self.complete is None:
                        self._by_curves()
                    else:
                        self._told_apart()

    def _by_closed_form(self, whole: Array) -> bool:
        """Descend from the branches of the arm's closed form; whether that is all one can do.

        All of each branch that may meet the pose exactly is near to a solution in the end, or it is open whether there
        are more. Where none may, those are looked at that may do so within the tolerances, ``whole`` (b, 2 n). In a
        singularity solutions are curves, and branches no places to start from.
        """
        problem, proof, n = self.problem, self.problem.chain.form_proof, self.problem.chain.n
        assert proof is not None
        exact = proof.judge(problem.targets[0].pose.homogeneous, 0.0, 0.0).boxes
        starts = problem.branches(self._x0)
        hidden = (exact[:, n:] > 0.5 * self._apart).any()  # by rounding, so near to a singularity: how many there are
        if hidden and any(singular_values(problem.linearize(x)[1])[-1] < SINGULAR for x in starts):
            return False
        self._add_from(starts, len(starts) + 1, branch=False)
        if hidden:
            return False
        boxes = exact if len(exact) else whole
        missing = boxes[~self._near_solution(boxes)]
        self._add_from(problem.limits.clip(missing[:, :n]), len(missing) + 1, branch=False)
        if len(exact) and self._near_solution(exact).all() and not self._roomy:
            self.complete = Proof.CLOSED_FORM
        return self.known > 0

    def _by_roots(self) -> bool:
        """Descend from all real configurations of six coordinates; whether these are all, as far as can be told.

        Each of them that is inside the limits has its solution in the end, or it is open whether there are more.
        """
        problem = self.problem
        every = problem.chain._configurations(problem.targets[0].pose.homogeneous, self.state.left(ROOTS_SHARE))
        if every is None:
            return False
        self.state.spent += every.evaluations
        real, nearly = every.inside(problem.limits, self._x0)
        starts = np.concatenate([real, nearly])
        self._add_from(starts, len(starts) + 1, branch=False)
        met = self._near_solution(np.hstack([real, np.zeros_like(real)])).all()
        if every.proved and met and len(real) and not self._roomy:
            self.complete = Proof.COUNT
        return every.all and self.known > 0

    def _by_descents(self) -> None:
        """Descend from the nearest samples of the chain and from random configurations."""
        problem, state = self.problem, self.state
        exclusion = Exclusion(problem, self._descent)
        total = state.left()
        in_vain = MIDDLE if problem.loose else min(total - total // 10, IN_VAIN)
        for index in count():
            starts = drawn(problem.chain, self._rng, index, BATCH)
            if index == 0:
                starts = np.concatenate([self._x0[None], problem.near(BATCH), starts])
            if index:
                self._tell(total)
            enough = VAIN + VAIN_EACH * self.known
            self._add_from(starts, enough - self._vain)
            if not self.known:
                exclusion.go_on(state)
                if state.proof is not None:
                    self.complete = state.proof
                    return
                if state.met:
                    self._add_from(state.x[None], 1)
            enough = VAIN + VAIN_EACH * self.known
            hopeless = not self.known and state.searched >= in_vain
            if self.known == len(self._found) or state.left() == 0 or state.late() or self._vain >= enough or hopeless:
                return

    def _tell(self, total: int) -> None:
        """Say how many of the evaluations are spent.

        Raises:
            Stopped: The watch says so; its ``result`` is the solutions so far and the evaluations spent.
        """
        try:
            tell(self._watch, Progress(self.state.spent, total))
        except Stopped:
            raise Stopped((self.solutions, self.state.spent)) from None

    def _keep_exact(self) -> None:
        """Take solutions to the pose itself; what comes to the same was within the tolerances, near a singularity."""
        found, exact = self.solutions.copy(), self.problem.exact
        others, self.known = [], 0
        for x in found:
            spent, known, again = self._descent.gather(
                exact, x[None], self._found, self.known, self._apart, 2, self.state.left(), branch=False
            )
            self.state.spent += spent
            if known == self.known and not again:
                others.append(x)
            self.known = known
        for x in others:  # within the tolerances only, as beyond a limit by less than these
            if not self._near_solution(np.append(x, 0.0 * x)[None])[0] and self.known < len(self._found):
                self._found[self.known], self.known = x, self.known + 1

    def _by_curves(self) -> bool:
        """Whether solutions are curves, in a singularity: of each one point is kept, the nearest to where it began.

        Descents go on until those that come to no known curve come to nothing new. It is not proved that these are all.
        """
        exact, state = self.problem.exact, self.state
        every, vain = self._told_apart(), 0
        if not every.curves:
            return False
        for index in count():
            enough = VAIN + VAIN_EACH * (len(every.separate) + len(every.curves))
            if vain >= enough or state.left() == 0 or state.late():
                break
            starts = drawn(exact.chain, self._rng, index, BATCH)
            found = np.empty((len(self._found), exact.chain.n))
            spent, known, _ = self._descent.gather(
                exact, starts, found, 0, self._apart, len(starts), state.left(), branch=False
            )
            state.spent += spent
            vain = 0 if every.add(found[:known]) else vain + len(starts)
        self._keep(every.nearest(self._x0))
        return True

    def _told_apart(self) -> Continua:
        """The solutions, without those to which a motion within the tolerances leads from another one."""
        every = Continua(self.problem, self._apart)
        every.add(self.solutions.copy())
        self._keep(every.nearest(self._x0))
        return every

    def _keep(self, X: Array) -> None:
        """Let solutions X (k, n) be those that are known, as many as there is room for."""
        self.known = min(len(X), len(self._found))
        self._found[: self.known] = X[: self.known]

    def _by_cover(self) -> None:
        """Cover all configurations with boxes, and look for a solution in each that is kept."""
        problem, n, half = self.problem, self.problem.chain.n, HALF * self._apart
        pose = problem.targets[0].pose.homogeneous
        if self.known == len(self._found):
            return
        nominal = problem.chain.nominal_proof
        begin = None if nominal is None else nominal.judge(pose, 0.0, 0.0).pieces
        boxes = problem.chain._boxes(0, pose, 0.0, 0.0, least=half, shrink=True, begin=begin)
        if boxes is None:
            return
        kept, total = np.empty((0, 2 * n)), self.state.spent + self.state.left_for_boxes
        while not boxes.done and len(kept) < COVERED and self.state.left_for_boxes and not self.state.late():
            looked = boxes.looked
            more = boxes.look(min(AT_A_TIME, self.state.left_for_boxes), COVERED - len(kept))
            kept = np.concatenate([kept, more])
            self.state.add_boxes(boxes.looked - looked)
            if not boxes.done:
                self._tell(total)
        if not boxes.done:
            return
        kept, known = kept[~self._near_solution(kept)], self.known
        self._add_from(problem.limits.clip(kept[:, :n]), len(kept) + 1, branch=False)
        if self.known > known:
            self._keep_exact()
        if self._are_clear(boxes, kept[~self._near_solution(kept)]):
            self.complete = Proof.BOXES

    def _are_clear(self, boxes: Boxes, kept: Array) -> bool:
        """Whether boxes (k, 2 n) that were kept hold nothing distinct from the solutions, when looked at closely."""
        for box in kept:
            part = boxes.within(box, FINEST)
            small = part.look(min(FINER, self.state.left_for_boxes), COVERED)
            self.state.add_boxes(part.looked)
            if not part.done or not self._near_solution(small).all():
                return False
        return True

    def _add_from(self, starts: Array, patience: int, *, branch: bool = True) -> None:
        """Descend from each of the starts (s, n), until ``patience`` in a row led to nothing new."""
        if not len(starts):
            return
        state = self.state
        spent, known, row = self._descent.gather(
            self.problem, starts, self._found, self.known, self._apart, patience, state.left(), branch=branch
        )
        self._vain = self._vain + row if known == self.known else row
        self.known, state.spent = known, state.spent + spent

    @property
    def _roomy(self) -> bool:
        """Whether the tolerances leave room for solutions as far apart as distinct ones: then there is no end."""
        slack = self.problem.whole.records[:, SLACK:WEIGHT]
        return bool((np.abs(slack[np.isfinite(slack)]) > ROOM * self._apart).any())

    def _near_solution(self, boxes: Array) -> NDArray[np.bool_]:
        """(b,) whether all of each box (b, 2 n) is so near to a solution that nothing in it is distinct from that."""
        n = self.problem.chain.n
        ways = self.problem.limits.separation(boxes[:, None, :n], self.solutions) + boxes[:, None, n:]
        near: NDArray[np.bool_] = np.all(ways <= self._apart, axis=2).any(axis=1)
        return near
