"""Cases: each draws tasks for any robot, and judges whether an attempt is a success."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.collision import CollisionWorld
from pin_metaik.compare.methods.method import Answer
from pin_metaik.errors import MetaIKError, UnsupportedJoint
from pin_metaik.ik import IKProblem, IKStatus, Verdict
from pin_metaik.ik.problem import Asked
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

DRAWS = 1_000  # of a task, before a world is found to leave no room
BY_GOALS = "Every goal is met to within its tolerance and inside the limits, by Pinocchio, whatever the method says."
REACHED = "Within 1e-5 m and 1e-5 rad of the target and inside the limits, by Pinocchio, whatever the method says."


class NoTask(MetaIKError):
    """A case that an arm has no task of, such as singular poses of one that never loses a direction."""


@dataclass(frozen=True, eq=False)
class Task:
    """One target, or a sequence of targets, for a chain: poses of its frame, or lists of goals.

    Attributes:
        chain: The arm.
        targets: World poses, or goals that are met together; a method gets one target at a time, and starts from its
            answer to the one before.
        planted: (K, n) coordinates that the targets were made from, and which therefore reach them; None if there are
            none.
        start: (n,) start; ``None``: drawn at random for every seed.
        world: World in which nothing must collide.
    """

    chain: Chain
    targets: tuple[Asked, ...]
    planted: Array | None = None
    start: Array | None = None
    world: CollisionWorld | None = None

    @staticmethod
    @checked
    def at(chain: Chain, X: Array, start: Array | None = None) -> Task:
        """A task whose targets are the poses at the coordinates X (K, n)."""
        X = array("X", X, "K", chain.n)
        return Task(chain, tuple(chain.placements(q)[0] for q in chain.q(X)), X, start)

    @property
    def problems(self) -> list[IKProblem]:
        """The targets as problems."""
        return [IKProblem.of(self.chain, target, self.world) for target in self.targets]


@dataclass(frozen=True, eq=False)
class Attempt:
    """The answers of a method to a task, and their verdicts.

    Attributes:
        x0: (n,) start.
        answers: One for each target.
        verdicts: Pinocchio's, one for each answer.
    """

    x0: Array
    answers: Sequence[Answer]
    verdicts: Sequence[Verdict]

    @property
    def reached(self) -> bool:
        """Whether every target is met."""
        return all(verdict.accepted for verdict in self.verdicts)

    @property
    def unreachable(self) -> bool:
        """Whether the method reported every target as out of reach."""
        return all(answer.status == IKStatus.UNREACHABLE for answer in self.answers)

    @property
    def X(self) -> Array:
        """(K, n) the answers."""
        return np.array([answer.x for answer in self.answers])


def whole_arm(robot: Robot, rng: np.random.Generator) -> Chain:
    """The chain of the robot's default frame, without locked joints."""
    return Chain(robot.model, robot.frame)


def reached(task: Task, attempt: Attempt) -> bool:
    """Whether every target is met."""
    return attempt.reached


@checked
@dataclass(frozen=True)
class Case:
    """A family of tasks. Your own case is an object of this class.

    Its functions are called with random generators that depend only on the names of robot and case and on the number of
    the task, so that a task is the same whatever else is compared.

    Attributes:
        name: Name on the command line and in tables.
        about: How its targets are made, in one sentence.
        draw: Function that draws a task for a chain.
        chain: Function that returns the chain of a robot; one for all tasks.
        world: Function that returns the world of a robot; tasks are drawn until the configurations that their targets
            are made from are free of collisions.
        judge: Function that decides whether an attempt at a task is a success.
        success: What counts as a success, in one sentence.
    """

    name: str
    about: str
    draw: Callable[[Chain, np.random.Generator], Task]
    chain: Callable[[Robot, np.random.Generator], Chain] = whole_arm
    world: Callable[[Robot], CollisionWorld] | None = None
    judge: Callable[[Task, Attempt], bool] = reached
    success: str = REACHED

    @checked
    def task(self, chain: Chain, world: CollisionWorld | None, rng: np.random.Generator) -> Task:
        """Draw a task with a random generator.

        Raises:
            NoTask: The arm has no such task, or none that is free of collisions was drawn in a limited number of tries.
        """
        if world is None:
            return self.draw(chain, rng)
        for _ in range(DRAWS):
            task = self.draw(chain, rng)
            if task.planted is None or not any(world.checker.collides(q) for q in chain.q(task.planted)):
                return replace(task, world=world)
        raise NoTask(f"none of {DRAWS:,} tasks is free of collisions")

    @checked
    def lacks(self, robot: Robot, rng: np.random.Generator) -> str:
        """Why a robot has no task of this case, as far as is known without its world; empty if it has one."""
        try:
            self.draw(self.chain(robot, rng), rng)
        except (NoTask, UnsupportedJoint) as none:
            return str(none)
        except Exception:  # raised by a user's case: its rows will say it
            return ""
        return ""
