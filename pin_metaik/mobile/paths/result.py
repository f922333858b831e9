"""A planned path: whether it is free by the exact test, and its gap to the shortest."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.problem import PathProblem

SAME = 1e-9  # of the length; a cost that differs less is the length


class PathStatus(StrEnum):
    """Why a search for a path ended; all but the last two are successes."""

    OPTIMAL = "OPTIMAL"
    """The shortest path of all, free of collisions."""
    SHORTEST = "SHORTEST"
    """The shortest among the obstacles as they are grown, whose corners keep a little more than the clearance.

    The shortest of all is shorter where the path bends: round joins keep 0.5 percent more at most, mitred ones more."""
    FREE = "FREE"
    """Free of collisions; how far from the shortest is its gap."""
    COLLIDES = "COLLIDES"
    """The best that was found goes through an obstacle."""
    NOT_FOUND = "NOT_FOUND"
    """Nothing was found that leads to the goal; the path is a straight line there, for want of one."""


@dataclass(frozen=True, eq=False)
class PathPlan:
    """The best path found, and how good it is.

    Attributes:
        path: From start to goal.
        status: Whether it is proved the shortest, free of collisions, or not a valid path.
        optimum: Length of the shortest path among the grown obstacles; None if there is no path.
        cost: The fitness of the path; for other planners its length, inf if none was found.
        method: Name of the planner.
        evaluations: Paths whose fitness was computed, or straight lines tested; 0 for the exact planner.
        seconds: Time taken, s. A search's time excludes the computation of ``optimum``; the exact planner's time
            excludes work done earlier for the same problem.
        seed: Seed of every random choice; None if a generator was given.
        interrupted: Whether its search was stopped, by Ctrl-C or its watch.
        problem: The problem.
        trace: Evaluations and best cost after each generation (g, 2), when asked for.
    """

    path: Path
    status: PathStatus
    optimum: float | None
    cost: float
    method: str
    evaluations: int
    seconds: float
    seed: int | None
    interrupted: bool
    problem: PathProblem
    trace: Array | None = None

    @property
    def length(self) -> float:
        """Length of the path, free or not."""
        return self.path.length

    @property
    def collision_free(self) -> bool:
        """Whether the path keeps its clearance, by the exact test."""
        return self.status not in (PathStatus.COLLIDES, PathStatus.NOT_FOUND)

    @property
    def success(self) -> bool:
        """Whether the path is free of collisions."""
        return self.collision_free

    def __bool__(self) -> bool:
        return self.success

    @property
    def gap(self) -> float | None:
        """How much longer than the optimum the path is, relative to it; None for a path that is not free."""
        if self.optimum is None or not self.collision_free:
            return None
        return max(0.0, self.length / self.optimum - 1) if self.optimum else 0.0

    @property
    def clearance(self) -> float:
        """Least distance from an original (not grown) obstacle; inf without obstacles."""
        return self.problem.space.distance(self.path.points)

    def verify(self) -> bool:
        """Test the path again."""
        return self.problem.space.holds(self.path.points)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        clearance = self.clearance
        return {
            "scene": self.problem.scene.name,
            "method": self.method,
            "status": str(self.status),
            "join": self.problem.space.join if self.problem.space.clearance else None,
            "success": self.success,
            "collision_free": self.collision_free,
            "length": self.length,
            "optimum": self.optimum,
            "gap": self.gap,
            "cost": self.cost if np.isfinite(self.cost) else None,
            "clearance": clearance if np.isfinite(clearance) else None,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "seed": self.seed,
            "path": self.path.points.tolist(),
        }

    def __str__(self) -> str:
        said = [self.method]
        if self.evaluations:
            said.append(f"{self.evaluations} evaluations")
        if self.evaluations and self.seed is not None:
            said.append(f"seed {self.seed}")
        far = ""
        if self.problem.space.clearance:
            said.append(f"{self.problem.space.join} joins")
        if self.gap is not None and self.status is PathStatus.FREE:
            far = f", {100 * self.gap:.2f} % above the optimum"
        if np.isfinite(self.cost) and abs(self.cost - self.length) > SAME * self.length:
            far += f", cost {self.cost:.6g}"
        if self.status is PathStatus.NOT_FOUND:
            return f"{self.status}: no path ({', '.join(said)}, {1e3 * self.seconds:.0f} ms)"
        return f"{self.status}: length {self.length:.6g}{far} ({', '.join(said)}, {1e3 * self.seconds:.0f} ms)"
