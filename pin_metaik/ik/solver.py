"""Global inverse kinematics: starts or a metaheuristic find the region, a refiner the solution, Pinocchio judges."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import islice
from time import perf_counter
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked, instance
from pin_metaik.errors import InvalidBudget, InvalidSetting
from pin_metaik.ik.clearance import keep_clear
from pin_metaik.ik.collect import collect
from pin_metaik.ik.criteria import Measure, Selection, measure_of, slide, turned, wished, world_of
from pin_metaik.ik.exclude import FAR, FIRST, LONG, Exclusion
from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE
from pin_metaik.ik.plain_pose import solve_plain
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine import DLS, Refinement, Refiner, make_refiner
from pin_metaik.ik.refine.descent import Descent, descent_of
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.self_motion.motions import RESOLUTION, find_self_motions, has_curves
from pin_metaik.ik.starts import start_batches
from pin_metaik.ik.state import SearchState
from pin_metaik.kinematics.roots.real import UNBOUNDED
from pin_metaik.optimize import Budget, Metaheuristic, make, minimize
from pin_metaik.optimize.settings import whole
from pin_metaik.randomness import Rng, as_generator, as_seed

Refine: TypeAlias = Callable[[IKProblem, NDArray[np.float64], int], Refinement]

EVALUATIONS = 250_000  # of a search and its boxes, by default
ELITE = 8  # points of a seeder's search that are refined
SEEDER_SHARE = 0.25  # of the budget, for one round of the seeder before its elite is refined
RESTART_SHARE = 0.8  # of a search, for restarts before the automatic solver turns to a seeder
FALLBACK = "mtde"  # ... which is this one
CHOICE, CHOICE_SHARE = 64, 0.5  # solutions to choose from at most, and the share of the budget to find them
CURVES, STEP_OF_CURVE = 1_000, 64  # evaluations: curves are not looked for with fewer; the last step may take these
APART = 1e-2  # rad or m by which some coordinate of two of them differs
RESERVE = 0.05  # of the budget, to settle down at the nearest pose when none is near enough


@checked
@dataclass(frozen=True)
class IKSolver:
    """How to search: where starts come from, which refiner improves them, and the budget.

    ``IKSolver()``, the default, suits most uses: damped least squares from ``q0`` and then from random starts,
    alternating with a search that excludes boxes of configurations to prove that no solution exists, and at the end
    from seeds of a metaheuristic. Other seeders prove unreachability only by the lengths of the links.
    ``IKSolver(seeder=None, starts=1)`` is the classical Jacobian method, ``IKSolver("gwo", None)`` the pure
    metaheuristic, ``IKSolver("gwo", "dls")`` the hybrid.

    Attributes:
        seeder: ``"auto"``, a metaheuristic's name or object, or ``None``: ``q0`` and random starts only.
        refiner: A refiner's name or object, or ``None``: the seeder's best is the answer.
        budget: An evaluation is one forward kinematics (a step of a refiner, with its Jacobian, is one) or one box of
            configurations, which takes about as long. A budget in seconds is checked every few milliseconds; its
            results are not reproducible. ``target`` is the cost at which a pure metaheuristic stops; by default it
            stops once the tolerances are met.
        starts: How many starts to refine without a seeder; ``None``: until the budget is spent.
        select: The ``"first"`` solution found, or the best of all distinct solutions that the budget allows to find:
            the ``"nearest"`` to ``q0``, the one of greatest ``"manipulability"``, the one farthest from the
            ``"limits"``, the one that needs the least ``"torque"`` against gravity, the one with the most
            ``"clearance"`` in its world, or the one for which your own function of a configuration q (nq,) gives the
            lowest number. ``Weighted("nearest", {"elbow_joint": 3.0})`` weights joints differently. With one spare
            joint and no world it is the best point of all self-motions, if ``self_motions`` proves that it has found
            them all.
        trace: Whether to keep the convergence of the seeder in ``IKResult.trace``.
        patience: Evaluations after which the automatic search for a solution ends without a proof (or a tenth of the
            budget, if that is more); the rest of the budget is for boxes (see ``Proof``). Of 13.7 million targets with
            a solution none needed more than 25,000; 3,000 miss 1 of 2,500,000 random ones, and 2 of 10,000 singular
            ones.
    """

    seeder: str | Metaheuristic | None = "auto"
    refiner: str | Refiner | None = "dls"
    budget: Budget = field(default=Budget(evaluations=EVALUATIONS))
    starts: int | None = None
    select: Selection = "first"
    trace: bool = False
    patience: int = 25_000
    _seeder: Metaheuristic | None = field(init=False, repr=False)
    _descent: Descent | None = field(init=False, repr=False)
    _measure: Measure | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check names and settings where they enter.

        Raises:
            UnknownName: No metaheuristic, refiner or criterion of that name.
            InvalidSetting: Neither a seeder nor a refiner, a choice without a refiner, or fewer than one start.
            InvalidBudget: A budget that never ends.
        """
        seeder = None if self.seeder is None else make(FALLBACK if self.seeder == "auto" else self.seeder)
        descent = None if self.refiner is None else descent_of(make_refiner(self.refiner))
        measure = None if self.select == "first" else measure_of(self.select)
        if descent is None and (seeder is None or self.seeder == "auto"):
            raise InvalidSetting("without a refiner name a seeder, e.g. IKSolver('gwo', None)")
        if descent is None and measure is not None:
            raise InvalidSetting("select needs a refiner, e.g. IKSolver('gwo', 'dls', select=...)")
        object.__setattr__(self, "_seeder", seeder)
        object.__setattr__(self, "_descent", descent)
        object.__setattr__(self, "_measure", measure)
        if self.starts is not None and self.starts < 1:
            raise InvalidSetting(f"starts is at least 1 or None, got {self.starts}")
        whole("patience", self.patience, 1)
        if not self.budget.ends:
            raise InvalidBudget("this search might never end: give the budget evaluations=... or seconds=...")

    @property
    def descent(self) -> Descent:
        """The compiled loops of its refiner; those of damped least squares if it has no refiner."""
        return DLS().descent() if self._descent is None else self._descent

    @checked
    def solve(self, problem: IKProblem, q0: ArrayLike | None = None, rng: Rng = None) -> IKResult:
        """Solve a problem, in its world if it has one, as ``solve_ik`` does; see there for arguments and errors."""
        problem, seed = problem if q0 is None else problem.at(q0), as_seed(rng)
        first = None
        if len(problem.targets) == 1 and not problem.goals and not problem.wishes:
            first = solve_plain(problem.chain, problem.targets[0], q0, self.kernel_settings, seed)
        return self._finish(problem, first, q0, seed)

    def _finish(
        self, problem: IKProblem, first: IKResult | Refinement | None, q0: ArrayLike | None, seed: int | None
    ) -> IKResult:
        """The result of a problem from what ``solve_plain`` came to: search what it left, then keep clear."""
        if isinstance(first, IKResult):
            result = first
        else:  # a choice is made among the solutions that are clear; the first one is cleared
            aim = replace(problem, world=None) if self._measure_for(problem) is None else problem
            result = self.search(aim, q0, seed, first=first)
        if problem.world is None:
            return result
        base = problem.chain.reference if q0 is None else problem.chain.configuration(q0)
        seeder = make(FALLBACK) if self._seeder is None else self._seeder
        return keep_clear(result, problem, base, descent=self.descent, seeder=seeder, budget=self.budget, rng=seed)

    def search(
        self, problem: IKProblem, q0: ArrayLike | None = None, rng: Rng = None, *, first: Refinement | None = None
    ) -> IKResult:
        """Search until the targets are met or the budget is spent.

        This is the search alone, which ``compare`` uses: it also ends with a solution that collides in the problem's
        world.

        Args:
            problem: What is searched for.
            q0: (nq,) configuration to start from; see ``solve_ik``.
            rng: Seed or generator; a generator is drawn from for every start.
            first: The best result of the pose solver, if that has already tried the first starts.

        Raises:
            InvalidSetting: If there are wishes, but no refiner to improve them.
        """
        began = perf_counter()
        instance(IKProblem, problem=problem)
        if first is not None:
            instance(Refinement, first=first)
        if self._descent is None and problem.wishes:
            raise InvalidSetting("wishes need a refiner, e.g. IKSolver('gwo', 'dls')")
        if self.select == "clearance":
            world_of(problem)
        if q0 is not None:
            problem = problem.at(q0)
        chain = problem.chain
        base = chain.reference if q0 is None else chain.configuration(q0)
        x0 = chain.x(base)
        aim = problem.whole if problem.loose else problem
        state = SearchState(aim, self.budget, began, x0, self._most if self._decides else None)
        exclusion = None
        if self._decides and self._descent is not None:
            state.proof = problem.refuted
            exclusion = Exclusion(problem, self._descent) if state.proof is None else None
        if first is not None:
            state.add(first)
        if chain.limits.rigid:  # there is nothing to search: it stands where it stands
            state.x, state.spent = chain.limits.lower, 1
        measure = self._measure_for(problem)
        if measure is not None and not state.over():
            self._choose(problem, measure, base, rng, state)
        if self._descent is not None and (self.seeder is None or self.seeder == "auto") and not state.over():
            self._restart(problem, self._descent, x0, rng, state, exclusion, tried=0 if first is None else 1)
        if self._seeder is not None and not state.over():
            self._seed(problem, self._seeder, None if q0 is None else x0[None], rng, state)
        if exclusion is not None and not state.decided:
            exclusion.finish(state)
        if self._descent is not None and not state.met and self.starts is None and not chain.limits.rigid:
            state.add(self._descent.settle(state.problem, state.x, state.left()))
        q = base.copy()
        chain.coordinates.write(state.x, q)
        verdict = problem.verdict(q)
        status = IKStatus.SOLVED if verdict.accepted else IKStatus.IN_COLLISION if verdict.collides else state.status
        return IKResult(
            q=q,
            status=status,
            position_error=verdict.position_error,
            orientation_error=verdict.orientation_error,
            evaluations=state.spent,
            seconds=perf_counter() - began,
            chain=chain,
            given=problem.asked,
            trace=np.concatenate(state.traces) if state.traces else None,
            world=problem.world,
            proof=None if verdict.accepted or verdict.collides else state.proof,
            contacts=problem.world.checker.contacts(q) if verdict.collides and problem.world else (),
        )

    def _choose(
        self, problem: IKProblem, measure: Measure, base: NDArray[np.float64], rng: Rng, state: SearchState
    ) -> None:
        """Collect distinct solutions and take the best by a measure; on a redundant chain, improve it.

        Wishes are improved last. In a world, colliding solutions are discarded, and so is a null-space improvement that
        collides.
        """
        x0 = problem.chain.x(base)
        budget = Budget(evaluations=max(1, state.left(CHOICE_SHARE)), seconds=self.budget.seconds)
        if self._has_curves(problem) and budget.evaluations is not None and budget.evaluations > CURVES:
            allowed = replace(budget, evaluations=budget.evaluations - STEP_OF_CURVE)
            motions = find_self_motions(problem.exact, base, RESOLUTION, allowed)
            state.spent += motions.evaluations
            if motions.complete is not None and len(motions):
                state.x, state.met = problem.chain.x(motions.best(self.select).q), True
                return
        problem, found, complete, spent = collect(
            problem, x0, self.descent, rng, limit=CHOICE, apart=APART, budget=budget
        )
        state.spent += spent
        if not len(found) and self._decides:
            state.proof = complete
        if problem.world is not None:
            found = found[[problem.accepts(q) for q in problem.chain.q(found, base)]]
        if len(found):
            found = problem.nearest_turns(found, x0)
            if problem.wishes:
                found = np.array([turned(problem, x, x0, wished) for x in found])
            best = found[np.argmin(measure(problem, found, x0))]
            better = slide(problem, best, x0, wished if problem.wishes else measure, self.descent)
            kept = problem.accepts(problem.chain.q(better, base))
            state.x, state.met = better if kept else best, True

    def _has_curves(self, problem: IKProblem) -> bool:
        """Whether a choice is made among curves of solutions: nothing else counts, and compiled loops follow them."""
        compiled = self.descent.settings(0.0) is not None
        return compiled and problem.world is None and not problem.wishes and has_curves(problem)

    def _measure_for(self, problem: IKProblem) -> Measure | None:
        """What chooses among the solutions of a problem, if anything does: ``select``, or else the wishes."""
        return wished if self._measure is None and problem.wishes else self._measure

    @property
    def _decides(self) -> bool:
        """Whether boxes take their turns with the search: they do in the automatic solver's."""
        return self.seeder == "auto" and self._descent is not None

    @property
    def _most(self) -> int | None:
        """Evaluations that a search with boxes by turns may take."""
        total = self.budget.evaluations
        return None if total is None else max(self.patience, total // 10)

    @cached_property
    def kernel_settings(self) -> NDArray[np.float64] | None:
        """Settings (9,) of the compiled pose solver, with the default tolerances; None if it cannot begin this search.

        That is the automatic solver's: it restarts its refiner until a share of the budget is spent.
        """
        evaluations = self.budget.evaluations
        automatic = self.seeder == "auto" and self._measure is None and self.budget.seconds is None
        if not automatic or self._descent is None:
            return None
        most = UNBOUNDED if evaluations is None else math.ceil(RESTART_SHARE * evaluations)
        first, few = float(min(LONG, most)), float(min(FIRST, most))
        settings = self._descent.settings(first)
        tolerances = [DEFAULT_TOLERANCE, DEFAULT_TOLERANCE]
        return None if settings is None else np.concatenate([settings, tolerances, [first, few, FAR**2]])

    def _restart(
        self,
        problem: IKProblem,
        descent: Descent,
        x0: NDArray[np.float64],
        rng: Rng,
        state: SearchState,
        exclusion: Exclusion | None,
        tried: int,
    ) -> None:
        """Refine from x0 (n,), then from random starts; ``tried`` says that the first batch of them has been.

        The middle of the tolerances is tried first. Where they are loose, all further batches aim at all that is
        accepted; where they are not, a descent from the best of each batch does, and a last batch.
        """
        share = 1.0 - RESERVE if self._seeder is None else RESTART_SHARE
        batches = partial(start_batches, problem.chain, x0, rng, self.starts)
        anywhere = descent.refine if self._seeder is None else descent.refine_anywhere

        def refine(aim: IKProblem, first: Refine, batches: Iterator[NDArray[np.float64]], share: float) -> None:
            for starts in batches:
                if exclusion is not None:
                    exclusion.go_on(state)
                    if state.over(share):
                        return
                before = state.spent
                state.add(first(aim, starts, state.left(share)))
                if aim is problem and self.starts is None and not state.over(share):  # next to the best compromise
                    state.add(descent.refine(problem.whole, state.x[None], state.left(share)))
                if state.over(share) or state.spent == before:
                    return
                first = descent.refine

        if problem.loose:
            if not tried:
                refine(problem, anywhere, islice(batches(), 1), share)
            if not state.over(share):
                refine(problem.whole, anywhere, batches(), share)
            return
        if not tried or not state.over(share):
            refine(problem, descent.refine if tried else anywhere, batches(tried), share)
        if not state.met and self.starts is None and not state.over(share + RESERVE):  # no start counts twice
            refine(problem.whole, anywhere, islice(batches(), 1), share + RESERVE)

    def _seed(
        self,
        problem: IKProblem,
        seeder: Metaheuristic,
        seeds: NDArray[np.float64] | None,
        rng: Rng,
        state: SearchState,
    ) -> None:
        """Search with the metaheuristic; with a refiner in rounds, each refining the elite of its search."""
        generator = as_generator(rng)
        share = 1.0 if self._descent is None else SEEDER_SHARE
        while True:
            budget = state.slice(share)
            found = minimize(
                state.problem.costs, problem.box, seeder, budget, generator, seeds=seeds, trace=self.trace, keep=ELITE
            )
            state.add_search(found)
            if self._descent is None:
                return
            state.add(self._descent.refine(state.problem, found.elite, state.left(1.0 - RESERVE)))
            if state.over(1.0 - RESERVE):
                return
            seeds = None


DEFAULT_SOLVER = IKSolver()
