"""A target to an answer: calls of the library within a deadline, and what the page says of them."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld, Distance
from pin_metaik.gui.pages.arms.arm import Arm
from pin_metaik.ik import IKResult, IKSolutions, IKSolver, Target, solve_ik, solve_ik_all
from pin_metaik.ik.criteria import limit_proximity, neg_manipulability
from pin_metaik.optimize import Budget

DEADLINE = 0.1  # s
LIVE = IKSolver(budget=Budget(seconds=DEADLINE))
MEASURED = 12  # obstacles whose distances are shown
LIMIT = 32  # solutions that are shown
ALL = 2.0  # s for all solutions


@dataclass(frozen=True, eq=False)
class Question:
    """What the page asks.

    Attributes:
        arm: The arm.
        target: Where its tip shall be.
        q: (nq,) where it is.
        world: What it must not collide with, or None.
        asked: Time it was asked at, as ``time.perf_counter`` has it, s.
    """

    arm: Arm
    target: Target
    q: NDArray[np.float64]
    world: CollisionWorld | None
    asked: float


@dataclass(frozen=True, eq=False)
class Answer:
    """What the library says.

    Attributes:
        question: What was asked.
        result: The result.
        manipulability: Of the task's Jacobian there, by Yoshikawa's measure.
        room: Of the joint nearest to a limit: 1 in mid-range, 0 at a limit.
        colliding: Links that collide.
        nearest: To each obstacle, what of the robot is nearest to it, and where.
        answered: Time it was there, s.
    """

    question: Question
    result: IKResult
    manipulability: float
    room: float
    colliding: frozenset[str]
    nearest: tuple[Distance, ...]
    answered: float

    @property
    def latency(self) -> float:
        """From the question to the answer, s."""
        return self.answered - self.question.asked

    def words(self) -> str:
        """The answer in Markdown."""
        result = self.result
        proved = "" if result.proof is None else f"\n\n**Proved:** {result.proof}"
        return (
            f"**{result.status}**: {result.why}{proved}\n\n"
            f"| | |\n|---|---|\n"
            f"| away from the target | {1e3 * result.position_error:.3g} mm, {result.orientation_error:.3g} rad |\n"
            f"| manipulability | {self.manipulability:.4g} |\n"
            f"| room to the nearest limit | {100 * self.room:.0f} % of the way from mid-range |\n"
            f"{self._clear()}"
            f"| evaluations | {result.evaluations:,} |\n"
            f"| found in | {1e3 * result.seconds:.3g} ms |\n"
            f"| shown after | {1e3 * self.latency:.3g} ms |\n"
        )

    def _clear(self) -> str:
        """A row on the obstacle that is nearest."""
        if not self.nearest:
            return ""
        least = min(self.nearest, key=lambda one: one.distance)
        return f"| nearest to an obstacle | {least.first} to {least.second}: {1e3 * least.distance:.3g} mm |\n"


def target_of(pose: pin.SE3, orientation: bool) -> Target:
    """A target at a pose, or at its position alone."""
    return Target(pose) if orientation else Target.at(pose.translation)


def answered(question: Question) -> Answer:
    """Ask the library, within the deadline."""
    world, chain = question.world, question.arm.chain
    result = solve_ik(chain, question.target, question.q, solver=LIVE, world=world)
    problem, X = result.problem, result.x[None]
    contacts = () if world is None else world.pairs_in_collision(result.q)
    obstacles = () if world is None else world.obstacles[:MEASURED]
    return Answer(
        question,
        result,
        -float(neg_manipulability(problem, X, X[0])[0]),
        1.0 - float(limit_proximity(problem, X, X[0])[0]),
        frozenset(name for contact in contacts for name in contact[:2]),
        tuple(world.min_distance(result.q, of=obstacle.name) for obstacle in obstacles) if world is not None else (),
        time.perf_counter(),
    )


def all_answers(question: Question) -> IKSolutions:
    """All solutions, as far as two seconds find them."""
    end = time.monotonic() + ALL
    return solve_ik_all(
        question.arm.chain,
        question.target,
        question.q,
        limit=LIMIT,
        world=question.world,
        watch=lambda _: time.monotonic() > end,
    )


def code_of(question: Question, obstacles: bool) -> str:
    """Python that does the same."""
    pose = question.target.pose
    position = _numbers(pose.translation)
    lines = ["import numpy as np", "import pinocchio as pin", "import pin_metaik as mik", "", question.arm.code]
    lines += ["chain = mik.Chain(robot.model, robot.frame)"]
    if question.target.counts[3]:
        lines += [f"rotation = np.array({[[float(v) for v in row] for row in pose.rotation]})"]
        lines += [f"target = mik.Target(pin.SE3(rotation, np.array({position})))"]
    else:
        lines += [f"target = mik.Target.at({position})"]
    world = ""
    if question.world is not None:
        scene = ', mik.collision.load_scene("obstacles.json")' if obstacles else ""
        lines += [f"world = mik.CollisionWorld(robot{scene})"]
        world = ", world=world"
    lines += [f"q0 = np.array({_numbers(question.q)})", f"result = mik.solve_ik(chain, target, q0{world})"]
    lines += ["print(result.status, result.why)", "print(result.q)"]
    return "\n".join(lines)


def _numbers(values: Iterable[float]) -> str:
    return f"[{', '.join(repr(float(value)) for value in values)}]"
