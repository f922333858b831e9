"""Criteria for choosing among solutions, by name or of one's own; lower is better."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from pin_metaik.arguments import shown
from pin_metaik.arrays import Array
from pin_metaik.dexterity import manipulability
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.ik.gravity import gravity_torque
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.descent import Descent

Criterion: TypeAlias = Callable[[Array], float]
"""A number for a configuration q (nq,); the lower, the better."""
Measure: TypeAlias = Callable[[IKProblem, Array, Array], Array]
"""Numbers (k,) for coordinates X (k, n) and a start x0 (n,); the lower, the better."""

STEPS = 30
FIRST_STEP, LAST_STEP = 0.3, 1e-3  # rad or m
NUDGE = 1e-5  # rad or m, of the finite differences
BACK = 50  # evaluations to come back onto the targets after a step


def displacement(problem: IKProblem, X: Array, x0: Array) -> Array:
    """Distance (k,) of coordinates X (k, n) from x0 (n,), rad and m alike; angles by the shortest way that exists."""
    distance: Array = np.linalg.norm(problem.limits.nearest_turns(X, x0) - x0, axis=1)
    return distance


def neg_manipulability(problem: IKProblem, X: Array, x0: Array) -> Array:
    """Minus the manipulability (k,) of the weighted task Jacobian at X (k, n)."""
    return -manipulability(np.array([problem.linearize(x)[1].T for x in X]))


def limit_proximity(problem: IKProblem, X: Array, x0: Array) -> Array:
    """How near (k,) the worst joint is to a limit: 0 in mid-range, 1 at a limit; joints without limits do not count."""
    limits = problem.limits
    bounded = np.isfinite(limits.lower) & np.isfinite(limits.upper) & (limits.upper > limits.lower)
    if not bounded.any():
        return np.zeros(len(X))
    lower, upper = limits.lower[bounded], limits.upper[bounded]
    worst: Array = np.abs((2.0 * X[:, bounded] - lower - upper) / (upper - lower)).max(axis=1)
    return worst


def gravity_torques(problem: IKProblem, X: Array, x0: Array) -> Array:
    """Size (k,) of the torques and forces that hold the chain's joints against gravity at X (k, n), N m and N."""
    torque = gravity_torque(problem.chain)
    return np.array([torque(q) for q in problem.chain.q(X)])


CRITERIA: dict[str, Measure] = {
    "nearest": displacement,
    "manipulability": neg_manipulability,
    "limits": limit_proximity,
    "torque": gravity_torques,
}


def measure_of(select: str | Criterion) -> Measure:
    """The measure of a criterion's name, or of somebody's own criterion.

    Raises:
        UnknownName: If there is no criterion of that name.
    """
    if not isinstance(select, str):
        return _measured_by(select)
    if select not in CRITERIA:
        raise UnknownName("selection", select, {"first", *CRITERIA})
    return CRITERIA[select]


def _measured_by(criterion: Criterion) -> Measure:
    """The measure of a criterion of one's own; what it says of a configuration is looked at.

    Its measure raises InvalidSetting where the criterion does not give a number.
    """

    def measure(problem: IKProblem, X: Array, x0: Array) -> Array:
        return np.array([_number(criterion(q)) for q in problem.chain.q(X)])

    return measure


def _number(value: object) -> float:
    """What a criterion says, as a number."""
    try:
        number = float(value)  # type: ignore[arg-type]  # whatever it is
    except (TypeError, ValueError):
        number = math.nan
    if math.isnan(number):
        raise InvalidSetting(f"select gives a number for a configuration q (nq,), lower is better; got {shown(value)}")
    return number


def slide(problem: IKProblem, x: Array, x0: Array, measure: Measure, descent: Descent) -> Array:
    """Better coordinates (n,) by the measure, reached from a solution x (n,) without leaving the targets.

    Steepest descent of the measure projected on the null space of the Jacobian, each step put back onto the targets by
    the refiner (Rosen's gradient projection, 1961). Returns x itself where the targets leave no freedom.
    """
    J = problem.linearize(x)[1].T
    if J.shape[1] <= J.shape[0]:
        return x
    best = float(measure(problem, x[None], x0)[0])
    length = FIRST_STEP
    for _ in range(STEPS):
        gradient = (measure(problem, x + NUDGE * np.eye(len(x)), x0) - best) / NUDGE
        J = problem.linearize(x)[1].T
        downhill = -gradient + np.linalg.pinv(J) @ (J @ gradient)
        size = float(np.linalg.norm(downhill))
        if not 1e-9 <= size < math.inf:
            return x
        while length > LAST_STEP:
            tried = problem.limits.clip(x + length / size * downhill)
            refined = descent.refine(problem, tried[None], BACK)
            value = float(measure(problem, refined.x[None], x0)[0])
            if refined.met and value < best:
                x, best = refined.x, value
                break
            length *= 0.5
        else:
            return x
    return x
