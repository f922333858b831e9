"""The state of one search: budget spent, best so far, reason for stopping."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.proof import Proof
from pin_metaik.ik.refine import Refinement
from pin_metaik.ik.result import IKStatus
from pin_metaik.kinematics.roots.real import UNBOUNDED
from pin_metaik.optimize import Budget, Result


class SearchState:
    """Keeps the best coordinates and the budget of one search.

    Attributes:
        problem: What is searched for, and what costs are of.
        x: (n,) the best coordinates so far.
        cost: Of ``x``, as the problem counts it.
        met: Whether they met the tolerances, by the kernels; Pinocchio has the last word.
        spent: Evaluations so far, those of boxes among them.
        proof: What proves that there is nothing to be found, if anything does.
        traces: Convergence of each round of a seeder: (g, 2) evaluations and best cost.
    """

    def __init__(
        self,
        problem: IKProblem,
        budget: Budget,
        began: float,
        x0: NDArray[np.float64],
        patience: int | None = None,
    ) -> None:
        """Begin at x0 (n,); a search may take ``patience`` evaluations of the budget, the rest is for boxes."""
        self.x = x0
        self.met = False
        self.spent = 0
        self.proof: Proof | None = problem.proof
        self.traces: list[NDArray[np.float64]] = []
        self.problem = problem
        self._budget = budget
        self._began = began
        self.cost = math.inf
        self._patience = patience
        self._boxes = 0

    @property
    def status(self) -> IKStatus:
        """Why a search ended that has not solved its problem."""
        if self.proof is not None:
            return IKStatus.UNREACHABLE
        timed = self._budget.seconds is not None and self.left() > 0
        return IKStatus.STOPPED if timed else IKStatus.OUT_OF_TOLERANCE

    @property
    def searched(self) -> int:
        """Evaluations so far, but for boxes."""
        return self.spent - self._boxes

    def left(self, share: float = 1.0) -> int:
        """Evaluations left of this share of what a search may take."""
        total = self._budget.evaluations
        if total is None:
            return UNBOUNDED
        most = total if self._patience is None else min(self._patience, total)
        return max(0, min(math.ceil(share * most) - self.searched, total - self.spent))

    @property
    def left_for_boxes(self) -> int:
        """Boxes that may still be looked at: nine tenths of the budget at most."""
        total = self._budget.evaluations
        return UNBOUNDED if total is None else max(0, min(9 * total // 10 - self._boxes, total - self.spent))

    @property
    def decided(self) -> bool:
        """Whether the problem is solved, or proved to have no solution."""
        return self.met or self.proof is not None

    def over(self, share: float = 1.0) -> bool:
        """Whether the search is over: decided, or this share of the budget spent."""
        return self.decided or self.left(share) == 0 or self.late(share)

    def slice(self, share: float) -> Budget:
        """A budget for one round of seeding: this share of what is left."""
        total, seconds = self._budget.evaluations, self._budget.seconds
        goal = self.problem.success_cost if self._budget.target is None else self._budget.target
        return Budget(
            None if total is None else max(1, int(share * self.left())),
            None if seconds is None else max(1e-3, share * (seconds - self._elapsed())),
            goal,
        )

    def add(self, refinement: Refinement) -> None:
        """Enter what a refiner found and spent."""
        self.spent += refinement.evaluations
        if refinement.met:
            self.met, self.x = True, refinement.x
            return
        cost = float(self.problem.costs(refinement.x[None])[0])
        if cost < self.cost:
            self.cost, self.x = cost, refinement.x

    def add_boxes(self, looked: int) -> None:
        """Enter boxes that were looked at."""
        self.spent += looked
        self._boxes += looked

    def add_search(self, found: Result) -> None:
        """Enter what a seeder found and spent."""
        if found.trace is not None:
            self.traces.append(found.trace + np.array([self.spent, 0.0]))
        self.spent += found.evaluations
        if found.cost < self.cost:
            self.cost, self.x = found.cost, found.x

    def _elapsed(self) -> float:
        return perf_counter() - self._began

    def late(self, share: float = 1.0) -> bool:
        """Whether this share of the time is up."""
        return self._budget.seconds is not None and self._elapsed() >= share * self._budget.seconds
