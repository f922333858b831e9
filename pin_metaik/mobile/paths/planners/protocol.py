"""The protocol of a path planner: it searches a path for a problem, and its tests of straight lines are counted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import Protocol, runtime_checkable

import numpy as np
import shapely
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBudget
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.optimize import Budget
from pin_metaik.watching import Progress, Watch, tell


@dataclass(frozen=True, eq=False)
class Found:
    """What a path planner found.

    Attributes:
        path: From start to goal; None if it found none.
        trace: (g, 2) lines tested and length of the best path so far, for planners that improve their path.
    """

    path: Path | None
    trace: Array = field(default_factory=lambda: np.empty((0, 2)))


@runtime_checkable
class PathPlanner(Protocol):
    """A path planner; its settings are fields of a frozen dataclass."""

    def route(self, problem: PathProblem, tests: LineTests, rng: np.random.Generator) -> Found:
        """Look for a path until ``tests.spent``.

        Args:
            problem: What is asked.
            tests: Says which straight lines are free, and when to stop.
            rng: The only source of randomness.
        """
        ...


class LineTests:
    """The exact test of straight lines in a free space, counted, with an end.

    Attributes:
        count: Lines tested so far.
        stopped: The Ctrl-C, or the end by a watch, that stopped the work; None if none did.
    """

    def __init__(self, space: FreeSpace, budget: Budget, watch: Watch | None, check: Callable[[], None]) -> None:
        """Tests in a space; ``check`` raises if there was a Ctrl-C that was only noted."""
        if not budget.ends:
            raise InvalidBudget("this search might never end: give the budget evaluations=... or seconds=...")
        if budget.target is not None:
            raise InvalidBudget("a target is for metaheuristics: other planners minimise no cost")
        self._core, self._budget, self._watch, self._check = space.core, budget, watch, check
        self._began = perf_counter()
        self.count = 0
        self.stopped: KeyboardInterrupt | None = None

    def free(self, ax: float, ay: float, bx: float, by: float) -> bool:
        """Whether the line from a to b is free."""
        self.count += 1
        return not self._core.intersects(shapely.LineString(((ax, ay), (bx, by))))

    def free_lines(self, lines: Array) -> NDArray[np.bool_]:
        """Which lines (n, 2, 2) are free (n,)."""
        self.count += len(lines)
        return np.asarray(~shapely.intersects(self._core, shapely.linestrings(lines)))

    def free_point(self, x: float, y: float) -> bool:
        """Whether a place is free; it is no line, and does not count."""
        return not self._core.intersects(shapely.Point(x, y))

    def spent(self, best: float | None = None) -> bool:
        """Whether to stop; tells the watch how far the work is, with the length of the best path so far.

        Nothing is raised from here: planners call it from within other people's loops.
        """
        if self.stopped is not None:
            return True
        try:
            self._check()
            tell(self._watch, Progress(self.count, self._budget.evaluations or 0, best))
        except KeyboardInterrupt as stop:
            self.stopped = stop.with_traceback(None)  # whose frames would keep everything of OMPL alive
            return True
        return self._over

    @property
    def seconds(self) -> float:
        """Time since the work began, s."""
        return perf_counter() - self._began

    @property
    def _over(self) -> bool:
        most, seconds = self._budget.evaluations, self._budget.seconds
        return (most is not None and self.count >= most) or (seconds is not None and self.seconds >= seconds)
