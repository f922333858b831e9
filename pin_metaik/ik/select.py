"""Criteria for choosing among solutions; lower is better."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from pin_metaik.dexterity import manipulability
from pin_metaik.ik.problem import IKProblem

Measure = Callable[[IKProblem, NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]


def displacement(problem: IKProblem, X: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance (k,) of coordinates X (k, n) from x0 (n,), rad and m alike; angles by the shortest way that exists."""
    distance: NDArray[np.float64] = np.linalg.norm(problem.limits.nearest_turns(X, x0) - x0, axis=1)
    return distance


def clumsiness(problem: IKProblem, X: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
    """Minus the manipulability (k,) of the weighted task Jacobian at X (k, n)."""
    return -manipulability(np.array([problem.linearize(x)[1].T for x in X]))


def crowding(problem: IKProblem, X: NDArray[np.float64], x0: NDArray[np.float64]) -> NDArray[np.float64]:
    """How near (k,) the worst joint is to a limit: 0 in mid-range, 1 at a limit; joints without limits do not count."""
    limits = problem.limits
    bounded = np.isfinite(limits.lower) & np.isfinite(limits.upper) & (limits.upper > limits.lower)
    if not bounded.any():
        return np.zeros(len(X))
    lower, upper = limits.lower[bounded], limits.upper[bounded]
    worst: NDArray[np.float64] = np.abs((2.0 * X[:, bounded] - lower - upper) / (upper - lower)).max(axis=1)
    return worst


SELECT: dict[str, Measure] = {
    "nearest": displacement,
    "manipulability": clumsiness,
    "limits": crowding,
}
