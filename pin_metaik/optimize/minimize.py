"""Minimise a function over a box with any metaheuristic: the one place that evaluates, counts and stops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBudget
from pin_metaik.optimize.asktell import AskTell, Status
from pin_metaik.optimize.budget import Budget
from pin_metaik.optimize.search import Metaheuristic
from pin_metaik.optimize.space import Box
from pin_metaik.plain import fields_of
from pin_metaik.watching import Population, Progress, Watch, ended, tell


@dataclass(frozen=True, eq=False)
class Result:
    """The best of a search, and why it ended.

    Attributes:
        x: The best point evaluated (n,), inside the box.
        cost: Its cost.
        status: Why the search ended.
        evaluations: Function evaluations spent.
        generations: Batches evaluated.
        seconds: Time spent, in s.
        trace: Evaluations and best cost after each generation (g, 2), when asked for.
        elite: The best points evaluated (m, n), best first, without exact repeats; m <= keep.
        elite_costs: Their costs (m,).
    """

    x: Array
    cost: float
    status: Status
    evaluations: int
    generations: int
    seconds: float
    trace: Array | None
    elite: Array
    elite_costs: Array

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON; None where a cost is not finite."""
        names = ("x", "cost", "status", "evaluations", "generations", "seconds", "trace", "elite", "elite_costs")
        return fields_of(self, *names)


@checked
def minimize(
    objective: Callable[[Array], ArrayLike],
    box: Box,
    algorithm: str | Metaheuristic,
    budget: Budget,
    rng: int | np.random.Generator | None = 0,
    *,
    seeds: ArrayLike | None = None,
    trace: bool = False,
    watch: Watch | None = None,
    keep: int = 1,
) -> Result:
    """Search the box for a point of least cost.

    Ctrl-C raises ``Interrupted`` with the best point so far, once there is one.

    Args:
        objective: Function that returns the costs (k,) of points (k, n); it may overwrite the array. NaN counts as
            +inf.
        box: The search space.
        algorithm: A name of the registry or an object with a `search` method.
        budget: When to stop; needs `evaluations` or `seconds`.
        rng: Seed or generator: the same seed gives the same answer bit for bit, unless the budget is in seconds.
            ``None`` is a fixed seed.
        seeds: Points to start from (s, n) or (n,), clipped to the box. An algorithm uses as many as it has agents.
        trace: Whether to record the best cost after every generation.
        watch: Called after every generation with the evaluations done and in all, the best cost, and the points of the
            generation (``Progress.population``); returning True ends the search as interrupted.
        keep: How many of the best points to return in `Result.elite`.

    Raises:
        UnknownName: No algorithm of that name.
        InvalidBudget: The budget would never end.
        InvalidSetting: Costs or seeds of the wrong shape, `keep` below 1, or an algorithm that leaves the box.
        Interrupted: Ctrl-C, after the first generation; its `result` is a Result.
    """
    if not budget.ends:
        raise InvalidBudget("this search might never end: give the budget evaluations=... or seconds=...")
    search = AskTell(box, algorithm, rng, seeds, budget, keep=keep)
    history: list[tuple[float, float]] = []
    try:
        while search.status is None:
            X = search.ask()
            costs = objective(X if watch is None else X.copy())
            search.tell(costs)
            if trace:
                history.append((search.run.evaluations, search.elite.costs[0]))
            if watch is not None:
                tell(watch, _progress(search, budget, Population(X, _own(costs))))
    except KeyboardInterrupt as stop:
        if search.generations == 0:
            raise
        search.stop()
        return ended(stop, _result(search, history if trace else None))
    return _result(search, history if trace else None)


def _progress(search: AskTell, budget: Budget, population: Population) -> Progress:
    best = float(search.elite.costs[0])
    return Progress(search.run.evaluations, budget.evaluations or 0, best, population=population)


def _own(costs: ArrayLike) -> Array:
    """Costs (k,) that are nobody else's, inf for NaN."""
    own = np.array(costs, dtype=float)
    own[np.isnan(own)] = np.inf
    return own


def _result(search: AskTell, history: list[tuple[float, float]] | None) -> Result:
    return Result(
        x=search.best.x,
        cost=search.best.cost,
        status=search.status or Status.INTERRUPTED,
        evaluations=search.run.evaluations,
        generations=search.generations,
        seconds=search.run.seconds,
        trace=None if history is None else np.array(history).reshape(-1, 2),
        elite=search.elite.X,
        elite_costs=search.elite.costs,
    )
