"""Trees and roadmaps of random samples, by OMPL (Sucan, Moll and Kavraki 2012), with our exact test of lines.

OMPL keeps one source of random seeds for the whole process; it is set anew for every search, by one draw from ours, so
that the same seed leads to the same path.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Lock
from typing import Any, Literal

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.lookup import need
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.planners.protocol import Found, LineTests
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.optimize.settings import one_of, positive, whole, within

Tree = Literal["RRT", "RRTConnect", "RRTstar", "InformedRRTstar"]

IMPROVING = ("RRTstar", "InformedRRTstar")
EVERY = 50  # lines between two entries of the trace
_ONE = Lock()  # at a time: OMPL's seeds and its log are those of the process


@checked
@dataclass(frozen=True)
class RandomTree:
    """A tree that grows from the start towards random samples until it reaches the goal.

    RRT (LaValle 1998) and RRTConnect (Kuffner and LaValle 2000) end with their first path; RRTstar (Karaman and
    Frazzoli 2011) and InformedRRTstar (Gammell, Srinivasa and Barfoot 2014) improve theirs until the budget is spent.

    Attributes:
        planner: Name of the planner.
        range: Longest edge, in the scene's unit; None: OMPL's default, a fifth of the workspace's diagonal.
        goal_bias: Probability with which the goal is sampled; RRTConnect, which grows a tree from the goal, has none.
    """

    planner: Tree = "RRTstar"
    range: float | None = None
    goal_bias: float = 0.05

    def __post_init__(self) -> None:
        one_of("planner", self.planner, Tree)
        if self.range is not None:
            positive("range", self.range)
        within("goal_bias", self.goal_bias, 0, 1)

    @checked
    def route(self, problem: PathProblem, tests: LineTests, rng: np.random.Generator) -> Found:
        """Grow the tree until it has a path, or until the budget is spent."""
        with _space(problem, tests, rng) as world:
            tree = getattr(world.geometric, self.planner)(world.information)
            if self.range is not None:
                tree.setRange(self.range)
            if self.planner != "RRTConnect":
                tree.setGoalBias(self.goal_bias)
            task = world.base.ProblemDefinition(world.information)
            task.setStartAndGoalStates(world.state(problem.scene.start), world.state(problem.scene.goal))
            tree.setProblemDefinition(task)
            tree.setup()
            trace: list[tuple[float, float]] = []

            def over() -> bool:
                best = float(tree.bestCost().value()) if self.planner in IMPROVING else math.inf
                if math.isfinite(best) and (not trace or tests.count - trace[-1][0] >= EVERY):
                    trace.append((tests.count, best))
                return tests.spent(best if math.isfinite(best) else None)

            tree.solve(world.base.PlannerTerminationCondition(over))
            path = _path(task.getSolutionPath()) if task.hasExactSolution() else None
        if path is not None and self.planner in IMPROVING:
            trace.append((tests.count, path.length))
        return Found(path, np.array(trace).reshape(-1, 2))


@checked
@dataclass(frozen=True)
class Roadmap:
    """A probabilistic roadmap (Kavraki, Svestka, Latombe and Overmars 1996), and the shortest path over it.

    The roadmap grows, independently of start and goal, until the budget is spent; start and goal are then joined to
    their nearest vertices. The path over the roadmap is searched here and not by OMPL, whose search runs in a thread
    beside the growing and gives another result each time.

    Attributes:
        nearest: Largest number of vertices that start and goal are each joined to.
    """

    nearest: int = 20

    def __post_init__(self) -> None:
        whole("nearest", self.nearest, 1)

    @checked
    def route(self, problem: PathProblem, tests: LineTests, rng: np.random.Generator) -> Found:
        """Grow the roadmap until the budget is spent, then search it."""
        need("the way over a roadmap", "planners", "networkx")
        import networkx as nx

        with _space(problem, tests, rng) as world:
            grown, edges = _grown(world, tests)
        places = np.vstack((grown, problem.scene.start, problem.scene.goal))
        start, goal = len(grown), len(grown) + 1
        both = np.array(
            [*edges, (start, goal), *_nearest(places, start, self.nearest), *_nearest(places, goal, self.nearest)]
        )
        free = np.concatenate((np.ones(len(edges), dtype=bool), tests.free_lines(places[both[len(edges) :]])))
        lengths = np.hypot(*np.diff(places[both[free]], axis=1)[:, 0].T)
        graph = nx.Graph()
        graph.add_nodes_from((start, goal))
        graph.add_weighted_edges_from((int(a), int(b), float(d)) for (a, b), d in zip(both[free], lengths, strict=True))
        try:
            nodes = nx.dijkstra_path(graph, start, goal)
        except nx.NetworkXNoPath:
            return Found(None)
        return Found(Path(places[nodes]))


@dataclass(frozen=True, eq=False)
class _World:
    """OMPL's modules and its idea of the problem."""

    base: Any
    geometric: Any
    space: Any
    information: Any

    def state(self, point: tuple[float, float]) -> Any:
        state = self.space.allocState()
        state[0], state[1] = point
        return state


@contextmanager
def _space(problem: PathProblem, tests: LineTests, rng: np.random.Generator) -> Iterator[_World]:
    """The workspace as OMPL knows it, with its seeds set and its log silent; one search at a time."""
    need("trees and roadmaps of random samples", "planners", "ompl")
    from ompl import base, geometric, util

    class Lines(base.MotionValidator):  # type: ignore[misc]
        def checkMotion(self, a: Any, b: Any) -> bool:
            return tests.free(a[0], a[1], b[0], b[1])

    space = base.RealVectorStateSpace(2)
    bounds = base.RealVectorBounds(2)
    x_min, y_min, x_max, y_max = problem.space.box
    for axis, low, high in ((0, x_min, x_max), (1, y_min, y_max)):
        bounds.setLow(axis, low)
        bounds.setHigh(axis, high)
    space.setBounds(bounds)
    information = base.SpaceInformation(space)
    information.setStateValidityChecker(lambda state: tests.free_point(state[0], state[1]))
    information.setMotionValidator(Lines(information))
    with _ONE:
        before = util.getLogLevel()
        util.setLogLevel(util.LogLevel.LOG_NONE)
        try:
            util.RNG.setSeed(int(rng.integers(1, 2**31)))
            information.setup()
            yield _World(base, geometric, space, information)
        finally:
            util.setLogLevel(before)


def _grown(world: _World, tests: LineTests) -> tuple[Array, list[tuple[int, int]]]:
    """Places (n, 2) of a roadmap that grows until the budget is spent, and which of them are joined."""
    roadmap = world.geometric.PRM(world.information)
    roadmap.setProblemDefinition(world.base.ProblemDefinition(world.information))
    roadmap.setup()
    roadmap.constructRoadmap(world.base.PlannerTerminationCondition(tests.spent))
    data = world.base.PlannerData(world.information)
    roadmap.getPlannerData(data)
    states = [data.getVertex(k).getState() for k in range(data.numVertices())]
    places = np.array([(state[0], state[1]) for state in states]).reshape(-1, 2)
    return places, [(k, other) for k in range(len(places)) for other in data.getEdges(k)]


def _nearest(places: Array, node: int, count: int) -> list[tuple[int, int]]:
    """The start or goal, a node of places (n, 2) whose last two they are, with each of its nearest places."""
    away = np.hypot(*(places[:-2] - places[node]).T)
    return [(node, int(k)) for k in np.argsort(away, kind="stable")[:count]]


def _path(found: Any) -> Path:
    return Path(np.array([(state[0], state[1]) for state in found.getStates()]))
