"""Planning a path: exactly, or by a metaheuristic over via points; either way the exact test has the last word."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.mobile.errors import NoPath
from pin_metaik.mobile.paths.exact import shortest_path
from pin_metaik.mobile.paths.fitness import Fitness, make_fitness
from pin_metaik.mobile.paths.homotopy import shortest_paths
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.visibility import Visibility
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.growth import Join
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.optimize import ALGORITHMS, AskTell, Box, Budget, Metaheuristic, Status, make, minimize
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.settings import whole, within
from pin_metaik.optimize.space import Array

EXACT = "exact"

# Table 2 of the paper, for the two it has; v_max is 1 in a workspace of 10.
PAPER_SETTINGS: dict[str, Metaheuristic] = {
    "ga": GA(agents=50, crossover_rate=0.9, mutation_rate=0.4),
    "pso": PSO(agents=50, variant="inertia", c1=2.0, c2=2.0, w_max=1.2, w_min=0.4, v_max=0.1),
}
PAPER_BUDGET = Budget(evaluations=50 * 100)
PAPER_VIA = 5


class PathStatus(StrEnum):
    """Why a search for a path ended; only the first two are successes."""

    OPTIMAL = "OPTIMAL"
    """The shortest path of all, free of collisions."""
    FREE = "FREE"
    """Free of collisions; how far from the shortest is its gap."""
    COLLIDES = "COLLIDES"
    """The best that was found goes through an obstacle."""


@dataclass(frozen=True, eq=False)
class PathProblem:
    """A scene with the clearance to keep, and what can be worked out once for all planners.

    Attributes:
        scene: The world, start and goal.
        space: Its free space.
    """

    scene: Scene
    space: FreeSpace

    @staticmethod
    def of(scene: Scene, radius: float = 0.0, margin: float = 0.0, join: Join = "mitre") -> PathProblem:
        """A problem, checked.

        Args:
            scene: The world, start and goal.
            radius: Of the robot, in the scene's unit.
            margin: Distance to keep on top of that.
            join: How grown obstacles end at their corners: ``mitre`` or ``round``.

        Raises:
            Blocked: The robot cannot be at the start or the goal.
            InvalidSetting: A radius or margin below zero, or no such join.
        """
        within("radius", radius, 0)
        within("margin", margin, 0)
        space = FreeSpace.of(scene, radius + margin, join)
        space.check("start", scene.start)
        space.check("goal", scene.goal)
        return PathProblem(scene, space)

    @cached_property
    def visibility(self) -> Visibility:
        """The visibility graph of the free space."""
        return Visibility(self.space)

    @cached_property
    def optimum(self) -> Path:
        """The shortest path. Raises NoPath if there is none."""
        return shortest_path(self.space, self.scene.start, self.scene.goal, self.visibility)

    def alternatives(self, count: int) -> list[Path]:
        """The shortest paths of the best homotopy classes, see ``shortest_paths``."""
        return shortest_paths(self.space, self.scene.start, self.scene.goal, count, self.visibility)

    def box(self, via: int) -> Box:
        """Where via points may lie: the workspace inside its walls, once for each."""
        x_min, y_min, x_max, y_max = self.space.box
        return Box(np.tile([x_min, y_min], via), np.tile([x_max, y_max], via))

    def through(self, x: Array) -> Path:
        """The path through via points (2 n,)."""
        return Path(np.vstack((self.scene.start, x.reshape(-1, 2), self.scene.goal)))


@dataclass(frozen=True, eq=False)
class PathPlan:
    """The best path found, and how good it is.

    Attributes:
        path: From start to goal.
        status: Whether it is the shortest, free, or not a path at all.
        optimum: Length of the shortest path; None if there is no way.
        cost: The fitness at the path; the exact planner's is its length.
        method: Name of the planner.
        evaluations: Paths whose fitness was computed; 0 for the exact planner.
        seconds: Time taken, in s, without that for the optimum the gap is measured by.
        seed: Of every random choice; None if a generator was handed in.
        interrupted: Whether it was stopped by Ctrl-C or its callback.
        problem: What was asked.
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
        return self.status is not PathStatus.COLLIDES

    @property
    def success(self) -> bool:
        """The same: a path that collides is no path."""
        return self.collision_free

    @property
    def gap(self) -> float | None:
        """How much longer than the shortest it is, as a share of that; None for a path that is none."""
        if self.optimum is None or not self.collision_free:
            return None
        return max(0.0, self.length / self.optimum - 1) if self.optimum else 0.0

    @property
    def clearance(self) -> float:
        """Least distance from an obstacle, not grown; inf without obstacles."""
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
            "success": self.success,
            "collision_free": self.collision_free,
            "length": self.length,
            "optimum": self.optimum,
            "gap": self.gap,
            "cost": self.cost,
            "clearance": clearance if np.isfinite(clearance) else None,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "seed": self.seed,
            "path": self.path.points.tolist(),
        }

    def __str__(self) -> str:
        far = (
            ""
            if self.gap is None or self.status is PathStatus.OPTIMAL
            else f", {100 * self.gap:.2f} % above the optimum"
        )
        return f"{self.status}: length {self.length:.6g}{far} ({self.method}, {self.evaluations} evaluations)"


