"""Global inverse kinematics: starts or a metaheuristic find the region, a refiner the solution, Pinocchio judges."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import islice
from time import perf_counter
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked, instance
from pin_metaik.errors import InvalidBudget, InvalidSetting, UnknownName
from pin_metaik.ik.collect import collect
from pin_metaik.ik.exclude import FAR, FIRST, LONG, Exclusion
from pin_metaik.ik.ledger import ENDLESS, Ledger
from pin_metaik.ik.nullspace import slide
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine import DLS, Refinement, Refiner, make_refiner
from pin_metaik.ik.refine.dls import PROGRESS
from pin_metaik.ik.result import IKResult, IKStatus
from pin_metaik.ik.select import SELECT
from pin_metaik.ik.starts import start_batches
from pin_metaik.ik.target import DEFAULT_TOLERANCE
from pin_metaik.optimize import Budget, Metaheuristic, make, minimize
from pin_metaik.optimize.settings import whole
from pin_metaik.randomness import Rng, as_generator

Refine: TypeAlias = Callable[[IKProblem, NDArray[np.float64], int], Refinement]

EVALUATIONS = 250_000  # of a search and its boxes, by default
ELITE = 8  # points of a seeder's search that are refined
SEEDER_SHARE = 0.25  # of the budget, for one round of the seeder before its elite is refined
RESTART_SHARE = 0.8  # of a search, for restarts before the automatic solver turns to a seeder
FALLBACK = "mtde"  # ... which is this one
CHOICE, CHOICE_SHARE = 64, 0.5  # solutions to choose from at most, and the share of the budget to find them
RESERVE = 0.05  # of the budget, to settle down at the nearest pose when none is near enough


@checked
@dataclass(frozen=True)
class IKSolver:
    """How to search: where starts come from, what refines them, and how much may be spent.

    ``IKSolver()`` is what to use without thinking: damped least squares from ``q0`` and then from random starts, by
    turns with boxes that prove that there is nothing to be found, and in the end metaheuristic seeds. Others prove
    nothing but what the links' span does. ``IKSolver(seeder=None, starts=1)`` is the classical
    Jacobian method, ``IKSolver("gwo", None)`` the pure metaheuristic, ``IKSolver("gwo", "dls")`` the hybrid.

    Attributes:
        seeder: ``"auto"``, a metaheuristic's name or object, or ``None``: ``q0`` and random starts only.
        refiner: A refiner's name or object, or ``None``: the seeder's best is the answer.
        budget: Evaluations are forward kinematics, one a configuration (a refiner's step is one, its Jacobian comes
            with it), and boxes of configurations, which take about as long. A budget in seconds is looked at every few
            milliseconds, and not reproducible. ``target`` is the cost at which a pure metaheuristic stops; by default
            it stops once the tolerances are met.
        starts: How many starts to refine without a seeder; ``None``: until the budget is spent.
        select: ``"first"`` solution found, or of all distinct ones that the budget allows to find, the ``"nearest"`` to
            ``q0``, the one of best ``"manipulability"``, or the one that keeps farthest from the ``"limits"``.
        trace: Whether to keep the seeder's convergence.
        patience: Evaluations after which the automatic search ends although nothing is proved, or a tenth of the
            budget, if that is more; the rest of the budget is for boxes (see ``Proof``). Of 13.7 million targets with a
            solution none needed more than 25,000; 3,000 miss 1 of 2,500,000 random ones, and 2 of 10,000 singular ones.
    """

    seeder: str | Metaheuristic | None = "auto"
    refiner: str | Refiner | None = "dls"
    budget: Budget = field(default=Budget(evaluations=EVALUATIONS))
    starts: int | None = None
    select: str = "first"
    trace: bool = False
    patience: int = 25_000
    _seeder: Metaheuristic | None = field(init=False, repr=False)
    _refiner: Refiner | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check names and settings where they enter.

        Raises:
            UnknownName: No metaheuristic or refiner of that name.
            InvalidSetting: Neither a seeder nor a refiner, or fewer than one start.
            InvalidBudget: A budget that never ends.
        """
        seeder = None if self.seeder is None else make(FALLBACK if self.seeder == "auto" else self.seeder)
        refiner = None if self.refiner is None else make_refiner(self.refiner)
        if refiner is None and (seeder is None or self.seeder == "auto"):
            raise InvalidSetting("without a refiner name a seeder, e.g. IKSolver('gwo', None)")
        object.__setattr__(self, "_seeder", seeder)
        object.__setattr__(self, "_refiner", refiner)
        if self.select != "first" and self.select not in SELECT:
            raise UnknownName("selection", self.select, {"first", *SELECT})
        if self.starts is not None and self.starts < 1:
            raise InvalidSetting(f"starts is at least 1 or None, got {self.starts}")
        whole("patience", self.patience, 1)
        if not self.budget.ends:
            raise InvalidBudget("this search might never end: give the budget evaluations=... or seconds=...")

    def solve(
        self, problem: IKProblem, q0: ArrayLike | None = None, rng: Rng = None, *, first: Refinement | None = None
    ) -> IKResult:
        """Search until the targets are met or the budget is spent; see ``solve_ik`` for the arguments.

        ``first`` is what the pose solver came to, if it has tried the first starts already.
        """
        began = perf_counter()
        instance(IKProblem, problem=problem)
        if first is not None:
            instance(Refinement, first=first)
        if q0 is not None:
            problem = problem.at(q0)
        chain = problem.chain
        base = chain.reference if q0 is None else chain.configuration(q0)
        x0 = chain.x(base)
        aim = problem.whole if problem.loose else problem
        ledger = Ledger(aim, self.budget, began, x0, self._most if self._decides else None)
        exclusion = None
        if self._decides and self._refiner is not None:
            ledger.proof = problem.refuted
            exclusion = Exclusion(problem, self._refiner) if ledger.proof is None else None
        if first is not None:
            ledger.add(first)
        if chain.limits.rigid:  # there is nothing to search: it stands where it stands
            ledger.x, ledger.spent = chain.limits.lower, 1
        if self.select != "first" and not ledger.over():
            self._choose(problem, x0, base, rng, ledger)
        if self._refiner is not None and (self.seeder is None or self.seeder == "auto") and not ledger.over():
            self._restart(problem, self._refiner, x0, rng, ledger, exclusion, tried=0 if first is None else 1)
        if self._seeder is not None and not ledger.over():
            self._seed(problem, self._seeder, None if q0 is None else x0[None], rng, ledger)
        if exclusion is not None and not ledger.decided:
            exclusion.finish(ledger)
        if isinstance(self._refiner, DLS) and not ledger.met and self.starts is None and not chain.limits.rigid:
            ledger.add(self._refiner.settle(ledger.problem, ledger.x, ledger.left()))
        q = base.copy()
        chain.coordinates.write(ledger.x, q)
        verdict = problem.verdict(q)
        status = IKStatus.SOLVED if verdict.accepted else IKStatus.IN_COLLISION if verdict.collides else ledger.status
        return IKResult(
            q=q,
            status=status,
            position_error=verdict.position_error,
            orientation_error=verdict.orientation_error,
            evaluations=ledger.spent,
            seconds=perf_counter() - began,
            chain=chain,
            given=problem.targets,
            trace=np.concatenate(ledger.traces) if ledger.traces else None,
            world=problem.world,
            proof=None if verdict.accepted or verdict.collides else ledger.proof,
            contacts=problem.world.checker.contacts(q) if verdict.collides and problem.world else (),
        )

    def _choose(
        self, problem: IKProblem, x0: NDArray[np.float64], base: NDArray[np.float64], rng: Rng, ledger: Ledger
    ) -> None:
        """Collect distinct solutions and take the best by the chosen measure; on a redundant chain, improve it.

        In a world, colliding solutions are discarded, and so is a null-space improvement that collides.
        """
        measure = SELECT[self.select]
        budget = Budget(evaluations=max(1, ledger.left(CHOICE_SHARE)), seconds=self.budget.seconds)
        problem, found, complete, spent = collect(problem, x0, rng, limit=CHOICE, apart=1e-2, budget=budget)
        ledger.spent += spent
        if not len(found) and self._decides:
            ledger.proof = complete
        if problem.world is not None:
            found = found[[problem.accepts(q) for q in problem.chain.q(found, base)]]
        if len(found):
            found = problem.limits.nearest_turns(found, x0)
            best = found[np.argmin(measure(problem, found, x0))]
            better = slide(problem, best, x0, measure)
            kept = problem.world is None or problem.accepts(problem.chain.q(better, base))
            ledger.x, ledger.met = better if kept else best, True

    @property
    def descends(self) -> Refiner:
        """What leads from a start to a solution nearby: its refiner; of a pure metaheuristic damped least squares."""
        return DLS() if self._refiner is None else self._refiner

    @property
    def _decides(self) -> bool:
        """Whether boxes take their turns with the search: they do in the automatic solver's."""
        return self.seeder == "auto" and self._refiner is not None

    @property
    def _most(self) -> int | None:
        """Evaluations that a search with boxes by turns may take."""
        total = self.budget.evaluations
        return None if total is None else max(self.patience, total // 10)

    @cached_property
    def kernel_settings(self) -> NDArray[np.float64] | None:
        """Settings (9,) of the pose solver, with the default tolerances, if it can take this solver's first step.

        That is the automatic solver's: it restarts its refiner until a share of the budget is spent.
        """
        dls, evaluations = self._refiner, self.budget.evaluations
        automatic = self.seeder == "auto" and self.select == "first" and self.budget.seconds is None
        if not automatic or not isinstance(dls, DLS):
            return None
        most = ENDLESS if evaluations is None else math.ceil(RESTART_SHARE * evaluations)
        first, few = float(min(LONG, most)), float(min(FIRST, most))
        tolerance = DEFAULT_TOLERANCE
        return np.array([dls.damping, PROGRESS, dls.iterations, first, tolerance, tolerance, first, few, FAR**2])

    def _restart(
        self,
        problem: IKProblem,
        refiner: Refiner,
        x0: NDArray[np.float64],
        rng: Rng,
        ledger: Ledger,
        exclusion: Exclusion | None,
        tried: int,
    ) -> None:
        """Refine from x0 (n,), then from random starts; ``tried`` says that the first batch of them has been.

        The middle of the tolerances is tried first. Where they are loose, all further batches aim at all that is
        accepted; where they are not, a last one does.
        """
        share = 1.0 - RESERVE if self._seeder is None else RESTART_SHARE
        batches = partial(start_batches, problem.chain, x0, rng, self.starts)
        anywhere = refiner.refine
        if self._seeder is not None and isinstance(refiner, DLS):
            anywhere = refiner.refine_anywhere

        def refine(aim: IKProblem, first: Refine, batches: Iterator[NDArray[np.float64]], share: float) -> None:
            for starts in batches:
                if exclusion is not None:
                    exclusion.go_on(ledger)
                    if ledger.over(share):
                        return
                before = ledger.spent
                ledger.add(first(aim, starts, ledger.left(share)))
                if ledger.over(share) or ledger.spent == before:
                    return
                first = refiner.refine

        if problem.loose:
            if not tried:
                refine(problem, anywhere, islice(batches(), 1), share)
            if not ledger.over(share):
                refine(problem.whole, anywhere, batches(), share)
            return
        if not tried or not ledger.over(share):
            refine(problem, refiner.refine if tried else anywhere, batches(tried), share)
        if not ledger.met and self.starts is None and not ledger.over(share + RESERVE):  # no start counts twice
            refine(problem.whole, anywhere, islice(batches(), 1), share + RESERVE)

    def _seed(
        self,
        problem: IKProblem,
        seeder: Metaheuristic,
        seeds: NDArray[np.float64] | None,
        rng: Rng,
        ledger: Ledger,
    ) -> None:
        """Search with the metaheuristic; with a refiner in rounds, each refining the elite of its search."""
        generator = as_generator(rng)
        share = 1.0 if self._refiner is None else SEEDER_SHARE
        while True:
            budget = ledger.slice(share)
            found = minimize(
                ledger.problem.costs, problem.box, seeder, budget, generator, seeds=seeds, trace=self.trace, keep=ELITE
            )
            ledger.add_search(found)
            if self._refiner is None:
                return
            ledger.add(self._refiner.refine(ledger.problem, found.elite, ledger.left(1.0 - RESERVE)))
            if ledger.over(1.0 - RESERVE):
                return
            seeds = None


DEFAULT_SOLVER = IKSolver()
