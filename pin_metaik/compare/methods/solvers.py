"""This library's solvers as methods: Jacobian methods, metaheuristics, hybrids of both, and the default."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.compare.methods.cost import evaluations_of, steps_within
from pin_metaik.compare.methods.counted import Counted
from pin_metaik.compare.methods.method import Answer
from pin_metaik.ik import IKProblem, IKResult, IKSolver, IKStatus, Refiner, solve_ik
from pin_metaik.ik.refine import make_refiner
from pin_metaik.ik.solver import ELITE
from pin_metaik.ik.state import SearchState
from pin_metaik.optimize import Budget, Metaheuristic, make, minimize
from pin_metaik.optimize.settings import whole


@checked
@dataclass(frozen=True)
class Search:
    """A method made of starts or a metaheuristic, and a refiner, combined by ``IKSolver``.

    Attributes:
        name: Name in tables.
        seeder: A metaheuristic, by name or as an object; ``None``: the given start, then random ones.
        refiner: A refiner, by name or as an object; ``None``: the metaheuristic's best is the answer.
        starts: How many starts without a seeder; ``None``: until the budget is spent.
    """

    name: str
    seeder: str | Metaheuristic | None = None
    refiner: str | Refiner | None = None
    starts: int | None = None

    @cached_property
    def solver(self) -> IKSolver:
        """The solver without its budget."""
        refiner = None if self.refiner is None else Counted(make_refiner(self.refiner))
        return IKSolver(self.seeder, refiner, starts=self.starts, trace=refiner is None)

    @checked
    def solve(self, problem: IKProblem, x0: NDArray[np.float64], budget: int, rng: np.random.Generator) -> Answer:
        """Search within the budget."""
        solver = replace(self.solver, budget=Budget(evaluations=budget))
        return answer(solver.search(problem, problem.chain.q(x0), rng))


@dataclass(frozen=True)
class Default:
    """``solve_ik`` as everybody calls it. All of its evaluations are priced as if they came with a Jacobian.

    Attributes:
        name: Name in tables.
        select: Which solution it shall give: see ``IKSolver``.
    """

    name: str
    select: str = "first"

    def solve(self, problem: IKProblem, x0: NDArray[np.float64], budget: int, rng: np.random.Generator) -> Answer:
        """Solve within the budget."""
        steps, chain = steps_within(budget), problem.chain
        if steps == 0:
            return Answer(x0, False, 0, str(IKStatus.OUT_OF_TOLERANCE))
        solver = IKSolver(budget=Budget(evaluations=steps), select=self.select)
        asked, x = list(problem.asked), chain.q(x0)
        found = answer(solve_ik(chain, asked, x, solver=solver, world=problem.world, rng=rng))
        return replace(found, evaluations=evaluations_of(found.evaluations or 0))


@dataclass(frozen=True)
class Rounds:
    """Short searches and refinements by turns: a metaheuristic spends a round, its best points are refined, and again.

    ``Search`` gives a metaheuristic a quarter of the remaining budget: much, where a refiner needs little.

    Attributes:
        name: Name in tables.
        seeder: A metaheuristic, by name or as an object.
        refiner: A refiner, by name or as an object.
        round: Kernel evaluations of one search.
    """

    name: str
    seeder: str | Metaheuristic
    refiner: str | Refiner
    round: int

    def __post_init__(self) -> None:
        """Raises UnknownName or InvalidSetting where the names or the round enter."""
        make(self.seeder)
        make_refiner(self.refiner)
        whole("round", self.round, 1)

    def solve(self, problem: IKProblem, x0: NDArray[np.float64], budget: int, rng: np.random.Generator) -> Answer:
        """Search within the budget."""
        refiner = Counted(make_refiner(self.refiner))
        state = SearchState(problem, Budget(evaluations=budget), perf_counter(), x0)
        seeds: NDArray[np.float64] | None = x0[None]
        while not state.over() and problem.gap == 0.0:
            allowed = Budget(evaluations=min(self.round, state.left()), target=problem.success_cost)
            found = minimize(problem.costs, problem.box, self.seeder, allowed, rng, seeds=seeds, keep=ELITE)
            state.add_search(found)
            if not state.over():
                state.add(refiner.refine(problem, found.elite, state.left()))
            seeds = None
        met = problem.accepts(problem.chain.q(state.x))
        return Answer(state.x, met, state.spent, str(IKStatus.SOLVED if met else state.status))


def answer(result: IKResult) -> Answer:
    """A result as an answer."""
    return Answer(result.x, result.success, result.evaluations, str(result.status), result.trace)
