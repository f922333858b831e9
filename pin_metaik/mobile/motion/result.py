"""A planned trajectory: the motion, its clearance, its end, and remarks for the user."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import shapely

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.motion.learned import TurnReport
from pin_metaik.mobile.motion.route import Route, keeps_clear
from pin_metaik.mobile.motion.trajectory import SAMPLES, Trajectory

Method = Literal["dp", "de", "ann"]

ROOM = 1e-6  # m; as much too near still keeps the radius
ARRIVED, ARRIVED_LEARNED = 1e-5, 0.01  # m; how far from the goal it may end, without and with a network
DENSE = 1e-3  # s; half a millimetre to the next sample, at a distance of 0.2 m less than 1e-6 m are missed

MANY_CORNERS, TUBE = 10, 0.05  # of a path that grids or samplers made; m in which it may be straightened

OPTIMALITY = "quickest of the trajectories of straights and constant-speed curves on this path, not of all trajectories"
JOINED = "quickest of some ways onto the path and off it, each with the best speeds in the corners between"


@dataclass(frozen=True, eq=False)
class TrajectoryPlan:
    """A trajectory along a path, with its clearance, its errors and remarks.

    Attributes:
        trajectory: The motion.
        route: The path with its turns and the speeds that its corners allow.
        v: Speed in each corner (n,), m/s; 0 is stop and turn.
        method: ``dp``, ``de`` or ``ann``.
        obstacles: Obstacles that it has to keep clear of.
        radius: Distance to keep, m.
        evaluations: Durations computed in the search for the speeds.
        seconds: Time taken for planning, s, without the training of a network.
        seed: Seed of every random choice; None if a generator was given.
        interrupted: Whether the search was stopped.
        learned: Effects of the network's errors, if one was used.
        goal: Goal (x, y), m.
        joining: Time, s, of the parts that lead from the start state onto the route and from it to the goal state.
    """

    trajectory: Trajectory
    route: Route
    v: Array
    method: Method
    obstacles: tuple[shapely.Geometry, ...]
    radius: float
    evaluations: int
    seconds: float
    seed: int | None
    interrupted: bool
    learned: TurnReport | None
    goal: tuple[float, float]
    joining: float = 0.0

    @property
    def time(self) -> float:
        """Duration, s."""
        return self.trajectory.duration

    @property
    def stop_and_turn(self) -> float:
        """Duration, s, with a stop at every corner: always feasible from rest to rest; inf if a speed forbids it."""
        return self.joining + self.route.stop_and_turn

    @property
    def end_error(self) -> float:
        """Distance, m, of the trajectory's end from the goal."""
        x, y, _ = self.trajectory.end
        return float(np.hypot(x - self.goal[0], y - self.goal[1]))

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
        """Whether it keeps the radius and reaches the goal; with a network, to within a centimetre."""
        return self.collision_free and self.end_error <= (ARRIVED if self.learned is None else ARRIVED_LEARNED)

    def __bool__(self) -> bool:
        return self.success

    @property
    def notes(self) -> list[str]:
        """Remarks for the user, in sentences."""
        stops = [str(i + 1) for i, v in enumerate(self.v) if v == 0]
        tight = [str(i + 1) for i, cap in enumerate(self.route.caps) if cap == 0]
        said = [JOINED if self.joining else OPTIMALITY] if self.method == "dp" else []
        if tight:
            said.append(f"no room to turn while moving at corner {', '.join(tight)}: plan the path with a margin")
        if stops:
            said.append(f"stops and turns at corner {', '.join(stops)}")
        path = self.route.path
        if len(path.corners) >= MANY_CORNERS:
            fewer = path.simplified(TUBE)
            if 2 * len(fewer.corners) <= len(path.corners):
                said.append(
                    f"{len(path.corners)} corners, each turned by itself: path.simplified({TUBE}) has "
                    f"{len(fewer.corners)}, is quicker to drive, and up to {TUBE} m off the path"
                )
        if self.learned is not None:
            said.append(str(self.learned))
            said.append(f"because of that the robot ends {1e3 * self.end_error:.3f} mm from the goal")
        if not self.collision_free:
            said.append(
                f"comes within {self.clearance:.4g} m of an obstacle, the radius is {self.radius:g} m: not a solution"
            )
        return said

    @checked
    def as_dict(self, dt: float = SAMPLES) -> dict[str, Any]:
        """Plain values, for JSON, with the samples."""
        vehicle, clearance = self.route.vehicle, self.clearance
        return {
            "method": self.method,
            "success": self.success,
            "collision_free": self.collision_free,
            "time": self.time,
            "stop_and_turn": self.stop_and_turn if np.isfinite(self.stop_and_turn) else None,
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
            **self.trajectory.exact(),
            "samples": self.trajectory.as_dict(dt),
        }

    def __str__(self) -> str:
        stops = f"; {self.stop_and_turn:.3f} s with a stop at every corner" if np.isfinite(self.stop_and_turn) else ""
        speeds = ", ".join(f"{v:.3f}" for v in self.v) or "none"
        return f"{self.time:.3f} s ({self.method}){stops}; speeds in the corners: {speeds} m/s"
