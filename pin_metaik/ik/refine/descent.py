"""The descents that a global search needs of a refiner: from one start, from a table of samples, and to all solutions.

Damped least squares does it in compiled loops; of any other refiner only ``refine`` is called, one start at a time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.protocol import Refinement, Refiner

PROGRESS = 0.49  # a start is given up unless four steps bring the squared error below this share,
SETTLED = 1.0 - 1e-9  # ... or this one, when there is nothing else to try
STIFF = 1.0  # damping where a solution is far: plain least squares overshoots there


class Descent(Protocol):
    """Descents to the solutions of a problem. Starts are coordinates (s, n); all answers are inside the limits."""

    def refine(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """Descend from each start, in order, until one meets the tolerances or the evaluations are spent."""
        ...

    def refine_anywhere(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """``refine``, from the sampled configurations with the nearest poses, too, where there is a table of them."""
        ...

    def settle(self, problem: IKProblem, x: Array, evaluations: int) -> Refinement:
        """Go on from x (n,) as long as it gets nearer at all: for a target that cannot be met."""
        ...

    def gather(
        self,
        problem: IKProblem,
        starts: Array,
        found: Array,
        known: int,
        apart: float,
        patience: int,
        evaluations: int,
        *,
        branch: bool = True,
    ) -> tuple[int, int, int]:
        """Descend from each start and add new solutions to ``found`` (l, n), of which ``known`` rows are taken.

        A solution is new if some coordinate differs from each known one by more than ``apart`` (rad or m), whole turns
        aside. The search ends when starts, evaluations or rows are used up, or ``patience`` starts in a row met the
        tolerances and led to nothing new. With ``branch`` each solution is started from again with one joint moved by
        pi, where another solution often is.

        Returns:
            Evaluations, rows taken, and how many starts in a row led to nothing new at the end.
        """
        ...

    def settings(self, evaluations: float) -> Array | None:
        """Settings (4,) of the compiled pose solver, to spend so many evaluations; None if it cannot take this way."""
        ...


@dataclass(frozen=True)
class CompiledDescent:
    """Damped least squares in compiled loops; see ``DLS``.

    Attributes:
        damping: What the squared error is multiplied with, 1/m^2 or 1/rad^2.
        iterations: Steps from one start at most.
        otherwise: What descends for goals that only Python evaluates.
    """

    damping: float
    iterations: int
    otherwise: Descent

    def refine(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """See ``Descent``."""
        if problem.goals:
            return self.otherwise.refine(problem, starts, evaluations)
        return _descend(problem, problem.chain.bare, starts, self.settings(evaluations))

    def refine_anywhere(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """See ``Descent``; the first start goes before the samples when its pose is nearer than theirs."""
        if problem.goals:
            return self.otherwise.refine_anywhere(problem, starts, evaluations)
        return _descend(problem, problem.chain.block, starts, self.settings(evaluations))

    def settle(self, problem: IKProblem, x: Array, evaluations: int) -> Refinement:
        """See ``Descent``; in small steps."""
        if problem.goals:
            return self.otherwise.settle(problem, x, evaluations)
        settings = np.array([STIFF, SETTLED, self.iterations, evaluations])
        return _descend(problem, problem.chain.bare, x[None], settings)

    def gather(
        self,
        problem: IKProblem,
        starts: Array,
        found: Array,
        known: int,
        apart: float,
        patience: int,
        evaluations: int,
        *,
        branch: bool = True,
    ) -> tuple[int, int, int]:
        """See ``Descent``."""
        if problem.goals:
            return self.otherwise.gather(problem, starts, found, known, apart, patience, evaluations, branch=branch)
        chain, starts = problem.chain, np.ascontiguousarray(starts)
        given = chain.bare, problem.records, problem.kernel_rows, starts, self.settings(evaluations)
        return chain.kernels.descend_all(*given, apart, patience, branch, found, known)

    def settings(self, evaluations: float) -> Array:
        """See ``Descent``."""
        return np.array([self.damping, PROGRESS, self.iterations, evaluations])


def _descend(problem: IKProblem, block: Array, starts: Array, settings: Array) -> Refinement:
    best = np.empty(problem.chain.n)
    descend = problem.chain.kernels.descend
    spent, solved_by = descend(block, problem.records, problem.kernel_rows, starts, settings, best)
    return Refinement(best, solved_by >= 0, spent)


@dataclass(frozen=True)
class Stepwise:
    """Descents by a refiner of which nothing is known but its method ``refine``.

    Attributes:
        refiner: The refiner.
    """

    refiner: Refiner

    def refine(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """See ``Descent``."""
        return self.refiner.refine(problem, starts, evaluations)

    def refine_anywhere(self, problem: IKProblem, starts: Array, evaluations: int) -> Refinement:
        """See ``Descent``: from the starts alone."""
        return self.refiner.refine(problem, starts, evaluations)

    def settle(self, problem: IKProblem, x: Array, evaluations: int) -> Refinement:
        """See ``Descent``: x as it is, for the refiner has been there."""
        return Refinement(x, False, 0)

    def gather(
        self,
        problem: IKProblem,
        starts: Array,
        found: Array,
        known: int,
        apart: float,
        patience: int,
        evaluations: int,
        *,
        branch: bool = True,
    ) -> tuple[int, int, int]:
        """See ``Descent``."""
        spent = vain = 0
        n, waiting, turned = problem.chain.n, iter(starts), problem.chain.n * known
        while spent < evaluations and known < len(found) and vain < patience:
            if branch and turned < n * known:
                start = _half_turned(problem, found[turned // n], turned % n)
                turned += 1
            elif (given := next(waiting, None)) is not None:
                start = given
            else:
                break
            refined = self.refiner.refine(problem, start[None], evaluations - spent)
            spent += max(1, refined.evaluations)
            if refined.met:
                vain += 1
                if (problem.limits.separation(found[:known], refined.x) > apart).any(axis=1).all():
                    found[known], known, vain = refined.x, known + 1, 0
        return spent, known, vain

    def settings(self, evaluations: float) -> None:
        """See ``Descent``."""
        return


def _half_turned(problem: IKProblem, x: Array, joint: int) -> Array:
    """Coordinates x (n,) with one joint moved by pi, or minus pi where there is no room."""
    start = x.copy()
    start[joint] += -np.pi if start[joint] + np.pi > problem.limits.upper[joint] else np.pi
    return problem.limits.clip(start)


def descent_of(refiner: Refiner) -> Descent:
    """The descents of a refiner: its own, if it has a method ``descent`` that gives them, or by its ``refine``."""
    own = getattr(refiner, "descent", None)
    return Stepwise(refiner) if own is None else own()
