"""The speeds at the corners of a route: the best by dynamic programming, or what a metaheuristic finds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pin_metaik.interrupts import wrapped
from pin_metaik.mobile.motion import speed_kernels as kernels
from pin_metaik.mobile.motion.route import Route
from pin_metaik.optimize import AskTell, Box, Budget, Metaheuristic, Status, minimize
from pin_metaik.optimize.space import Array

COARSE, FINE = 201, 41  # speeds a corner, in the first round and in those that look closer
SHRINK, ROUNDS = 0.45, 22  # the window becomes so much smaller, so often: down to 1e-7 of the cap

Tangents = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Speeds:
    """Speeds at the corners and the time they take.

    Attributes:
        v: (n,) in m/s.
        time: In s, turns included.
        evaluations: Times computed.
        interrupted: Whether the search was stopped.
    """

    v: Array
    time: float
    evaluations: int
    interrupted: bool = False


def optimal_speeds(route: Route) -> Speeds:
    """The best speeds: only neighbours share a straight, so dynamic programming over grids finds them.

    The grid closes in on the best choice of the round before, which it contains: the time never rises.
    """
    vehicle, n = route.vehicle, len(route.caps)
    if n == 0:
        return Speeds(np.empty(0), route.stop_and_turn, 1)
    v = np.empty(n)
    grid = route.caps[:, None] * np.linspace(0, 1, COARSE)  # (n, m)
    spent = grid.size
    time = kernels.best_speeds(route.lengths, route.g, grid, vehicle.a_max, vehicle.v_max, v)
    window = 2 * route.caps / (COARSE - 1)
    offsets = np.linspace(-1, 1, FINE)  # its middle is 0: the best so far
    for _ in range(ROUNDS):
        grid = np.clip(v[:, None] + window[:, None] * offsets, 0, route.caps[:, None])
        time = min(time, kernels.best_speeds(route.lengths, route.g, grid, vehicle.a_max, vehicle.v_max, v))
        spent += grid.size
        window *= SHRINK
    return Speeds(v, time + route.turning, spent)


def searched_speeds(
    route: Route,
    algorithm: str | Metaheuristic,
    budget: Budget,
    rng: int | np.random.Generator | None,
    tangents: Tangents | None = None,
    callback: Callable[[AskTell], bool | None] | None = None,
    lower: float = 0.0,
) -> Speeds:
    """The speeds a metaheuristic finds; stopping at every corner is its first individual, so it ends feasible.

    Args:
        route: The route.
        algorithm: By name or as an object.
        budget: What it may spend; an evaluation is one choice of all speeds.
        rng: Seed or generator.
        tangents: Tangent lengths (k, n) at speeds V (k, n), if not the true ones.
        callback: Called after every generation.
        lower: Speeds below this are a stop.

    Raises:
        Interrupted: Ctrl-C, after the first generation; its ``result`` is the best speeds so far.
    """
    n, stop = len(route.caps), route.stop_and_turn
    if n == 0:
        return Speeds(np.empty(0), stop, 1)

    def driven(V: Array) -> Array:
        return np.where(lower <= V, V, 0.0)

    def costs(V: Array) -> Array:
        V = driven(V)
        lengths = None if tangents is None else tangents(V)
        T = route.times(V, lengths)
        lack = route.lack(V, lengths)
        return np.where(np.isfinite(T), T, 2 * stop + lack)

    box, stopping = Box(np.zeros(n), route.caps), np.zeros((1, n))
    return wrapped(
        lambda: minimize(costs, box, algorithm, budget, rng, seeds=stopping, callback=callback),
        lambda found: Speeds(driven(found.x), found.cost, found.evaluations, found.status is Status.INTERRUPTED),
    )
