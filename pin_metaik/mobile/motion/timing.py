"""From a path to a trajectory: the quickest of its form, or what the paper's method makes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import ArrayLike

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.motion.learned import LearnedTurn, TurnReport, learn_turn
from pin_metaik.mobile.motion.route import Route, keeps_clear
from pin_metaik.mobile.motion.speeds import Speeds, optimal_speeds, searched_speeds
from pin_metaik.mobile.motion.straight import straight_phases
from pin_metaik.mobile.motion.trajectory import SAMPLES, Phase, Trajectory
from pin_metaik.mobile.motion.turn import turn_phases
from pin_metaik.mobile.motion.vehicle import NOMAD_200, SynchroDrive
from pin_metaik.mobile.paths.path import Path
from pin_metaik.optimize import AskTell, Budget, Metaheuristic
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.settings import one_of, within
from pin_metaik.optimize.space import Array

Method = Literal["dp", "de", "ann"]

SEARCH = DE(agents=30, strategy="best/1/bin")
SEARCH_BUDGET = Budget(evaluations=30 * 300)
ROOM = 1e-6  # m; as much too near still keeps the radius
ARRIVED = 1e-5  # m
DENSE = 1e-3  # s; half a millimetre to the next sample, at a distance of 0.2 m less than 1e-6 m are missed

OPTIMALITY = "quickest of the trajectories of straights and constant-speed curves on this path, not of all trajectories"


@dataclass(frozen=True, eq=False)
class TrajectoryPlan:
    """A trajectory along a path, and what is to be known about it.

    Attributes:
        trajectory: The motion, as the robot would execute it.
        route: The path with its turns and the speeds that its corners allow.
        v: Speed in each corner (n,), m/s; 0 is stop and turn.
        method: ``dp``, ``de`` or ``ann``.
        obstacles: What it has to keep clear of.
        radius: Distance to keep, m.
        evaluations: Times computed in the search for the speeds.
        seconds: Time taken for planning, s; without learning.
        seed: Of every random choice; None if a generator was handed in.
        interrupted: Whether the search was stopped.
        learned: What the network's errors do, if one was used.
    """

    trajectory: Trajectory
    route: Route
    v: Array
    method: Method
    obstacles: tuple[shapely.Polygon, ...]
    radius: float
    evaluations: int
    seconds: float
    seed: int | None
    interrupted: bool
    learned: TurnReport | None

    @property
    def time(self) -> float:
        """Duration, s."""
        return self.trajectory.duration

    @property
    def stop_and_turn(self) -> float:
        """Duration, s, of the trajectory that stops at every corner: the fall-back that is always feasible."""
        return self.route.stop_and_turn

    @property
    def end_error(self) -> float:
        """Distance, m, of the trajectory's end from the goal."""
        x, y, _ = self.trajectory.end
        return float(np.hypot(*(np.array([x, y]) - self.route.path.points[-1])))

    @cached_property
    def clearance(self) -> float:
        """Least distance, m, of the robot's centre from an obstacle; inf without obstacles."""
        if not self.obstacles:
            return float("inf")
        return float(shapely.distance(self._places, shapely.union_all(self.obstacles)).min())

    @cached_property
    def collision_free(self) -> bool:
        """Whether the trajectory keeps the radius."""
        return not self.obstacles or keeps_clear(self._places, shapely.union_all(self.obstacles), self.radius, ROOM)

    @cached_property
    def _places(self) -> list[shapely.Geometry]:
        """Where the robot is: straights as a whole, curves as samples so dense that they miss less than 1e-6 m."""
        ends = self.trajectory.at(self.trajectory.boundaries).xy
        straights = [shapely.LineString(ends[i : i + 2]) for i, p in enumerate(self.trajectory.phases) if p.straight]
        samples = self.trajectory.sample(DENSE)
        curves = shapely.points(samples.xy[(samples.alpha != 0) | (samples.omega != 0)])
        return [shapely.Point(ends[0]), *straights, *curves]

    @property
    def success(self) -> bool:
        """Whether it keeps the radius and gets to the goal; the network's does so within its own error."""
        return self.collision_free and (self.learned is not None or self.end_error <= ARRIVED)

    @property
    def notes(self) -> list[str]:
        """What a user should know, in sentences."""
        stops = [str(i + 1) for i, v in enumerate(self.v) if v == 0]
        tight = [str(i + 1) for i, cap in enumerate(self.route.caps) if cap == 0]
        said = [OPTIMALITY] if self.method == "dp" else []
        if tight:
            said.append(f"no room to turn while moving at corner {', '.join(tight)}: plan the path with a margin")
        if stops:
            said.append(f"stops and turns at corner {', '.join(stops)}")
        if self.learned is not None:
            said.append(str(self.learned))
            said.append(f"because of that the robot ends {1e3 * self.end_error:.3g} mm from the goal")
        if not self.collision_free:
            said.append(
                f"comes within {self.clearance:.4g} m of an obstacle, the radius is {self.radius:g} m: not a solution"
            )
        return said

    def as_dict(self, dt: float = SAMPLES) -> dict[str, Any]:
        """Plain values, for JSON, with the samples."""
        vehicle, clearance = self.route.vehicle, self.clearance
        return {
            "method": self.method,
            "success": self.success,
            "collision_free": self.collision_free,
            "time": self.time,
            "stop_and_turn": self.stop_and_turn,
            "path": self.route.path.points.tolist(),
            "turns": self.route.turns.tolist(),
            "speeds": self.v.tolist(),
            "speed_caps": self.route.caps.tolist(),
            "end_error": self.end_error,
            "clearance": clearance if np.isfinite(clearance) else None,
            "radius": self.radius,
            "vehicle": {name: getattr(vehicle, name) for name in vehicle.__dataclass_fields__},
            "seed": self.seed,
            "notes": self.notes,
            "samples": self.trajectory.as_dict(dt),
        }

    def __str__(self) -> str:
        return (
            f"{self.time:.3f} s ({self.method}); {self.stop_and_turn:.3f} s with a stop at every corner; speeds in the "
            f"corners: {', '.join(f'{v:.3f}' for v in self.v) or 'none'} m/s"
        )


