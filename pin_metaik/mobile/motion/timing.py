"""From a path to a trajectory: the quickest of its form, or the one of the paper's method."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.interrupts import wrapped
from pin_metaik.mobile.motion.learned import LearnedCorners, LearnedTurn, learn_turn
from pin_metaik.mobile.motion.result import Method, TrajectoryPlan
from pin_metaik.mobile.motion.route import Route
from pin_metaik.mobile.motion.speeds import Speeds, optimal_speeds, searched_speeds
from pin_metaik.mobile.motion.straight import straight_phases
from pin_metaik.mobile.motion.trajectory import Phase, Trajectory
from pin_metaik.mobile.motion.turn import turn_phases
from pin_metaik.mobile.motion.vehicle import NOMAD_200, SynchroDrive, Vehicle
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.world.polygons import read_obstacles
from pin_metaik.optimize import Budget, Metaheuristic
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.settings import one_of, within
from pin_metaik.randomness import repeatable
from pin_metaik.watching import Watch

SEARCH = DE(agents=30)  # with best/1/bin it stops early: up to 3 % too slow with nine corners
SEARCH_BUDGET = Budget(evaluations=30 * 500)


@checked
def plan_trajectory(
    path: Path | ArrayLike,
    vehicle: Vehicle = NOMAD_200,
    obstacles: Any = (),
    *,
    method: Method = "dp",
    radius: float | None = None,
    algorithm: str | Metaheuristic = SEARCH,
    budget: Budget = SEARCH_BUDGET,
    rng: int | np.random.Generator | None = 0,
    model: LearnedTurn | None = None,
    watch: Watch | None = None,
) -> TrajectoryPlan:
    """Plan the quickest motion of straights and turns along a polyline, from rest to rest.

    A turn cuts its corner on the side where the obstacle is. A path that keeps only the radius from the obstacles
    leaves little room for it, and at a corner without room the robot stops: plan the path with a margin.

    Args:
        path: A polyline, or its points (n, 2) in m.
        vehicle: The robot and its limits.
        obstacles: Polygons, lines and points, not grown: anything ``read_obstacles`` takes.
        method: ``dp`` finds the optimal speeds by dynamic programming; ``de`` searches for them by a metaheuristic;
            ``ann`` searches with a network's tangent lengths, as the paper does, and executes the result with exact
            turns.
        radius: Distance of the robot's centre from obstacles, in m; default: the robot's radius.
        algorithm: The metaheuristic, for ``de`` and ``ann``.
        budget: Budget of the search.
        rng: Seed or generator; ``None`` is a fixed seed.
        model: The network for ``ann``; default: a new one, which takes a second to train.
        watch: Called after every generation of the search with the evaluations done and in all; returning True ends it.

    Raises:
        InvalidSetting: No such method, or a radius below zero.
        InvalidGeometry: A malformed path, or one that turns back by 180 degrees; a malformed obstacle.
        Interrupted: Ctrl-C, after the first generation of a search; its ``result`` is the plan with the best speeds.
    """
    one_of("method", method, Method)
    if model is not None and model.vehicle != vehicle:
        raise InvalidSetting(f"the network was learned for {model.vehicle}, not for {vehicle}")
    keep = vehicle.radius if radius is None else radius
    within("radius", keep, 0)
    if method == "ann" and not isinstance(vehicle, SynchroDrive):
        raise InvalidSetting(f"ann: networks are learned for a SynchroDrive, which {vehicle.name} is not; use dp or de")
    if method == "ann" and isinstance(vehicle, SynchroDrive):
        model = model or learn_turn(vehicle)
    solid = read_obstacles(obstacles)
    began = perf_counter()
    if not isinstance(path, Path):
        path = Path(array("path", path, "n", 2, error=InvalidGeometry))
    route = Route.along(path, vehicle, solid, keep)
    turns = model.at(np.abs(route.turns)) if method == "ann" and model is not None else None

    def planned(speeds: Speeds) -> TrajectoryPlan:
        took = perf_counter() - began
        return TrajectoryPlan(
            trajectory=drive(route, speeds.v, None if turns is None else turns.tangents(speeds.v[None])[0]),
            route=route,
            v=speeds.v,
            method=method,
            obstacles=solid,
            radius=keep,
            evaluations=speeds.evaluations,
            seconds=took,
            seed=repeatable(rng),
            interrupted=speeds.interrupted,
            learned=None if turns is None else turns.report(speeds.v),
            goal=tuple(route.path.points[-1].tolist()),
        )

    return wrapped(lambda: _speeds(route, method, algorithm, budget, rng, turns, watch), planned)


def drive(route: Route, v: Array, tangents: Array | None = None) -> Trajectory:
    """The motion along a route with speeds v (n,) in its corners.

    Args:
        route: The route.
        v: Feasible speeds, m/s.
        tangents: How long before each corner the turn begins (n,), in m; default: the true tangent length. With any
            other the robot leaves its path.
    """
    straights = route.straights(v[None], None if tangents is None else tangents[None])[0]
    start, goal = route.ends
    ends = np.concatenate(([start], v, [goal]))
    phases: list[Phase] = []
    for i, length in enumerate(straights):
        phases += [Phase(t, a) for t, a in straight_phases(float(length), ends[i], ends[i + 1], route.vehicle)]
        if i < len(v):
            omega = 0.0
            for t, alpha in turn_phases(float(route.turns[i]), route.vehicle, float(v[i])):
                phases.append(Phase(t, 0.0, alpha, omega))
                omega += alpha * t
    dx, dy = route.path.points[1] - route.path.points[0]
    return Trajectory(phases, (*route.path.points[0].tolist(), float(np.arctan2(dy, dx))), start)


def _speeds(
    route: Route,
    method: Method,
    algorithm: str | Metaheuristic,
    budget: Budget,
    rng: int | np.random.Generator | None,
    turns: LearnedCorners | None,
    watch: Watch | None,
) -> Speeds:
    """The speeds by a method; with a network's ``turns``, those that it takes to be the quickest."""
    if method == "dp":
        return optimal_speeds(route)
    if turns is None:
        return searched_speeds(route, algorithm, budget, rng, watch=watch)
    return searched_speeds(route, algorithm, budget, rng, turns.tangents, watch, turns.slowest)
