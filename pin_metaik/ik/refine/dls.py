"""Damped least squares with the limits inside the step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.descent import CompiledDescent, Stepwise
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.protocol import Refinement, given_starts
from pin_metaik.kinematics.kernel.limited_step import limited_step

CURVED = 10.0  # the damping of goals in Python by that of poses: of 5, 10 and 20 the one with the fewest evaluations
FLOOR = 1e-9  # of the damping


@checked
@dataclass(frozen=True)
class DLS:
    """Damped least squares (Nakamura and Hanafusa 1986; Wampler 1986), all starts in one compiled loop.

    Each step is dx = -J' (J J' + lambda I)^-1 e over the joints that are not at a limit and pushed outward, with
    lambda = damping |e|^2 + 1e-9. Joints that would cross a limit are put on it, and the step is solved again for the
    others. A start is given up when four steps have not reduced the squared error to below 70 % of its value before
    them. For goals that are evaluated in Python the same steps are taken in NumPy, with ten times the damping, because
    their residuals are more curved.

    Attributes:
        damping: Factor of the squared error in lambda, 1/m^2 or 1/rad^2.
        iterations: Steps from one start at most.
    """

    damping: float = 0.005
    iterations: int = 100

    def __post_init__(self) -> None:
        """Raises InvalidSetting for a negative damping or less than one iteration."""
        if not 0.0 <= self.damping < np.inf:
            raise InvalidSetting(f"damping is a finite number of at least 0, got {self.damping!r}")
        if self.iterations < 1:
            raise InvalidSetting(f"iterations is at least 1, got {self.iterations!r}")

    def descent(self) -> CompiledDescent:
        """The compiled loops of this refiner, for a global search."""
        return CompiledDescent(self.damping, self.iterations, Stepwise(InNumPy(CURVED * self.damping, self.iterations)))

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        return self.descent().refine(problem, given_starts(problem, starts, evaluations), evaluations)

    def refine_anywhere(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """As ``refine``, but also from those sampled configurations whose poses are nearest to the target.

        The first start (s, n) goes before them when its pose is nearer to the target than theirs.
        """
        return self.descent().refine_anywhere(problem, given_starts(problem, starts, evaluations), evaluations)

    def settle(self, problem: IKProblem, x: NDArray[np.float64], evaluations: int) -> Refinement:
        """Go on from x (n,) in small steps for as long as the error falls: for targets that cannot be met."""
        return self.descent().settle(problem, given_starts(problem, [x], evaluations)[0], evaluations)


@dataclass(frozen=True)
class InNumPy:
    """The steps of ``DLS`` in NumPy, for goals that only Python evaluates.

    Attributes:
        damping: As that of ``DLS``.
        iterations: Steps from one start at most.
    """

    damping: float
    iterations: int

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        lower, upper = problem.limits.lower, problem.limits.upper

        def step(
            x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
        ) -> NDArray[np.float64]:
            return limited_step(x, r, J, lower, upper, self.damping * square + FLOOR) - x

        return iterate(problem, starts, evaluations, step, Patience(iterations=self.iterations))