def plan_trajectory(
    path: Path | ArrayLike,
    vehicle: SynchroDrive = NOMAD_200,
    obstacles: Sequence[shapely.Polygon] = (),
    *,
    method: Method = "dp",
    radius: float | None = None,
    algorithm: str | Metaheuristic = SEARCH,
    budget: Budget = SEARCH_BUDGET,
    rng: int | np.random.Generator | None = 0,
    model: LearnedTurn | None = None,
    callback: Callable[[AskTell], bool | None] | None = None,
) -> TrajectoryPlan:
    """Plan the quickest motion of straights and curves along a polyline, from rest to rest.

    Curves lie inside their corners, where the obstacle is: a path that touches the obstacles grown by the radius leaves
    no room for them, and the robot stops at every corner. Plan the path with a margin.

    Args:
        path: A polyline, or its points (n, 2) in m.
        vehicle: The robot and its limits.
        obstacles: Polygons, not grown.
        method: ``dp`` finds the best speeds; ``de`` searches for them; ``ann`` searches with the network's tangent
            lengths, as the paper, and executes what comes out with the true turns.
        radius: Distance of the robot's centre from obstacles, in m; default: the robot's radius.
        algorithm: What searches, for ``de`` and ``ann``.
        budget: What it may spend.
        rng: Seed or generator.
        model: The network for ``ann``; default: a new one, learned in a second.
        callback: Called after every generation of the search.

    Raises:
        InvalidSetting: No such method, or a radius below zero.
        InvalidGeometry: A path that is none, or that turns back by 180 degrees.
    """
    one_of("method", method, Method)
    if model is not None and model.vehicle != vehicle:
        raise InvalidSetting(f"the network was learned for {model.vehicle}, not for {vehicle}")
    keep = vehicle.radius if radius is None else radius
    within("radius", keep, 0)
    if method == "ann":
        model = model or learn_turn(vehicle)
    began = perf_counter()
    route = Route.along(path if isinstance(path, Path) else Path(np.asarray(path)), vehicle, obstacles, keep)
    lengths, report, speeds = _solve(route, method, algorithm, budget, rng, model, callback)
    took = perf_counter() - began
    return TrajectoryPlan(
        trajectory=drive(route, speeds.v, lengths),
        route=route,
        v=speeds.v,
        method=method,
        obstacles=tuple(obstacles),
        radius=keep,
        evaluations=speeds.evaluations,
        seconds=took,
        seed=int(rng) if isinstance(rng, (int, np.integer)) else None,
        interrupted=speeds.interrupted,
        learned=report,
    )


def drive(route: Route, v: Array, tangents: Array | None = None) -> Trajectory:
    """The motion along a route with speeds v (n,) in its corners.

    Args:
        route: The route.
        v: Feasible speeds, m/s.
        tangents: How long before each corner the turn begins (n,), in m; default: the true tangent length. With any
            other the robot leaves its path.
    """
    straights = route.straights(v[None], None if tangents is None else tangents[None])[0]
    ends = np.concatenate(([0.0], v, [0.0]))
    phases: list[Phase] = []
    for i, length in enumerate(straights):
        phases += [Phase(t, a) for t, a in straight_phases(float(length), ends[i], ends[i + 1], route.vehicle)]
        if i < len(v):
            omega = 0.0
            for t, alpha in turn_phases(float(route.turns[i]), route.vehicle):
                phases.append(Phase(t, 0.0, alpha, omega))
                omega += alpha * t
    dx, dy = route.path.points[1] - route.path.points[0]
    return Trajectory(phases, (*route.path.points[0].tolist(), float(np.arctan2(dy, dx))))


def _solve(
    route: Route,
    method: Method,
    algorithm: str | Metaheuristic,
    budget: Budget,
    rng: int | np.random.Generator | None,
    model: LearnedTurn | None,
    callback: Callable[[AskTell], bool | None] | None,
) -> tuple[Array | None, TurnReport | None, Speeds]:
    """Tangent lengths if they are not the true ones, the network's report, and the speeds."""
    match method:
        case "dp":
            return None, None, optimal_speeds(route)
        case "de":
            return None, None, searched_speeds(route, algorithm, budget, rng, callback=callback)
        case "ann":
            assert model is not None
            turns = model.at(np.abs(route.turns))
            speeds = searched_speeds(route, algorithm, budget, rng, turns.tangents, callback, turns.slowest)
            lengths = turns.tangents(speeds.v[None])[0]
            return lengths, turns.report(speeds.v), speeds
