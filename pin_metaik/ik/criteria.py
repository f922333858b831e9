"""Criteria for choosing among solutions, by name, with weights of joints, or of one's own; lower is better."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol, TypeAlias

import numpy as np

from pin_metaik.arguments import checked, shown
from pin_metaik.arrays import Array
from pin_metaik.collision import CollisionWorld
from pin_metaik.dexterity import RANK_TOLERANCE, manipulability
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.ik.gravity import gravity_loads
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.descent import Descent

Criterion: TypeAlias = Callable[[Array], float]
"""A number for a configuration q (nq,); the lower, the better."""
Measure: TypeAlias = Callable[[IKProblem, Array, Array], Array]
"""Numbers (k,) for coordinates X (k, n) and a start x0 (n,); the lower, the better."""

Step: TypeAlias = Callable[[Array], Array]
"""A step (n,) that is a combination of the columns of N (n, k)."""

STEPS = 30
FIRST_STEP, LAST_STEP = 0.3, 1e-3  # rad or m
NUDGE = 1e-5  # rad or m, of the finite differences
BACK = 50  # evaluations to come back onto the targets after a step
LITTLE = 1e-6  # of the measure: a step that gains less is the last one
FLAT = 1e-9  # rad or m: nothing moves
SINGULAR = 1e-4  # of the largest singular value: a direction that wishes do not depend on


class WeightedMeasure(Protocol):
    """A measure in which each coordinate counts by a weight (n,), or all alike."""

    def __call__(self, problem: IKProblem, X: Array, x0: Array, weights: Array | float = 1.0) -> Array:
        """As of a ``Measure``."""


@checked
@dataclass(frozen=True)
class Weighted:
    """A criterion by name in which some joints count more, or less, than others.

    Attributes:
        criterion: ``"nearest"``: a joint of weight 3 counts as if it moved three times as far; ``"limits"``: as if it
            were three times as near to its limit, of which 1 is at it; ``"torque"``: as if it held three times as much.
        joints: The weight of each coordinate that is named, at least 0; of all others it is 1.
    """

    criterion: str
    joints: Mapping[str, float] = field(hash=False)

    def __post_init__(self) -> None:
        """Check what needs no chain.

        Raises:
            UnknownName: No criterion of that name takes weights.
            InvalidSetting: A weight is below 0, or not finite.
        """
        if self.criterion not in WEIGHTED:
            raise UnknownName("criterion that weights joints", self.criterion, set(WEIGHTED))
        for name, weight in self.joints.items():
            if not 0.0 <= weight < math.inf:
                raise InvalidSetting(f"the weight of a joint is a number of at least 0, got {name}={weight:g}")


Selection: TypeAlias = str | Weighted | Criterion
"""What to choose by: a criterion's name, one with weights, or a function of a configuration q (nq,)."""


def displacement(problem: IKProblem, X: Array, x0: Array, weights: Array | float = 1.0) -> Array:
    """Distance (k,) of coordinates X (k, n) from x0 (n,), rad and m alike; angles by the shortest way that exists."""
    distance: Array = np.linalg.norm(weights * (problem.limits.nearest_turns(X, x0) - x0), axis=1)
    return distance


def neg_manipulability(problem: IKProblem, X: Array, x0: Array) -> Array:
    """Minus the manipulability (k,) of the weighted task Jacobian at X (k, n)."""
    return -manipulability(np.array([problem.linearize(x)[1].T for x in X]))


def limit_proximity(problem: IKProblem, X: Array, x0: Array, weights: Array | float = 1.0) -> Array:
    """How near (k,) the worst joint is to a limit: 0 in mid-range, 1 at a limit; joints without limits do not count."""
    limits = problem.limits
    bounded = np.isfinite(limits.lower) & np.isfinite(limits.upper) & (limits.upper > limits.lower)
    if not bounded.any():
        return np.zeros(len(X))
    lower, upper = limits.lower[bounded], limits.upper[bounded]
    near = np.abs((2.0 * X[:, bounded] - lower - upper) / (upper - lower))
    worst: Array = (near * np.broadcast_to(weights, len(bounded))[bounded]).max(axis=1)
    return worst


def gravity_torques(problem: IKProblem, X: Array, x0: Array, weights: Array | float = 1.0) -> Array:
    """Size (k,) of the torques and forces that hold the chain's joints against gravity at X (k, n), N m and N."""
    held = gravity_loads(problem.chain)
    return np.array([np.linalg.norm(weights * held(q)) for q in problem.chain.q(X)])


def neg_clearance(problem: IKProblem, X: Array, x0: Array) -> Array:
    """Minus the distance (k,) in m to the nearest collision in the problem's world, at X (k, n).

    Raises:
        InvalidSetting: There is no world.
    """
    world = world_of(problem)
    return np.array([-world.min_distance(q).distance for q in problem.chain.q(X)])


def world_of(problem: IKProblem) -> CollisionWorld:
    """The world that clearance is measured in.

    Raises:
        InvalidSetting: There is none.
    """
    if problem.world is None:
        raise InvalidSetting("clearance is a distance in a world: give one, as solve_ik(chain, target, world=world)")
    return problem.world


WEIGHTED: dict[str, WeightedMeasure] = {
    "nearest": displacement,
    "limits": limit_proximity,
    "torque": gravity_torques,
}
CRITERIA: dict[str, Measure] = {**WEIGHTED, "manipulability": neg_manipulability, "clearance": neg_clearance}


