"""One trial: a method, once, on one task. Its row depends on its names and numbers, not on what ran before it."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compare.case import Attempt, Case, Task, travel
from pin_metaik.compare.method import Answer, Method

CURVE = np.geomspace(0.005, 1.0, 32)  # shares of the budget at which a row keeps the best cost so far
TIMES = ("seconds",)  # what no two runs have in common


@dataclass(frozen=True)
class Trial:
    """A row of a comparison.

    Attributes:
        robot: Name of the robot.
        case: Name of the case.
        method: Name of the method.
        target: Number of the task.
        seed: Number of the repetition: other random numbers, and another start where the case leaves it free.
        solved: Whether it is a success by the case's judgement, within what was allowed.
        claimed: Whether the method says that it solved it.
        status: How it ended, in the method's words.
        error: What was raised, or None.
        position_error: Of the worst target of the task, by Pinocchio, m.
        orientation_error: rad.
        displacement: How far the joints went from the start to the last answer, |x - x0|, rad or m.
        evaluations: Kernel evaluations spent; None when the method does not tell.
        allowed: Kernel evaluations that were allowed.
        x: (n,) the last answer.
        curve: Best cost so far at the shares ``CURVE`` of the budget, of methods that keep it.
        seconds: Processor time, s. The one thing that differs from run to run.
    """

    robot: str
    case: str
    method: str
    target: int
    seed: int
    solved: bool
    claimed: bool
    status: str
    error: str | None
    position_error: float | None
    orientation_error: float | None
    displacement: float | None
    evaluations: int | None
    allowed: int
    x: tuple[float | None, ...] | None
    curve: tuple[float | None, ...] | None
    seconds: float | None

    @property
    def key(self) -> tuple[str, str, str, int, int]:
        """What names it."""
        return self.robot, self.case, self.method, self.target, self.seed

    @property
    def name(self) -> str:
        """What names it, as one word that ``pin-metaik replay`` takes."""
        return f"{self.robot}/{self.case}/{self.target}/{self.method}/{self.seed}"

    @property
    def reproducible(self) -> dict[str, Any]:
        """The row without times: equal whenever, wherever and in whatever order it is run."""
        return {name: value for name, value in self.row().items() if name not in TIMES}

    def row(self) -> dict[str, Any]:
        """As plain values, for JSON."""
        return asdict(self)

    @staticmethod
    def of(row: Mapping[str, Any]) -> Trial:
        """What ``row`` made, read back from JSON."""
        vectors = {name: None if row[name] is None else tuple(row[name]) for name in ("x", "curve")}
        return Trial(**{**row, **vectors})


def sequence(rng: int, *path: str | int) -> np.random.SeedSequence:
    """The node of ``SeedSequence(rng)``'s tree of spawned seeds that these names and numbers lead to."""
    return np.random.SeedSequence(rng, spawn_key=tuple(_number(step) for step in path))


def generator(rng: int, *path: str | int) -> np.random.Generator:
    """A generator of its own for these names and numbers."""
    return np.random.default_rng(sequence(rng, *path))


def attempt(robot: str, case: Case, task: Task, method: Method, target: int, seed: int, budget: int, rng: int) -> Trial:
    """Let a method try a task. What it raises becomes a row; ``KeyboardInterrupt`` comes through.

    All methods start a repetition from the same coordinates.
    """
    allowed = budget * len(task.targets)
    began = process_time()
    try:
        x0 = (
            task.start
            if task.start is not None
            else task.chain.box.sample(generator(rng, robot, case.name, target, seed), 1)[0]
        )
        generators = [
            np.random.default_rng(child)
            for child in sequence(rng, robot, case.name, target, seed, method.name).spawn(len(task.targets))
        ]
        problems = task.problems
        answers: list[Answer] = []
        x = x0
        began = process_time()
        for problem, own in zip(problems, generators, strict=True):
            answers.append(method.solve(problem, x.copy(), budget, own))
            x = np.asarray(answers[-1].x, dtype=float)
        seconds = process_time() - began
        verdicts = [problem.verdict(task.chain.q(a.x)) for problem, a in zip(problems, answers, strict=True)]
        done = Attempt(x0, answers, verdicts)
        told = [answer.evaluations for answer in answers if answer.evaluations is not None]
        spent = sum(told) if len(told) == len(answers) else None
        return Trial(
            robot,
            case.name,
            method.name,
            target,
            seed,
            solved=(spent is None or spent <= allowed) and bool(case.judge(task, done)),
            claimed=all(answer.claimed for answer in answers),
            status=answers[-1].status,
            error=None,
            position_error=_finite(max(verdict.position_error for verdict in verdicts)),
            orientation_error=_finite(max(verdict.orientation_error for verdict in verdicts)),
            displacement=_finite(float(np.linalg.norm(travel(task.chain, x0, x)))),
            evaluations=spent,
            allowed=allowed,
            x=tuple(map(_finite, x.tolist())),
            curve=_curve(answers, budget),
            seconds=seconds,
        )
    except Exception as error:  # a method, or a case, of anybody: the others go on
        return failed(robot, case.name, method.name, target, seed, allowed, error, process_time() - began)


def failed(
    robot: str, case: str, method: str, target: int, seed: int, allowed: int, error: Exception, seconds: float
) -> Trial:
    """The row of a trial that raised."""
    words = f"{type(error).__name__}: {error}"
    return Trial(
        robot, case, method, target, seed, False, False, "ERROR", words, None, None, None, None, allowed, None, None,
        seconds,
    )  # fmt: skip


def _number(step: str | int) -> int:
    """A name as a number, the same on every machine."""
    return step if isinstance(step, int) else int.from_bytes(hashlib.sha256(step.encode()).digest()[:8], "little")


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _curve(answers: Sequence[Answer], budget: int) -> tuple[float | None, ...] | None:
    """The trace of a single answer at fixed shares of the budget; None before its first entry."""
    trace: NDArray[np.float64] | None = answers[0].trace if len(answers) == 1 else None
    if trace is None or not len(trace):
        return None
    best = np.minimum.accumulate(trace[:, 1])
    at = np.searchsorted(trace[:, 0], CURVE * budget, side="right") - 1
    return tuple(_finite(float(best[i])) if i >= 0 else None for i in at)
