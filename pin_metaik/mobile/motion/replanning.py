"""Trajectories that begin and end in motion, and planning again on the way without a stop."""

from __future__ import annotations

from itertools import product
from time import perf_counter
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile.errors import Blocked, NoPath, NoRoom
from pin_metaik.mobile.motion.joining import Joining, backwards, joining, straightening
from pin_metaik.mobile.motion.result import TrajectoryPlan
from pin_metaik.mobile.motion.route import Route
from pin_metaik.mobile.motion.speeds import ROUNDS, optimal_speeds
from pin_metaik.mobile.motion.timing import drive
from pin_metaik.mobile.motion.trajectory import State, Trajectory
from pin_metaik.mobile.motion.vehicle import NOMAD_200, Vehicle
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.world.growth import Join
from pin_metaik.mobile.world.polygons import read_obstacles
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.optimize.settings import few, within

SPEEDS = 4  # tried at either end, besides the state's own
FEW, NEAR = 5, 1e-3  # rounds of a search for speeds that only compares, and how near to the best it surely is
PASSES, SETTLED = 60, 1e-13  # at most, until the two ends of a path without corners see each other; m
ROUNDING = 1e-9  # of the largest speed and turning rate; a state read from a trajectory may be as much beyond them
MARGIN = 0.1  # m


@checked
def plan_in_motion(
    path: Path | ArrayLike,
    vehicle: Vehicle = NOMAD_200,
    obstacles: Any = (),
    *,
    start: State,
    goal: State | None = None,
    radius: float | None = None,
) -> TrajectoryPlan:
    """Plan a motion along a polyline from one state (with heading, speed and turning rate) to another.

    The robot continues from the state without a jump: if needed straight on to another speed, then turning at that
    speed until it heads for the first corner; the same in reverse at the goal. Several such speeds are tried; the
    speeds at the corners between are optimal for them; and the quickest motion that keeps the radius is returned. If
    none keeps it, the quickest of all is returned, with ``success`` False.

    Args:
        path: A polyline, or its points (n, 2) in m; only its corners are used, as start and goal are those of the
            states.
        vehicle: The robot and its limits.
        obstacles: Polygons, lines and points, not grown: anything ``read_obstacles`` takes.
        start: The state it begins in.
        goal: Pose and speed at the end; default: at rest at the end of the path, with any heading.
        radius: Distance of the robot's centre from obstacles, in m; default: the robot's radius.

    Raises:
        InvalidSetting: A state beyond the robot's limits, a goal state with a turning rate, or a radius below zero.
        InvalidGeometry: A malformed path or obstacle.
        NoRoom: No motion of this form leads from the state onto the path.
    """
    keep = vehicle.radius if radius is None else radius
    within("radius", keep, 0)
    _within_limits("start", start, vehicle)
    if goal is not None:
        _within_limits("goal", goal, vehicle)
        if goal.omega:
            raise InvalidSetting(f"goal: the turning rate at the end is 0, got omega = {goal.omega!r}")
    solid = read_obstacles(obstacles)
    if not isinstance(path, Path):
        path = Path(array("path", path, "n", 2, error=InvalidGeometry))
    best = _quickest(path, vehicle, solid, start, goal, keep)
    if best is None:
        raise _no_room(start, vehicle, keep)
    return best


@checked
def replan(
    scene: Scene,
    vehicle: Vehicle = NOMAD_200,
    *,
    start: State,
    goal: State | None = None,
    margin: float = MARGIN,
    paths: int = 3,
    join: Join | None = None,
) -> TrajectoryPlan:
    """Plan again from a state in motion to the scene's goal, or to another one, in a scene that may have changed.

    Paths are planned from where the robot is, and from where it would stop if it braked; of all of them the quickest
    motion that keeps the robot's radius is returned. Where the robot is nearer to an obstacle than the margin, as it
    may be in a curve, the path begins at the nearest position that has the margin.

    Args:
        scene: The scene; its start is not used.
        vehicle: The robot and its limits.
        start: The present state, e.g. ``plan.trajectory.state(t)``.
        goal: Pose and speed at the end; default: at rest at the scene's goal, with any heading.
        margin: Distance, in m, that paths keep in addition to the robot's radius.
        paths: How many homotopy classes to try from each of the two positions.
        join: How corners of grown obstacles are joined; see ``PathProblem.of``.

    Raises:
        InvalidSetting: A state beyond the robot's limits, a goal state with a turning rate, or a margin below zero.
        Blocked: The robot cannot be at the goal.
        NoPath: There is no path.
        NoRoom: None of the motions tried keeps clear of the obstacles, e.g. because the robot cannot stop in time.
    """
    few("paths", paths)
    within("margin", margin, 0)
    _within_limits("start", start, vehicle)
    end = scene.goal if goal is None else (goal.x, goal.y)
    x, y, _ = Trajectory(straightening(start, 0.0, vehicle), start.pose, start.v).end
    best: TrajectoryPlan | None = None
    failure: NoPath | NoRoom = _no_room(start, vehicle, vehicle.radius)
    for place in dict.fromkeys([(start.x, start.y), (x, y)]):
        try:
            found = _paths(scene, place, end, vehicle.radius, margin, paths, join)
        except NoPath as error:
            failure = error
            continue
        for path in (shorter for whole in found for shorter in _begun(whole)):
            limit = np.inf if best is None else best.time
            plan = _quickest(path, vehicle, scene.obstacles, start, goal, vehicle.radius, limit)
            best = plan if plan is not None and plan.success and plan.time < limit else best
    if best is None:
        raise failure
    return best


