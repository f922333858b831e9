"""Common parts of the arm papers: a case to solve, and the jobs that try a method on it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from time import process_time

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.papers.paper import Job
from pin_metaik.ik import IKProblem, IKSolver
from pin_metaik.optimize import Budget, Metaheuristic, minimize

TRACE_POINTS = 200


@dataclass(frozen=True, eq=False)
class ArmCase:
    """One target of a paper.

    Attributes:
        name: Name in tables.
        problem: The target for a refiner, and the box to search.
        objective: The paper's costs (k,) of joint angles X (k, n), in its units.
    """

    name: str
    problem: IKProblem
    objective: Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class ArmTrial:
    """One run of one method on one case.

    Attributes:
        case: Name of the case.
        method: Name of the method.
        budget: Evaluations that were allowed.
        run: Number of the run, from 0.
        cost: The paper's objective at its answer, in the paper's units.
        x: Its answer, joint angles (n,) in rad.
        evaluations: Evaluations it spent.
        seconds: Processor time it took, in s: what a run takes on a machine that does nothing else.
        trace: (g, 2) evaluations and best cost so far, thinned; None for hybrids.
    """

    case: str
    method: str
    budget: int
    run: int
    cost: float
    x: Array
    evaluations: int
    seconds: float
    trace: Array | None = None


def search(
    case: ArmCase, method: str, algorithm: Metaheuristic, budget: int, run: int, rng: np.random.Generator
) -> Job[ArmTrial]:
    """The metaheuristic alone, on the paper's objective."""

    def work() -> ArmTrial:
        began = process_time()
        found = minimize(case.objective, case.problem.box, algorithm, Budget(evaluations=budget), rng, trace=True)
        seconds = process_time() - began
        trace = thinned(found.trace) if found.trace is not None else None
        return ArmTrial(case.name, method, budget, run, found.cost, found.x, found.evaluations, seconds, trace)

    return Job(_label(case, method, budget, run), work, budget)


def hybrid(
    case: ArmCase, method: str, seeder: Metaheuristic, budget: int, run: int, rng: np.random.Generator
) -> Job[ArmTrial]:
    """The metaheuristic as a seeder and damped least squares after it, until solved or the budget is spent."""
    solver = IKSolver(seeder, "dls", Budget(evaluations=budget))

    def work() -> ArmTrial:
        began = process_time()
        result = solver.search(case.problem, rng=rng)
        seconds = process_time() - began
        cost = float(case.objective(result.x[None])[0])
        return ArmTrial(case.name, refined(method), budget, run, cost, result.x, result.evaluations, seconds)

    return Job(_label(case, refined(method), budget, run), work, budget)


def refined(method: str) -> str:
    """Name of a method followed by damped least squares."""
    return f"{method} + DLS"


def thinned(trace: Array) -> Array:
    """A trace (g, 2) at evaluations spaced as on a logarithmic axis, the same for runs of the same batches."""
    first, last = trace[[0, -1], 0]
    at = np.unique(np.geomspace(first, last, TRACE_POINTS).round())
    return np.column_stack((at, trace[np.searchsorted(trace[:, 0], at, side="right") - 1, 1]))


def trials_of(
    trials: Iterable[ArmTrial], *, case: str | None = None, method: str | None = None, budget: int | None = None
) -> list[ArmTrial]:
    """The trials of a case, a method, a budget, the best first."""
    chosen = (
        trial
        for trial in trials
        if case in (None, trial.case) and method in (None, trial.method) and budget in (None, trial.budget)
    )
    return sorted(chosen, key=lambda trial: trial.cost)


def _label(case: ArmCase, method: str, budget: int, run: int) -> str:
    return f"{case.name}, {method}, {budget:,} evaluations, run {run + 1}"
