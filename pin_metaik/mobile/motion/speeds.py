"""The speeds at the corners of a route: the best by dynamic programming, or the best that a metaheuristic finds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.interrupts import wrapped
from pin_metaik.mobile.motion import speed_kernels as kernels
from pin_metaik.mobile.motion.route import Route
from pin_metaik.mobile.motion.turn import lead_time
from pin_metaik.optimize import Box, Budget, Metaheuristic, Status, minimize
from pin_metaik.watching import Watch

COARSE, FINE = 101, 17  # speeds a corner, in the first round and in those that look closer
SHRINK, SMALLEST = 0.45, 1e-9  # how much smaller a window becomes, and where it ends, of the cap
ROUNDS = 80  # at most; 25 if no window has to follow its best
NEWTON, STEP = 4, 1e-6  # iterations, and what derivatives are differences over, of the speed
CHAIN = 3  # corners that full acceleration or no straight at all may tie to one before

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


def optimal_speeds(route: Route, rounds: int = ROUNDS) -> Speeds:
    """The best speeds by dynamic programming over grids: only neighbours share a straight.

    The grid closes in on the best choice of the round before, which it contains: the time never rises. Where a straight
    is as short as it may be, its two speeds can only move together, along a line that no grid of single speeds follows:
    so every grid has the speeds, too, that are the largest possible after those of the corners before. A window becomes
    smaller only once its best is well inside. A few rounds are enough to tell routes apart.
    """
    vehicle, n = route.vehicle, len(route.caps)
    if n == 0:
        return Speeds(np.empty(0), route.stop_and_turn, 1)
    v, time, spent = np.empty(n), np.inf, 0
    centre, window = route.caps / 2, route.caps / 2
    for count in (COARSE, *[FINE] * rounds):
        single = centre[:, None] + window[:, None] * np.linspace(-1, 1, count)  # its middle is the best so far
        grid = _tied(route, np.clip(single, 0, route.caps[:, None]))
        tangents, turning = (np.ascontiguousarray(of.T) for of in (route.tangents(grid.T), route.turning(grid.T)))
        ends = np.array(route.ends)
        found = kernels.best_speeds(route.lengths, ends, grid, tangents, turning, vehicle.a_max, vehicle.v_max, v)
        spent += grid.size
        inside = np.abs(v - centre) <= window / 2
        window = np.where(inside, SHRINK * window, window) if count == FINE else 2 * window / (COARSE - 1)
        centre, time = v.copy(), min(time, found)
        if (window <= SMALLEST * route.caps).all():
            break
    return Speeds(v, time, spent)


def _tied(route: Route, grid: Array) -> Array:
    """A grid (n, m) of speeds, and for each corner the largest that are possible after the speeds of those before."""
    n, m = grid.shape
    tied = np.tile(grid, (1, CHAIN + 1))
    for i in range(1, n):
        before = tied[i - 1, : CHAIN * m]
        tied[i, m:] = _largest_after(route, i, before)
    return np.ascontiguousarray(tied)


def _largest_after(route: Route, i: int, u: Array) -> Array:
    """The largest speeds at corner i after speeds u (k,) at the one before: all of the straight is acceleration.

    Or braking, if there is less room than for that; 0 if there is no speed at all. Of a differential drive tangent
    lengths are not quite proportional to speeds: there this is Newton's method.
    """
    a, vehicle = route.vehicle.a_max, route.vehicle
    before, turn = (float(abs(route.turns[k])) for k in (i - 1, i))
    room = route.lengths[i] - (u * lead_time(before, vehicle, u) if vehicle.coupled else u * route.g[i - 1])
    v, g, fixed = np.full_like(u, route.caps[i]), np.full_like(u, route.g[i]), np.zeros_like(u)
    for _ in range(NEWTON if vehicle.coupled else 1):
        if vehicle.coupled:  # tangent length near v: fixed + g v
            tangent, nearby = v * lead_time(turn, vehicle, v), (1 - STEP) * v * lead_time(turn, vehicle, (1 - STEP) * v)
            g = np.divide(tangent - nearby, STEP * v, out=g, where=v > 0)
            fixed = tangent - g * v
        s = room - fixed  # for the straight and what of this corner's tangent length grows with its speed
        up = a * (np.sqrt(g**2 + 2 / a * np.maximum(s + u**2 / (2 * a), 0)) - g)  # s - g v = (v^2 - u^2) / 2a
        root = g**2 - 2 / a * (s - u**2 / (2 * a))  # s - g v = (u^2 - v^2) / 2a
        down = a * (g - np.sqrt(np.maximum(root, 0)))
        v = np.clip(np.where(up >= u, up, np.where(root >= 0, down, 0.0)), 0.0, route.caps[i])
    return v


def searched_speeds(
    route: Route,
    algorithm: str | Metaheuristic,
    budget: Budget,
    rng: int | np.random.Generator | None,
    tangents: Tangents | None = None,
    watch: Watch | None = None,
    lower: float = 0.0,
) -> Speeds:
    """The speeds a metaheuristic finds; stopping at every corner is its first individual, so it ends feasible.

    Args:
        route: The route.
        algorithm: By name or as an object.
        budget: Budget of the search; an evaluation is one choice of all speeds.
        rng: Seed or generator; ``None`` is a fixed seed.
        tangents: Tangent lengths (k, n) at speeds V (k, n), if not the true ones.
        watch: Called after every generation of the search with evaluations done and in all; True ends it.
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
        lambda: minimize(costs, box, algorithm, budget, rng, seeds=stopping, watch=watch),
        lambda found: Speeds(driven(found.x), found.cost, found.evaluations, found.status is Status.INTERRUPTED),
    )
