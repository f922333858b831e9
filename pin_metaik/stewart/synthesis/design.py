"""Dimensional optimisation: a metaheuristic looks for the platform with the best fitness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.interrupts import wrapped
from pin_metaik.optimize import Budget, Result, Status, minimize
from pin_metaik.plain import plain
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.synthesis.fitness import UNUSABLE, Fitness, Score, task_of
from pin_metaik.watching import Watch


@dataclass(frozen=True, eq=False)
class Designed:
    """The result of a design.

    Attributes:
        mechanism: The best mechanism found, with the settings of the search. If none was feasible, the given one.
        score: Its fitness and the two parts of it, measured with a few thousand cells; None if no design was feasible.
        search: The search itself: why it ended, evaluations, seconds, trace.
    """

    mechanism: Mechanism
    score: Score | None
    search: Result

    @property
    def success(self) -> bool:
        """Whether a feasible design was found, also before an interruption."""
        return self.score is not None

    def __bool__(self) -> bool:
        return self.success

    @property
    def interrupted(self) -> bool:
        """Whether the search was interrupted; the mechanism is the best until then."""
        return self.search.status is Status.INTERRUPTED

    @property
    def history(self) -> Array:
        """(g, 2) designs evaluated and best fitness after each generation; below 0 while none was feasible."""
        assert self.search.trace is not None
        return self.search.trace * [1.0, -1.0]

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: how the search ended and what the best design scores, in m and rad."""
        score = None if self.score is None else plain(vars(self.score))
        return {"success": self.success, "ended": self.search.status.value, "score": score}

    def __str__(self) -> str:
        found = f"fitness {self.score.fitness:.4f}" if self.score else "no feasible design"
        return f"{self.mechanism.name}: {found} after {self.search.evaluations} designs in {self.search.seconds:.3g} s"


class _Measured:
    """A fitness that measures whatever would be the best design again, by more cells, before it may be.

    A coarse grid flatters some designs, and a search finds these. So the best is chosen by a fine grid.
    """

    def __init__(self, fitness: Fitness) -> None:
        self.fitness, self.best = fitness, np.inf

    def __call__(self, X: Array) -> Array:
        costs = self.fitness(X)
        for k in np.argsort(costs, kind="stable"):
            if costs[k] < self.best:
                costs[k] = self.fitness.cost(X[k], fine=True)
                self.best = min(self.best, float(costs[k]))
        return costs


@checked
def design(
    mechanism: Mechanism, *, rng: int | np.random.Generator | None = None, watch: Watch | None = None
) -> Designed:
    """Search for the dimensions with the best fitness, by the mechanism's task.

    Args:
        mechanism: The mechanism to start from: its joints and legs, and all dimensions that are not in the task's
            ranges.
        rng: Seed or generator instead of the task's seed; the same seed gives the same design.
        watch: Called after every generation with the designs evaluated, their total and the best cost; returning True
            ends the search.

    Returns:
        The result; check ``result.success``.

    Raises:
        InvalidSetting: The mechanism has no task, or one that does not fit it.
        InvalidBounds: Ranges that do not fit the mechanism, or leave nothing free.
        Interrupted: Ctrl-C, after the first generation; its ``result`` is the best design so far.
    """
    task = task_of(mechanism)
    fitness = Fitness(mechanism)
    point = fitness.variables.point(mechanism.geometry, mechanism.limits)

    def search() -> Result:
        return minimize(
            _Measured(fitness),
            fitness.variables.box,
            task.algorithm,
            Budget(evaluations=task.evaluations),
            task.seed if rng is None else rng,
            seeds=point if task.from_current else None,
            trace=True,
            watch=watch,
        )

    return wrapped(search, lambda found: _designed(mechanism, fitness, found))


def _designed(mechanism: Mechanism, fitness: Fitness, found: Result) -> Designed:
    """The result of a search, with the score of its best design."""
    if found.cost >= UNUSABLE:
        return Designed(mechanism, None, found)
    geometry, limits = fitness.build(fitness.variables.dimensions(found.x))
    score = fitness.score(fitness.workspace(geometry, limits, fine=True))
    return Designed(replace(mechanism, geometry=geometry, limits=limits), score, found)
