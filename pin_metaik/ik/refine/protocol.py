"""The protocol of a refiner."""

from __future__ import annotations

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, instance
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.ik.problem import IKProblem
from pin_metaik.optimize.settings import whole


class Refinement(NamedTuple):
    """The best coordinates reached (n,), whether they met the tolerances, and the evaluations spent."""

    x: NDArray[np.float64]
    met: bool
    evaluations: int


def given_starts(problem: IKProblem, starts: ArrayLike, evaluations: int) -> NDArray[np.float64]:
    """What a refiner was given, looked at: its starts (s, n), at least one.

    Raises:
        InvalidConfiguration: There are none, or of another shape.
        InvalidSetting: There is no problem, or no number of evaluations.
    """
    instance(IKProblem, problem=problem)
    if type(evaluations) is not int:
        whole("evaluations", evaluations, 0)
    given = array("starts", starts, "s", problem.chain.n, error=InvalidConfiguration, finite=False)
    if not len(given):
        raise InvalidConfiguration("a refiner needs at least one start, got none")
    return given


@runtime_checkable
class Refiner(Protocol):
    """Any local method that goes from a start to a nearby solution and stays inside the limits."""

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        ...
