"""Ask for points, tell their costs: a search driven by its caller, for objectives that cannot be a Python callable."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize.budget import Budget
from pin_metaik.optimize.elite import Elite
from pin_metaik.optimize.registry import make
from pin_metaik.optimize.search import Metaheuristic, Search
from pin_metaik.optimize.settings import few
from pin_metaik.optimize.space import Box
from pin_metaik.randomness import as_generator


class Status(Enum):
    """Why a search ended."""

    TARGET_REACHED = "target reached"
    EVALUATIONS_SPENT = "evaluations spent"
    TIME_SPENT = "time spent"
    INTERRUPTED = "interrupted"
    FINISHED = "the algorithm finished"


class Best(NamedTuple):
    """The best point evaluated so far."""

    x: Array
    cost: float


@checked
class AskTell:
    """A search driven by its caller: `ask` for points, evaluate them, `tell` their costs, until `status` is set.

    Args:
        box: Where to search.
        algorithm: A name of the registry or an object with a `search` method.
        rng: Seed or generator: the same seed gives the same answer bit for bit; ``None`` is a fixed seed.
        seeds: Points to start from (s, n) or (n,), clipped to the box. An algorithm uses as many as it has agents.
        budget: When to stop. Without one it never stops, and parameters scheduled over the budget keep their first
            values.
        keep: How many of the best points to remember in `elite`.

    Attributes:
        run: The run as the algorithm sees it, with the evaluations spent.
        elite: The best points so far.
        status: Why it ended; None while it runs.
        generations: Number of batches whose costs were told.

    Raises:
        UnknownName: No algorithm of that name.
        InvalidSetting: Seeds of the wrong shape, `keep` below 1, or an algorithm that leaves the box.
    """

    def __init__(
        self,
        box: Box,
        algorithm: str | Metaheuristic,
        rng: int | np.random.Generator | None = 0,
        seeds: ArrayLike | None = None,
        budget: Budget | None = None,
        *,
        keep: int = 1,
    ) -> None:
        few("keep", keep)
        algorithm = make(algorithm)
        self._name = type(algorithm).__name__
        self._budget = budget or Budget()
        self.run = Search(box, as_generator(rng), _starts(seeds, box), self._budget)
        self.elite = Elite(keep, box.dimension)
        self.status: Status | None = None
        self.generations = 0
        self._generator = algorithm.search(self.run)
        if not hasattr(self._generator, "send"):
            raise InvalidSetting(f"{self._name}.search is not a generator: it hands out points with costs = yield X")
        self._asked = False
        self._propose(None)

    @property
    def best(self) -> Best:
        """The best point so far. InvalidSetting before the first `tell`."""
        if not len(self.elite.costs):
            raise InvalidSetting("nothing is best yet: ask() for points and tell() their costs first")
        return Best(self.elite.X[0], float(self.elite.costs[0]))

    def ask(self) -> Array:
        """The points to evaluate next (k, n), never more than the budget allows; the array is the caller's.

        Raises:
            InvalidSetting: The search has ended, or the costs of the last points were not told.
        """
        if self.status is not None:
            raise InvalidSetting(f"the search has ended ({self.status.value}): there is nothing to ask for")
        if self._asked:
            raise InvalidSetting("ask() was called twice: tell() the costs of the last points first")
        self._asked = True
        return self._X.copy()

    def tell(self, costs: ArrayLike) -> None:
        """Costs (k,) of the points last asked for, in their order. NaN counts as +inf.

        Raises:
            InvalidSetting: Nothing was asked for, or the costs are not k numbers.
        """
        if not self._asked:
            raise InvalidSetting("tell() without ask(): ask() for points first")
        costs = array("costs", costs, len(self._X), finite=False).copy()
        if np.isnan(costs[costs.argmin()]):  # argmin stops at the first NaN
            costs[np.isnan(costs)] = np.inf
        self.elite.add(self._X, costs)
        self.run.evaluations += len(costs)
        self.generations += 1
        self._asked = False
        self.status = self._verdict()
        if self.status is None:
            self._propose(costs)
        else:
            self._generator.close()

    def stop(self) -> None:
        """End the search early."""
        if self.status is None:
            self.status = Status.INTERRUPTED
            self._generator.close()

    def _verdict(self) -> Status | None:
        budget = self._budget
        if budget.target is not None and self.elite.costs[0] <= budget.target:
            return Status.TARGET_REACHED
        if self.run.remaining == 0:
            return Status.EVALUATIONS_SPENT
        if budget.seconds is not None and self.run.seconds >= budget.seconds:
            return Status.TIME_SPENT
        return None

    def _propose(self, costs: Array | None) -> None:
        """Let the algorithm move on, and take as much of its next population as the budget still allows."""
        try:
            proposed = next(self._generator) if costs is None else self._generator.send(costs)
        except StopIteration:
            if costs is None:
                raise InvalidSetting(f"{self._name} ended without proposing a point") from None
            self.status = Status.FINISHED
            return
        X, space, name = np.asarray(proposed, dtype=float), self.run.space, self._name
        if X.ndim != 2 or X.shape[1] != space.dimension or not len(X):
            raise InvalidSetting(f"{name} proposed points of shape {X.shape}: expected (k, {space.dimension}), k >= 1")
        if not space.contains_all(X):
            outside = X[~space.contains(X)][0]
            raise InvalidSetting(f"{name} left the box with {outside}: clip its points, e.g. run.space.clip(X)")
        self._X: Array = X[: self.run.remaining]


def _starts(seeds: ArrayLike | None, box: Box) -> Array:
    """The seeds as an array (s, n) inside the box, a copy."""
    if seeds is None:
        return np.empty((0, box.dimension))
    X = array("seeds", seeds, "...", box.dimension)
    return box.clip(X[None] if X.ndim == 1 else array("seeds", X, "s", box.dimension))
