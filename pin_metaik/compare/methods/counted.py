"""A refiner whose steps are counted in kernel evaluations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compare.methods.cost import evaluations_of, steps_within
from pin_metaik.ik import IKProblem, Refinement, Refiner


@dataclass(frozen=True)
class Counted:
    """A refiner that spends and reports kernel evaluations: each of its steps takes a Jacobian.

    Attributes:
        refiner: The refiner.
    """

    refiner: Refiner

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend within so many kernel evaluations; a rest too small for one step is written off."""
        steps = steps_within(evaluations)
        if steps == 0:
            return Refinement(problem.limits.clip(starts[0]), False, evaluations)
        found = self.refiner.refine(problem, starts, steps)
        return found._replace(evaluations=evaluations_of(found.evaluations))