def _paths(
    scene: Scene,
    start: tuple[float, float],
    goal: tuple[float, float],
    radius: float,
    margin: float,
    count: int,
    join: Join | None,
) -> list[Path]:
    """The shortest paths of the best homotopy classes from a place, or from the nearest that has the margin."""
    try:
        problem = PathProblem.of(scene.between(start, goal), radius, margin, join)
    except Blocked as blocked:
        if blocked.role != "start" or blocked.nearest is None:
            raise
        problem = PathProblem.of(scene.between(blocked.nearest, goal), radius, margin, join)
    return problem.alternatives(count)


def _begun(path: Path) -> list[Path]:
    """A path, and the same without its first corner, which a robot in a curve may have behind it."""
    return [path] if len(path.corners) == 0 else [path, Path(np.delete(path.points, 1, axis=0))]


def _quickest(
    path: Path,
    vehicle: Vehicle,
    solid: tuple[shapely.Geometry, ...],
    start: State,
    goal: State | None,
    keep: float,
    limit: float = np.inf,
) -> TrajectoryPlan | None:
    """The quickest collision-free motion within a limit in s; else the first motion that collides; None without any.

    Obstacles make corners slower, so the time without them is a bound: motions are made for the best bounds first,
    until the next bound is no better than what is found.
    """
    began = perf_counter()
    corners = path.corners if len(path.corners) else np.empty((0, 2))
    last = path.points[-1]

    def made(
        ends: tuple[Joining, Joining | None], obstacles: tuple[shapely.Geometry, ...], rounds: int
    ) -> TrajectoryPlan | None:
        on, off = ends
        points = np.vstack((on.end[:2], corners, last if off is None else off.end[:2]))
        route = Route.along(Path(points), vehicle, obstacles, keep, (on.v, 0.0 if off is None else off.v))
        speeds = optimal_speeds(route, rounds)
        if not np.isfinite(speeds.time):
            return None
        away = [] if off is None else backwards(off.phases)
        return TrajectoryPlan(
            trajectory=Trajectory([*on.phases, *drive(route, speeds.v).phases, *away], start.pose, start.v),
            route=route,
            v=speeds.v,
            method="dp",
            obstacles=obstacles,
            radius=keep,
            evaluations=speeds.evaluations,
            seconds=perf_counter() - began,
            seed=None,
            interrupted=False,
            learned=None,
            goal=(float(last[0]), float(last[1])) if goal is None else (goal.x, goal.y),
            joining=on.time + (0.0 if off is None else off.time),
        )

    firsts = _speeds(start, vehicle)
    finals = [0.0] if goal is None else _speeds(goal, vehicle)
    joined = [_ends(start, first, goal, final, corners, last, vehicle) for first, final in product(firsts, finals)]
    bounds = [(plan.time, ends) for ends in joined if ends is not None and (plan := made(ends, (), FEW)) is not None]
    best: TrajectoryPlan | None = None
    for bound, ends in sorted(bounds, key=lambda entry: entry[0]):
        if bound >= (1 + NEAR) * (best.time if best is not None and best.success else limit):
            break
        plan = made(ends, solid, ROUNDS)
        if plan is not None and (best is None or (plan.success, -plan.time) > (best.success, -best.time)):
            best = plan
    return best


def _ends(
    start: State, first: float, goal: State | None, final: float, corners: Array, last: Array, vehicle: Vehicle
) -> tuple[Joining, Joining | None] | None:
    """How the robot gets onto the first straight and, seen from behind, onto the last; without corners they are one."""
    turned = None if goal is None else State(goal.x, goal.y, goal.heading + np.pi, goal.v)
    ahead = corners[0] if len(corners) else last
    behind = corners[-1] if len(corners) else np.array([start.x, start.y])
    for _ in range(PASSES):
        on = joining(start, first, ahead, vehicle)
        if on is None:
            return None
        if turned is None:
            return on, None
        off = joining(turned, final, behind if len(corners) else np.array(on.end[:2]), vehicle)
        if off is None:
            return None
        if len(corners) or np.hypot(*(ahead - off.end[:2])) <= SETTLED:
            return on, off
        ahead = np.array(off.end[:2])
    return None


def _speeds(state: State, vehicle: Vehicle) -> list[float]:
    """Speeds to turn at, beginning with the state's own."""
    return list(dict.fromkeys([float(state.v), *np.linspace(0, vehicle.v_max, SPEEDS + 1)[:SPEEDS].tolist()]))


def _within_limits(role: str, state: State, vehicle: Vehicle) -> None:
    within(f"{role}: the speed", state.v, 0, vehicle.v_max * (1 + ROUNDING))
    fastest = float(vehicle.omega_at(state.v))
    if abs(state.omega) > fastest * (1 + ROUNDING):
        raise InvalidSetting(
            f"{role}: at {state.v:g} m/s {vehicle.name} turns at {fastest:g} rad/s at most, got {state.omega!r}"
        )


def _no_room(start: State, vehicle: Vehicle, radius: float) -> NoRoom:
    x, y, _ = Trajectory(straightening(start, 0.0, vehicle), start.pose, start.v).end
    return NoRoom((start.x, start.y), start.v, (x, y), radius)
