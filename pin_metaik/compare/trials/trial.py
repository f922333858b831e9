"""One trial: a method, once, on one task. Its row depends on its names and numbers, not on what ran before it."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.compare.cases.case import Attempt, Case, Task
from pin_metaik.compare.methods.method import Answer, Method
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik import IKProblem

CURVE = np.geomspace(0.005, 1.0, 32)  # shares of the budget at which a row keeps the best cost so far
TIMES = ("seconds",)  # fields that differ between runs


@checked
@dataclass(frozen=True)
class Trial:
    """A row of a comparison.

    Attributes:
        robot: Name of the robot.
        case: Name of the case.
        method: Name of the method.
        task: Number of the task.
        seed: Number of the repetition, which has other random numbers and, unless the case sets it, another start.
        budget: Kernel evaluations that were allowed, for all targets of the task together.
        solved: Whether it is a success by the case's judgement, within the budget.
        met: Whether every target is within the tolerances and inside the limits, by Pinocchio.
        claimed: Whether the method claims that they are.
        status: How it ended, in the method's words.
        error: The error that was raised, or None.
        position_error: Position error of the worst target of the task, by Pinocchio, m.
        orientation_error: Likewise, rad.
        displacement: How far the joints went from the start to the last answer, |x - x0|, rad or m.
        evaluations: Kernel evaluations spent; None if the method does not count them.
        x: (n,) the last answer.
        curve: Best cost so far at the shares ``CURVE`` of the budget, if the method records it.
        seconds: Processor time, s: the only field that differs from run to run.
    """

    robot: str
    case: str
    method: str
    task: int
    seed: int
    budget: int
    solved: bool = False
    met: bool = False
    claimed: bool = False
    status: str = "ERROR"
    error: str | None = None
    position_error: float | None = None
    orientation_error: float | None = None
    displacement: float | None = None
    evaluations: int | None = None
    x: tuple[float | None, ...] | None = None
    curve: tuple[float | None, ...] | None = None
    seconds: float | None = None

    @property
    def key(self) -> tuple[str, str, str, int, int]:
        """Robot, case, method, task and seed: what identifies the trial."""
        return self.robot, self.case, self.method, self.task, self.seed

    @property
    def name(self) -> str:
        """The name of the trial for ``pin-metaik replay``."""
        return f"{self.robot}/{self.case}/{self.task}/{self.method}/{self.seed}"

    @property
    def reproducible(self) -> dict[str, Any]:
        """The row without times, which does not depend on when, where and in which order it is run."""
        return {name: value for name, value in self.row().items() if name not in TIMES}

    def row(self) -> dict[str, Any]:
        """As plain values, for JSON."""
        return asdict(self)

    @staticmethod
    @checked
    def from_row(row: Mapping[str, Any]) -> Trial:
        """A trial from a row read back from JSON."""
        fields = Trial.__dataclass_fields__
        if wrong := fields.keys() ^ row.keys():
            raise InvalidSetting(
                f"a row of a comparison has the keys {', '.join(fields)}; {min(wrong)!r} is missing or unknown"
            )
        vectors = {name: None if row[name] is None else tuple(row[name]) for name in ("x", "curve")}
        return Trial(**{**row, **vectors})


def sequence(rng: int, *path: str | int) -> np.random.SeedSequence:
    """The node of ``SeedSequence(rng)``'s tree of spawned seeds that these names and numbers lead to."""
    return np.random.SeedSequence(rng, spawn_key=tuple(_number(step) for step in path))


def generator(rng: int, *path: str | int) -> np.random.Generator:
    """A generator of its own for these names and numbers."""
    return np.random.default_rng(sequence(rng, *path))


def attempt(robot: str, case: Case, task: Task, method: Method, number: int, seed: int, budget: int, rng: int) -> Trial:
    """Let a method try the task of a number. An exception becomes a row; ``KeyboardInterrupt`` is raised.

    All methods start a repetition from the same coordinates.
    """
    path = (robot, case.name, number, seed)
    row = Trial(robot, case.name, method.name, number, seed, budget * len(task.targets))
    began = process_time()
    try:
        start = task.chain.box.sample(generator(rng, *path), 1)[0] if task.start is None else task.start
        own = sequence(rng, *path, method.name).spawn(len(task.targets))
        x, answers, problems = start, list[Answer](), task.problems
        began = process_time()
        for problem, child in zip(problems, own, strict=True):
            answers.append(_answered(method, problem, x, budget, np.random.default_rng(child)))
            x = np.asarray(answers[-1].x, dtype=float)
        seconds = process_time() - began
        verdicts = [problem.verdict(task.chain.q(a.x)) for problem, a in zip(problems, answers, strict=True)]
        return _judged(row, case, task, Attempt(start, answers, verdicts), _curve(answers, budget), seconds)
    except Exception as error:  # raised by a user's method or case: the others go on
        return failed(row, error, process_time() - began)


def _answered(method: Method, problem: IKProblem, x: Array, budget: int, rng: np.random.Generator) -> Answer:
    """A method's answer; while it collides, the method is called again from a random start within the budget."""
    answer = method.solve(problem, x.copy(), budget, rng)
    spent = answer.evaluations
    while spent is not None and spent < budget and problem.verdict(problem.chain.q(answer.x)).collides:
        start = problem.box.sample(rng, 1)[0]
        answer = method.solve(problem, start, budget - spent, rng)
        spent = None if answer.evaluations is None else spent + max(1, answer.evaluations)
    return replace(answer, evaluations=spent)


def failed(row: Trial, error: Exception, seconds: float = 0.0) -> Trial:
    """The row of a trial that raised."""
    return replace(row, error=f"{type(error).__name__}: {error}", seconds=seconds)


def _judged(
    row: Trial, case: Case, task: Task, done: Attempt, curve: tuple[float | None, ...] | None, seconds: float
) -> Trial:
    """The row of a trial that came to an end; one over its budget has not solved its task."""
    reported = [answer.evaluations for answer in done.answers if answer.evaluations is not None]
    spent = sum(reported) if len(reported) == len(done.answers) else None
    last = done.X[-1]
    return replace(
        row,
        solved=(spent is None or spent <= row.budget) and bool(case.judge(task, done)),
        met=done.reached,
        claimed=all(answer.claimed for answer in done.answers),
        status=done.answers[-1].status,
        position_error=_finite(max(verdict.position_error for verdict in done.verdicts)),
        orientation_error=_finite(max(verdict.orientation_error for verdict in done.verdicts)),
        displacement=_finite(float(np.linalg.norm(task.chain.limits.way(done.x0, last)))),
        evaluations=spent,
        x=tuple(map(_finite, last.tolist())),
        curve=curve,
        seconds=seconds,
    )


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
