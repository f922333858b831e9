"""Planning a path: exactly, by a metaheuristic over via points, or by a planner of another package.

However it is planned, the exact test has the last word.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.interrupts import Pressed, wrapped
from pin_metaik.mobile.errors import NoPath
from pin_metaik.mobile.paths.fitness import Fitness, make_fitness
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.planners.protocol import Found, LineTests, PathPlanner
from pin_metaik.mobile.paths.planners.registry import PLANNERS
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.paths.result import PathPlan, PathStatus
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.optimize import ALGORITHMS, Budget, Metaheuristic, Result, Status, make, minimize
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.settings import whole
from pin_metaik.randomness import as_generator, repeatable
from pin_metaik.watching import Watch, ended

EXACT, GIVEN = "exact", "given"

# Table 2 of the paper, for the two it has; v_max is 1 in a workspace of 10.
PAPER_SETTINGS: dict[str, Metaheuristic] = {
    "ga": GA(agents=50, crossover_rate=0.9, mutation_rate=0.4),
    "pso": PSO(agents=50, variant="inertia", c1=2.0, c2=2.0, w_max=1.2, w_min=0.4, v_max=0.1),
}
PAPER_BUDGET = Budget(evaluations=50 * 100)
PAPER_VIA = 5


@checked
def plan_path(
    problem: PathProblem | Scene,
    method: str | Metaheuristic | PathPlanner = EXACT,
    *,
    fitness: str | Fitness = "exact",
    via: int = PAPER_VIA,
    budget: Budget = PAPER_BUDGET,
    rng: int | np.random.Generator | None = 0,
    seeded: bool = False,
    trace: bool = False,
    watch: Watch | None = None,
) -> PathPlan:
    """Plan a path.

    Args:
        problem: A problem, or a scene for a point robot.
        method: ``"exact"``, the shortest path by the visibility graph (with a clearance: among the grown obstacles); or
            a metaheuristic over via points, by name (``"ga"`` and ``"pso"`` with the settings of the paper's Table 2)
            or as an object; or one of ``PLANNERS`` for comparison: ``"astar"`` on a grid, ``"rrt"``, ``"rrtconnect"``,
            ``"rrtstar"``, ``"informed"`` and ``"prm"`` by OMPL, or an object with a method ``route``.
        fitness: What metaheuristics minimise: ``"exact"``, ``"paper"`` or an object.
        via: Number of via points. With fewer than the shortest path has corners, that path cannot be found.
        budget: Budget of a search; an evaluation is one path of a metaheuristic, or one straight line that another
            planner tests. Planners that end with their first path may use less, and A* less or more.
        rng: Seed or generator; ``None`` is a fixed seed.
        seeded: Whether to start one individual at the shortest path. This makes sense for a fitness other than the
            length; the result is then never worse than that path.
        trace: Whether to keep the convergence in ``PathPlan.trace``.
        watch: Called after every generation of the search with the evaluations done and in all, and the paths of the
            generation (``problem.through(x)`` for each x of ``Progress.population.X``); returning True ends it.

    Returns:
        The plan: check ``plan.success``. The best path of a metaheuristic may go through an obstacle; a sampling
        planner may find none.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no path; raised by the exact planner and with ``seeded``.
        UnknownName: No planner or fitness of that name.
        InvalidSetting: Fewer than one via point, or too few for the seed.
        InvalidBudget: A budget without an end, or with a ``target`` for a planner that minimises no cost.
        MissingExtra: A planner's package is not installed.
        Interrupted: Ctrl-C, after the first generation; its ``result`` is the plan with the best path so far.
    """
    if isinstance(problem, Scene):
        problem = PathProblem.of(problem)
    seed = repeatable(rng)
    if method == EXACT:
        began = perf_counter()
        path = problem.optimum
        return _exact(path, problem, _rank(path, problem), perf_counter() - began, seed)
    whole("via", via, 1)
    name = method if isinstance(method, str) else type(method).__name__
    algorithm = planner_of(method)
    if isinstance(algorithm, PathPlanner):
        return _routed(problem, algorithm, name, budget, rng, trace, watch)
    objective = make_fitness(fitness).on(problem.space, problem.scene.start, problem.scene.goal)
    seeds = _seed(problem, via) if seeded else None
    box = problem.box(via)
    return wrapped(
        lambda: minimize(objective, box, algorithm, budget, rng, seeds=seeds, trace=trace, watch=watch),
        lambda found: _searched(problem, found, name, seed),
    )


def _routed(
    problem: PathProblem,
    planner: PathPlanner,
    name: str,
    budget: Budget,
    rng: int | np.random.Generator | None,
    trace: bool,
    watch: Watch | None,
) -> PathPlan:
    """The plan of a planner that is no metaheuristic; Ctrl-C is noted, and heard between two of its steps."""
    start, goal = problem.scene.start, problem.scene.goal
    with Pressed(held=True) as pressed:
        tests = LineTests(problem.space, budget, watch, pressed.check)
        direct = Path(np.array([start, goal]))
        found = Found(direct) if start == goal else planner.route(problem, tests, as_generator(rng))
    path, seconds = found.path or direct, tests.seconds
    status = PathStatus.NOT_FOUND
    if found.path is not None:
        status = PathStatus.FREE if problem.space.holds(path.points) else PathStatus.COLLIDES
    cost = math.inf if found.path is None else path.length
    plan = PathPlan(
        path,
        status,
        _optimum(problem),
        cost,
        name,
        tests.count,
        seconds,
        repeatable(rng),
        tests.stopped is not None,
        problem,
        found.trace if trace else None,
    )
    return plan if tests.stopped is None else ended(tests.stopped, plan)


def _optimum(problem: PathProblem) -> float | None:
    """Length of the shortest path, if there is a way."""
    try:
        return problem.optimum.length
    except NoPath:
        return None


def _searched(problem: PathProblem, found: Result, method: str, seed: int | None) -> PathPlan:
    """The plan that a search ends with."""
    path = problem.through(found.x)
    return PathPlan(
        path,
        PathStatus.FREE if problem.space.holds(path.points) else PathStatus.COLLIDES,
        _optimum(problem),
        found.cost,
        method,
        found.evaluations,
        found.seconds,
        seed,
        found.status is Status.INTERRUPTED,
        problem,
        found.trace,
    )


@checked
def plan_alternatives(problem: PathProblem | Scene, count: int) -> list[PathPlan]:
    """The shortest paths around the obstacles, one for each homotopy class, shortest first.

    Args:
        problem: A problem, or a scene for a point robot.
        count: How many, at least 1; fewer come back if there are no more.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no way.
        InvalidSetting: A count below 1.
    """
    if isinstance(problem, Scene):
        problem = PathProblem.of(problem)
    began = perf_counter()
    paths = problem.alternatives(count)
    took = perf_counter() - began
    rank = [_rank(paths[0], problem), *[PathStatus.FREE] * (len(paths) - 1)]
    return [_exact(path, problem, status, took, None) for path, status in zip(paths, rank, strict=True)]


@checked
def path_through(problem: PathProblem | Scene, via: ArrayLike) -> PathPlan:
    """A path of your own: whether it is free by the exact test, and its gap to the shortest.

    Args:
        problem: A problem, or a scene for a point robot.
        via: (n, 2) the points that it goes through on its way from start to goal.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        InvalidGeometry: The points are not (n, 2) finite numbers.
    """
    if isinstance(problem, Scene):
        problem = PathProblem.of(problem)
    points = array("via", via, "n", 2, error=InvalidGeometry)
    path = problem.through(points.ravel())
    status = PathStatus.FREE if problem.space.holds(path.points) else PathStatus.COLLIDES
    return PathPlan(path, status, _optimum(problem), path.length, GIVEN, 0, 0.0, None, False, problem)


def _exact(path: Path, problem: PathProblem, status: PathStatus, seconds: float, seed: int | None) -> PathPlan:
    """A plan that needed no search."""
    length = path.length
    return PathPlan(path, status, problem.optimum.length, length, EXACT, 0, seconds, seed, False, problem)


def _rank(path: Path, problem: PathProblem) -> PathStatus:
    """What the shortest path among grown obstacles is: the shortest of all, if nothing was grown that it bends at."""
    exact = not problem.space.clearance or not len(path.corners)
    return PathStatus.OPTIMAL if exact else PathStatus.SHORTEST


@checked
def planner_of(method: str | Metaheuristic | PathPlanner) -> Metaheuristic | PathPlanner:
    """The planner of a name: a metaheuristic (``ga`` and ``pso`` with the paper's settings) or another planner.

    Raises:
        UnknownName: There is none of that name; ``exact``, which has no settings, is not among them.
        InvalidSetting: An object that is not a planner.
    """
    if isinstance(method, str):
        if method in PAPER_SETTINGS:
            return PAPER_SETTINGS[method]
        if method in PLANNERS:
            return PLANNERS[method]()
        if method not in ALGORITHMS:
            raise UnknownName("path planner", method, [EXACT, *ALGORITHMS, *PLANNERS])
    elif isinstance(method, PathPlanner) and not isinstance(method, type):
        return method
    return make(method)  # type: ignore[arg-type]  # it refuses what is no metaheuristic


def _seed(problem: PathProblem, via: int) -> Array:
    """Via points (2 n,) of the shortest path; those it does not need lie on its last segment."""
    path = problem.optimum
    spare = via - len(path.corners)
    if spare < 0:
        raise InvalidSetting(f"the shortest path has {len(path.corners)} corners: give via={len(path.corners)} or more")
    shares = np.arange(1, spare + 1)[:, None] / (spare + 1)
    last = path.points[-2] + shares * (path.points[-1] - path.points[-2])
    return np.vstack((path.corners, last)).reshape(-1)
