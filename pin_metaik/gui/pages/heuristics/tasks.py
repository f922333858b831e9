"""What there is to search for: a path among obstacles, or where the joints of an arm shall be.

A task is sent to another process, where it calls the library; what it returns is the library's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compare.papers.puma_offset import O
from pin_metaik.ik import IKProblem, Target
from pin_metaik.kinematics import Chain
from pin_metaik.mobile import FITNESSES, PathPlan, PathProblem, Scene, plan_path
from pin_metaik.optimize import Budget, Metaheuristic, Result, minimize
from pin_metaik.robots import load_robot
from pin_metaik.watching import Watch


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a search ended with, as every task tells it.

    Attributes:
        x: The best point (n,).
        cost: Its objective.
        evaluations: Spent.
        seconds: Time taken, s.
        status: Why it ended, or what the best is worth.
        words: More of it, in Markdown.
    """

    x: NDArray[np.float64]
    cost: float
    evaluations: int
    seconds: float
    status: str
    words: str


class Task(Protocol):
    """A search that can be sent to a process."""

    @property
    def algorithm(self) -> Metaheuristic:
        """What searches."""
        ...

    def __call__(self, watch: Watch) -> Any:
        """Search; the result of the library."""
        ...

    def outcome(self, result: Any) -> Outcome:
        """What the page says of such a result."""
        ...


@dataclass(frozen=True, eq=False)
class PathTask:
    """A search for via points: ``mobile.plan_path``.

    Attributes:
        scene: The map.
        radius: Of the robot.
        algorithm: What searches.
        fitness: ``exact`` or ``paper``.
        penalty: Collision constant, in widths of the workspace.
        via: Via points.
        evaluations: Paths that it may try.
        seed: Of every random choice.
    """

    scene: Scene
    radius: float
    algorithm: Metaheuristic
    fitness: str
    penalty: float
    via: int
    evaluations: int
    seed: int

    def __call__(self, watch: Watch) -> PathPlan:
        """Search."""
        return plan_path(
            PathProblem.of(self.scene, self.radius),
            self.algorithm,
            fitness=FITNESSES[self.fitness](penalty=self.penalty),  # type: ignore[call-arg]  # both have one
            via=self.via,
            budget=Budget(evaluations=self.evaluations),
            rng=self.seed,
            trace=True,
            watch=watch,
        )

    def outcome(self, result: PathPlan) -> Outcome:
        """What the page says of a plan."""
        gap = "no gap: it is not free" if result.gap is None else f"{100 * result.gap:.2f} % longer than the shortest"
        free = "free by the exact test" if result.collision_free else "goes through an obstacle"
        words = f"length {result.length:.6f}, {free}; {gap}"
        x = result.path.points[1:-1].ravel()
        return Outcome(x, result.cost, result.evaluations, result.seconds, str(result.status), words)


@dataclass(frozen=True, eq=False)
class ArmTask:
    """A search for joint angles that bring the tip to a place: ``minimize`` over O = p d^2 (Toz et al. 2011, Eq. 10).

    Attributes:
        robot: Name of the robot.
        parameters: Of its DH table, as pairs.
        goal: x, y, z of the tip, m.
        p: Penalty.
        algorithm: What searches.
        evaluations: Configurations that it may try.
        seed: Of every random choice.
    """

    robot: str
    parameters: tuple[tuple[str, float], ...]
    goal: tuple[float, float, float]
    p: float
    algorithm: Metaheuristic
    evaluations: int
    seed: int

    def chain(self) -> Chain:
        """The chain that is moved."""
        robot = load_robot(self.robot, parameters=dict(self.parameters) or None)
        return Chain(robot.model, robot.frame)

    def __call__(self, watch: Watch) -> Result:
        """Search."""
        problem = IKProblem.of(self.chain(), Target.at(self.goal))
        budget = Budget(evaluations=self.evaluations)
        objective = partial(O, problem, self.p)
        return minimize(objective, problem.box, self.algorithm, budget, self.seed, trace=True, watch=watch)

    def outcome(self, result: Result) -> Outcome:
        """What the page says of a result."""
        reached = self.chain().poses(result.x)[0, 0, :3, 3]
        words = f"tip at ({', '.join(f'{value:.4f}' for value in reached)})"
        return Outcome(result.x, result.cost, result.evaluations, result.seconds, result.status.value, words)
