"""A path with times: straight lines at one speed, and waits between them; and its clearance, tested independently."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as File
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.moving.obstacle import MovingObstacle
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.output import write_table

ROUNDING = 1e-9  # of the workspace's width; as much nearer still keeps the clearance


@dataclass(frozen=True, eq=False)
class WaitingPath:
    """A path with times among moving obstacles.

    Attributes:
        times: (n,) increasing, s, from ``start_time`` on.
        points: (n, 2) m; between two equal points the robot waits.
        speed: Speed of the robot, m/s.
        problem: The scene at rest, and the clearance.
        moving: The moving obstacles.
        direct: Time, s, that the shortest path takes at this speed if nothing moves; no motion is quicker.
        opened: Number of pairs of a position and a time window that the search expanded.
        seconds: Time taken to plan, s.
    """

    times: Array
    points: Array
    speed: float
    problem: PathProblem
    moving: tuple[MovingObstacle, ...]
    direct: float
    opened: int
    seconds: float

    @property
    def duration(self) -> float:
        """Time from the start, including waiting there, to the goal, s."""
        return float(self.times[-1] - self.times[0])

    @property
    def path(self) -> Path:
        """The path without the times."""
        moved = np.concatenate(([True], np.hypot(*np.diff(self.points, axis=0).T) > 0))
        points = self.points[moved]
        return Path(points if len(points) > 1 else np.repeat(points, 2, axis=0))

    @property
    def waits(self) -> list[tuple[float, float, float]]:
        """Where and for how long it waits: (x, y, duration in s)."""
        stood = np.hypot(*np.diff(self.points, axis=0).T) == 0
        held = np.diff(self.times)[stood]
        return [
            (float(x), float(y), float(t)) for (x, y), t in zip(self.points[:-1][stood], held, strict=True) if t > 0
        ]

    @checked
    def at(self, t: ArrayLike) -> Array:
        """Places (n, 2) at times t (n,), s."""
        asked = np.atleast_1d(array("t", t, "...")).ravel()
        return np.column_stack([np.interp(asked, self.times, self.points[:, i]) for i in (0, 1)])

    @cached_property
    def clearance(self) -> float:
        """Least distance, m, of the robot's centre from a moving obstacle, also after arrival; inf without any.

        While both move at constant velocity, the robot moves along a straight line relative to the obstacle, whose
        distance from the outline is computed exactly: nothing is sampled.
        """
        return min((gap for obstacle in self.moving for gap in self._gaps(obstacle)), default=float("inf"))

    @property
    def collision_free(self) -> bool:
        """Whether it keeps the clearance from all obstacles, at rest and moving."""
        space = self.problem.space
        room = ROUNDING * space.extent
        return space.holds(self.path.points) and self.clearance >= space.clearance - room

    @property
    def success(self) -> bool:
        """Whether it is free of collisions."""
        return self.collision_free

    def __bool__(self) -> bool:
        return self.success

    def _gaps(self, obstacle: MovingObstacle) -> Iterator[float]:
        """Distances from an obstacle over the stretches in which both move evenly."""
        turns = obstacle.way[:, 0]
        stays = max(float(turns[-1]), float(self.times[-1])) + 1.0  # at the goal, for good
        times = np.unique(np.concatenate((self.times, turns[turns > self.times[0]], [stays])))
        seen = self.at(times) - obstacle.at(times)
        outline = obstacle.footprint.at(np.zeros((1, 3)))[0]
        stretches = shapely.linestrings(np.stack((seen[:-1], seen[1:]), axis=1))
        yield from (shapely.distance(stretches, outline) - obstacle.footprint.around).tolist()

    @checked
    def write(self, file: str | File) -> None:
        """Write time, x and y as CSV."""
        write_table(file, ("t", "x", "y"), np.column_stack((self.times, self.points)))

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        clearance = self.clearance
        return {
            "scene": self.problem.scene.name,
            "success": self.success,
            "duration": self.duration,
            "direct": self.direct,
            "speed": self.speed,
            "length": self.path.length,
            "waits": [list(wait) for wait in self.waits],
            "clearance": clearance if np.isfinite(clearance) else None,
            "kept": self.problem.space.clearance,
            "opened": self.opened,
            "seconds": self.seconds,
            "moving": [obstacle.as_dict() for obstacle in self.moving],
            "times": self.times.tolist(),
            "path": self.points.tolist(),
        }

    def __str__(self) -> str:
        waits = ", ".join(f"{t:.3g} s at ({x:.4g}, {y:.4g})" for x, y, t in self.waits) or "none"
        return (
            f"arrives after {self.duration:.6g} s, {self.direct:.6g} s if nothing moved; length "
            f"{self.path.length:.6g}; waits: {waits} ({self.opened} windows opened, {1e3 * self.seconds:.0f} ms)"
        )
