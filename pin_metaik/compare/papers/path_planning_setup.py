"""The experiments on paths among polygons: scenes, constants, and what one job does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from time import process_time
from typing import TYPE_CHECKING

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize import Budget, Metaheuristic
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.pso import PSO

if TYPE_CHECKING:  # shapely is an extra
    from pin_metaik.mobile import PathProblem


ITERATIONS = 100
REPEATS = 11  # of the exact planner, for its time
SEGMENTS = 20_000  # random ones, for the hit test


@dataclass(frozen=True)
class Setting:
    """How a scene is planned.

    Attributes:
        scene: What ``load_scene`` takes, or random:SEED.
        via: Via points.
        agents: Population.
        mutation: Rate of the GA.
    """

    scene: str
    via: int
    agents: int
    mutation: float

    def algorithm(self, method: str) -> Metaheuristic:
        """GA or PSO with the paper's constants; v_max is 1 in a workspace of 10."""
        if method == "GA":
            return GA(agents=self.agents, crossover_rate=0.9, mutation_rate=self.mutation)
        return PSO(agents=self.agents, variant="inertia", c1=2.0, c2=2.0, w_max=1.2, w_min=0.4, v_max=0.1)


# Table 2 (15 obstacles) and example 1 (10 obstacles), whose obstacles are not printed, on scenes of our own with the
# same start, goal and numbers; and a random scene whose shortest path has one corner.
SETTINGS = {
    "10 obstacles": Setting("ten_obstacles", 2, 100, 0.1),
    "15 obstacles": Setting("fifteen_obstacles", 5, 50, 0.4),
    "15, easy": Setting("random:2", 5, 50, 0.4),
}
TRAP = Setting("u_trap", 5, 50, 0.4)


@dataclass(frozen=True, eq=False)
class PathTrial:
    """One run.

    Attributes:
        scene: Key of the settings.
        method: GA or PSO.
        fitness: Name of the fitness that was minimised.
        run: Number, from 0.
        f: Its best fitness.
        length: Of its path.
        free: Whether the path is free, by the exact test.
        gap: How much longer than the shortest path, as a share; None if it is not free.
        seconds: Processor time, s: a busy machine does not count.
        points: The path (n, 2).
        trace: Evaluations and best fitness (g, 2).
    """

    scene: str
    method: str
    fitness: str
    run: int
    f: float
    length: float
    free: bool
    gap: float | None
    seconds: float
    points: Array
    trace: Array


@dataclass(frozen=True)
class ExactTrial:
    """The shortest path of a scene: its length, corners, and the median processor time from the polygons on, s."""

    scene: str
    length: float
    corners: int
    seconds: float


@dataclass(frozen=True)
class HitTrial:
    """The paper's hit test on random segments: how many hit, how many it misses, how many it makes up."""

    scene: str
    hits: int
    missed: int
    invented: int


def problem(setting: Setting) -> PathProblem:
    """The planning problem of a setting."""
    from pin_metaik import mobile

    kind, _, seed = setting.scene.partition(":")
    if kind == "random":
        return mobile.PathProblem.of(mobile.random_scene(15, int(seed), start=(0.1, 0.1), goal=(8.5, 8.0)))
    return mobile.PathProblem.of(mobile.load_scene(setting.scene))


def warm_up(problem: PathProblem) -> None:
    """Compile the loops that the runs call, so that no run is timed with it."""
    from pin_metaik import mobile

    problem.optimum  # noqa: B018  # worked out once, and every run asks for it
    for fitness in mobile.FITNESSES.values():
        fitness().on(problem.space, problem.scene.start, problem.scene.goal)(np.zeros((1, 2)))


def search(
    name: str, setting: Setting, problem: PathProblem, method: str, fitness: str, run: int, rng: np.random.Generator
) -> Callable[[], PathTrial]:
    """One run of GA or PSO."""

    def work() -> PathTrial:
        from pin_metaik import mobile

        budget = Budget(evaluations=setting.agents * ITERATIONS)
        began = process_time()
        plan = mobile.plan_path(
            problem, setting.algorithm(method), fitness=fitness, via=setting.via, budget=budget, rng=rng, trace=True
        )
        took = process_time() - began
        trace = np.empty((0, 2)) if plan.trace is None else plan.trace
        found = (plan.cost, plan.length, plan.collision_free, plan.gap, took, plan.path.points, trace)
        return PathTrial(name, method, fitness, run, *found)

    return work


def exact(name: str, problem: PathProblem) -> ExactTrial:
    """The shortest path, from the polygons on; the first time may compile and does not count."""
    from pin_metaik import mobile

    seconds = []
    for _ in range(REPEATS + 1):
        began = process_time()
        plan = mobile.plan_path(mobile.PathProblem.of(problem.scene))
        seconds.append(process_time() - began)
    return ExactTrial(name, plan.length, len(plan.path.corners), median(seconds[1:]))


def hit_test(name: str, problem: PathProblem, rng: np.random.Generator) -> HitTrial:
    """The paper's test (line of the segment, and bounding boxes) against shapely, on the same convex hulls."""
    import shapely

    from pin_metaik.mobile import PaperFitness

    ends = 10 * rng.random((SEGMENTS, 4))
    costs = PaperFitness().on(problem.space, problem.scene.start, problem.scene.goal)
    said = costs.segment_hits(ends)
    lines = shapely.linestrings(ends.reshape(-1, 2, 2))[:, None]
    true = shapely.relate_pattern(lines, np.array(costs.hulls, dtype=object), "T********")  # the insides meet
    return HitTrial(name, int(true.sum()), int((true & ~said).sum()), int((said & ~true).sum()))