def plan_path(
    problem: PathProblem | Scene,
    method: str | Metaheuristic = EXACT,
    *,
    fitness: str | Fitness = "exact",
    via: int = PAPER_VIA,
    budget: Budget = PAPER_BUDGET,
    rng: int | np.random.Generator | None = 0,
    seeded: bool = False,
    trace: bool = False,
    callback: Callable[[AskTell], bool | None] | None = None,
) -> PathPlan:
    """Plan a path.

    Args:
        problem: A problem, or a scene for a point robot.
        method: ``"exact"``, the shortest path by the visibility graph; or a metaheuristic over via points, by name
            (``"ga"`` and ``"pso"`` with the settings of the paper's Table 2) or as an object.
        fitness: What metaheuristics minimise: ``"exact"``, ``"paper"`` or an object.
        via: Via points. With fewer than the shortest path has corners it is out of reach.
        budget: What a metaheuristic may spend; an evaluation is one path.
        rng: Seed or generator.
        seeded: Whether to start one individual at the shortest path: for a fitness that is not its length, or to see
            that the search can only be better than that.
        trace: Whether to keep the convergence.
        callback: Called after every generation with the running search; returning True ends it.

    Returns:
        The plan: check ``plan.success``. A metaheuristic's best may go through an obstacle.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no way, for the exact planner and ``seeded``.
        UnknownName: No planner or fitness of that name.
        InvalidSetting: Fewer than one via point, or too few for the seed.
    """
    if isinstance(problem, Scene):
        problem = PathProblem.of(problem)
    seed = int(rng) if isinstance(rng, (int, np.integer)) else None
    if method == EXACT:
        began = perf_counter()
        fresh = PathProblem(problem.scene, problem.space)
        path = fresh.optimum
        took = perf_counter() - began
        return PathPlan(path, PathStatus.OPTIMAL, path.length, path.length, EXACT, 0, took, seed, False, problem)
    whole("via", via, 1)
    algorithm = _algorithm(method)
    objective = make_fitness(fitness).on(problem.space, problem.scene.start, problem.scene.goal)
    seeds = _seed(problem, via) if seeded else None
    found = minimize(objective, problem.box(via), algorithm, budget, rng, seeds=seeds, trace=trace, callback=callback)
    path = problem.through(found.x)
    try:
        optimum: float | None = problem.optimum.length
    except NoPath:
        optimum = None
    return PathPlan(
        path,
        PathStatus.FREE if problem.space.holds(path.points) else PathStatus.COLLIDES,
        optimum,
        found.cost,
        method if isinstance(method, str) else type(method).__name__,
        found.evaluations,
        found.seconds,
        seed,
        found.status is Status.INTERRUPTED,
        problem,
        found.trace,
    )


def _algorithm(method: str | Metaheuristic) -> Metaheuristic:
    if isinstance(method, str):
        if method not in ALGORITHMS:
            raise UnknownName("path planner", method, [EXACT, *ALGORITHMS])
        return PAPER_SETTINGS[method] if method in PAPER_SETTINGS else make(method)
    return make(method)


def _seed(problem: PathProblem, via: int) -> Array:
    """Via points (2 n,) of the shortest path; those it does not need lie on its last segment."""
    path = problem.optimum
    spare = via - len(path.corners)
    if spare < 0:
        raise InvalidSetting(f"the shortest path has {len(path.corners)} corners: give via={len(path.corners)} or more")
    shares = np.arange(1, spare + 1)[:, None] / (spare + 1)
    last = path.points[-2] + shares * (path.points[-1] - path.points[-2])
    return np.vstack((path.corners, last)).reshape(-1)
