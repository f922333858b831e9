"""What a refiner is."""

from __future__ import annotations

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import array
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.ik.problem import IKProblem


class Refinement(NamedTuple):
    """The best coordinates reached (n,), whether they met the tolerances, and the evaluations spent."""

    x: NDArray[np.float64]
    met: bool
    evaluations: int


def given_starts(problem: IKProblem, starts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Starts (s, n) that somebody gave, at least one.

    Raises:
        InvalidConfiguration: They are none.
    """
    given = array("starts", starts, "s", problem.chain.n, error=InvalidConfiguration)
    if not len(given):
        raise InvalidConfiguration("a refiner needs at least one start, got none")
    return given


@runtime_checkable
class Refiner(Protocol):
    """Anything that walks from a start to a nearby solution and stays inside the limits."""

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        ...