def measure_of(select: Selection) -> Measure:
    """The measure of a criterion's name, of one with weights, or of somebody's own criterion.

    Raises:
        UnknownName: If there is no criterion of that name.
    """
    if isinstance(select, Weighted):
        return partial(_weighted, select)
    if not isinstance(select, str):
        return _measured_by(select)
    if select not in CRITERIA:
        raise UnknownName("selection", select, {"first", *CRITERIA})
    return CRITERIA[select]


def weights_of(select: Weighted, names: tuple[str, ...]) -> Array:
    """Weights (n,) of coordinates by their names.

    Raises:
        UnknownName: A joint is not among them.
    """
    for name in select.joints:
        if name not in names:
            raise UnknownName("joint of the chain", name, set(names))
    return np.array([select.joints.get(name, 1.0) for name in names])


def _weighted(select: Weighted, problem: IKProblem, X: Array, x0: Array) -> Array:
    """The measure of a criterion with weights."""
    return WEIGHTED[select.criterion](problem, X, x0, weights_of(select, problem.chain.names))


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


def wished(problem: IKProblem, X: Array, x0: Array) -> Array:
    """What is missing (k,) of the problem's wishes at X (k, n): half the square of their weighted residual."""
    residuals = [problem.wishes.residual(problem.placed(x)) for x in X]
    missing: Array = 0.5 * np.square(residuals).sum(axis=1)
    return missing


def turned(problem: IKProblem, x: Array, x0: Array, measure: Measure) -> Array:
    """Coordinates (n,) with each winding angle moved by whole turns to where the measure is least, the goals being met.

    A pose does not depend on whole turns of a joint; postures and distances from limits do.
    """
    limits, best = problem.limits, float(measure(problem, x[None], x0)[0])
    for c in np.flatnonzero(limits.multi_turn & ~limits.periodic):
        for turn in (2.0 * np.pi, -2.0 * np.pi):
            while limits.lower[c] <= x[c] + turn <= limits.upper[c]:
                tried = x.copy()
                tried[c] += turn
                value = float(measure(problem, tried[None], x0)[0])
                if value >= best or not problem.goals.met(problem.placed(tried)):
                    break
                x, best = tried, value
    return x


def slide(problem: IKProblem, x: Array, x0: Array, measure: Measure, descent: Descent) -> Array:
    """Better coordinates (n,) by the measure, reached from a solution x (n,) without leaving the targets.

    Steps in the null space of the Jacobian, over the joints that their limits leave free, each put back onto the
    targets by the refiner (Rosen's gradient projection, 1961): of steepest descent, or those of Gauss and Newton for
    wishes. Returns x itself where the targets leave no freedom.
    """
    best = float(measure(problem, x[None], x0)[0])
    length = FIRST_STEP
    step = _towards_wishes if measure is wished else partial(_steepest, measure, x0)
    for _ in range(STEPS):
        way = _freely(problem, x, step(problem, x))
        size = float(np.linalg.norm(way))
        if not FLAT <= size < math.inf:
            return x
        length = min(length, size)
        while True:
            refined = descent.refine(problem, problem.limits.clip(x + length / size * way)[None], BACK)
            value = float(measure(problem, refined.x[None], x0)[0])
            if refined.met and value < best:
                break
            length *= 0.5
            if length <= LAST_STEP:
                return x
        gained, x, best = best - value, refined.x, value
        if gained <= LITTLE * best:
            return x
    return x


def _steepest(measure: Measure, x0: Array, problem: IKProblem, x: Array) -> Step:
    """Steps of steepest descent of a measure, as long as the first one may be."""
    best = float(measure(problem, x[None], x0)[0])
    gradient = (measure(problem, x + NUDGE * np.eye(len(x)), x0) - best) / NUDGE

    def step(N: Array) -> Array:
        downhill = -N @ (N.T @ gradient)
        size = float(np.linalg.norm(downhill))
        return downhill * (FIRST_STEP / size if size >= FLAT else 0.0)

    return step


def _towards_wishes(problem: IKProblem, x: Array) -> Step:
    """Steps of Gauss and Newton for the residual of the problem's wishes."""
    at = problem.placed(x)
    r, J = problem.wishes.residual(at), problem.wishes.jacobian(at)

    def step(N: Array) -> Array:
        return -N @ (np.linalg.pinv(J @ N, rcond=SINGULAR) @ r)

    return step


def _freely(problem: IKProblem, x: Array, step: Step) -> Array:
    """A step (n,) in the null space of the goals, by no joint that is near a limit and would come nearer."""
    J, limits = problem.linearize(x)[1].T, problem.limits
    free = np.ones(len(x), dtype=bool)
    while True:
        N = np.zeros((len(x), 0))
        if free.any():
            _, sigma, Vt = np.linalg.svd(J[:, free])
            basis = Vt[int((sigma > RANK_TOLERANCE * sigma.max(initial=0.0)).sum()) :].T
            N = np.zeros((len(x), basis.shape[1]))
            N[free] = basis
        way = step(N)
        falls, rises = x <= limits.lower + LAST_STEP, x >= limits.upper - LAST_STEP
        crosses = (falls & (way < -FLAT)) | (rises & (way > FLAT))
        if not crosses.any():
            return way
        free &= ~crosses
