"""What a refiner is."""

from __future__ import annotations

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from pin_metaik.ik.problem import IKProblem


class Refinement(NamedTuple):
    """The best coordinates reached (n,), whether they met the tolerances, and the evaluations spent."""

    x: NDArray[np.float64]
    met: bool
    evaluations: int


@runtime_checkable
class Refiner(Protocol):
    """Anything that walks from a start to a nearby solution and stays inside the limits."""

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        ...
