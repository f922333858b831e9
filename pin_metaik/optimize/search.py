"""The protocol of a metaheuristic, and a run of a search."""

from __future__ import annotations

from collections.abc import Generator
from time import perf_counter
from typing import Protocol, runtime_checkable

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.budget import Budget
from pin_metaik.optimize.settings import few
from pin_metaik.optimize.space import Box


class Search:
    """One run of a search, as given to the algorithm.

    Attributes:
        space: The box every point must lie in.
        rng: The only source of randomness.
        seeds: Points given to start from (s, n), already inside the box; s may be 0.
        evaluations: Function evaluations spent so far. The caller counts; algorithms only read it.
    """

    def __init__(self, space: Box, rng: np.random.Generator, seeds: Array, budget: Budget) -> None:
        self.space = space
        self.rng = rng
        self.seeds = seeds
        self.evaluations = 0
        self._budget = budget
        self._began = perf_counter()

    @property
    def progress(self) -> float:
        """Share of the budget spent, 0 to 1: what papers write as t / MaxIter.

        By evaluations, or by seconds if the budget has only these; always 0 without a budget.
        """
        if self._budget.evaluations is not None:
            return min(1.0, self.evaluations / self._budget.evaluations)
        if self._budget.seconds is not None:
            return min(1.0, self.seconds / self._budget.seconds)
        return 0.0

    @property
    def remaining(self) -> int | None:
        """Evaluations left; None when they are not limited."""
        return None if self._budget.evaluations is None else self._budget.evaluations - self.evaluations

    @property
    def seconds(self) -> float:
        """Time since the search began, in s."""
        return perf_counter() - self._began

    def start(self, count: int) -> Array:
        """An initial population (count, n): the first `count` seeds, then points drawn uniformly."""
        few("count", count, 0)
        given = self.seeds[:count]
        return np.concatenate((given, self.space.sample(self.rng, count - len(given))))


@runtime_checkable
class Metaheuristic(Protocol):
    """An algorithm that proposes points and learns from their costs: any object with this one method.

    The method is a generator: ``costs = yield X`` hands out points X (k, n), k >= 1, inside ``run.space``, and receives
    their costs (k,), an array that it may keep or overwrite. Smaller is better; +inf marks an invalid point. It loops
    for ever: the caller evaluates, counts, and closes it when the budget is spent. The last batch may be cut short, and
    its costs are then not returned. X is copied when it is handed out.

    Its settings are fields of a frozen dataclass.
    """

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose populations (k, n), receive their costs (k,), for ever."""
        ...
