"""One trial of a comparison again: what was asked, what came out, and whether that is what its row says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.compare.case import Task
from pin_metaik.compare.store import read_record, read_rows
from pin_metaik.compare.trial import Trial
from pin_metaik.compare.unit import Unit
from pin_metaik.errors import InvalidSetting, UnknownName

ROWS = ("rotation", "", "")  # the word stands before the first row of a matrix


@dataclass(frozen=True)
class Replay:
    """A trial that was run again.

    Attributes:
        trial: What came out.
        row: What its row says; None if it has none yet.
        task: What was asked.
    """

    trial: Trial
    row: Trial | None
    task: Task

    @property
    def same(self) -> bool:
        """Whether both are equal, times aside."""
        return self.row is None or self.row.reproducible == self.trial.reproducible

    def lines(self) -> Iterator[str]:
        """What to show."""
        trial = self.trial
        yield trial.name
        for i, pose in enumerate(self.task.targets):
            which = f", pose {i + 1}" if len(self.task.targets) > 1 else ""
            yield f"target {trial.target}{which}: position {_numbers(pose.translation)} m"
            yield from (f"{word:>12} {_numbers(row)}" for word, row in zip(ROWS, pose.rotation, strict=True))
        if self.task.planted is not None:
            yield f"made from x = {_numbers(self.task.planted[-1])}"
        yield f"{'solved' if trial.solved else 'not solved'}: {trial.status}, claimed: {trial.claimed}"
        if trial.error is not None:
            yield f"raised {trial.error}"
        if trial.x is not None:
            yield f"x = {_numbers(np.array(trial.x, dtype=float))}"
            yield f"errors: {trial.position_error} m, {trial.orientation_error} rad; |x - x0| = {trial.displacement}"
        spent = "does not tell" if trial.evaluations is None else f"{trial.evaluations:,}"
        yield f"kernel evaluations: {spent} of {trial.allowed:,}; {1e3 * (trial.seconds or 0.0):.2f} ms"
        if self.row is None:
            yield "its row is not there yet"
        else:
            yield "as its row says" if self.same else f"its row differs: {self.row}"


@checked
def replay(folder: Path, name: str) -> Replay:
    """Run a trial of a comparison again.

    Args:
        folder: Of the comparison.
        name: ``robot/case/target/method/seed``.

    Raises:
        InvalidSetting: The folder holds no comparison, or the name is none, or one of a target it does not have.
        UnknownName: The comparison has no such robot, case or method.
    """
    suite = read_record(folder).suite()
    try:
        robot, case, target, method, seed = name.split("/")
        numbers = int(target), int(seed)
    except ValueError:
        raise InvalidSetting(
            f"a trial is ROBOT/CASE/TARGET/METHOD/SEED, e.g. panda/singular/17/gwo+dls/0, got {name!r}"
        ) from None
    for kind, number, count in (("target", numbers[0], suite.targets), ("seed", numbers[1], suite.seeds)):
        if not 0 <= number < count:
            raise InvalidSetting(f"the {kind}s of this comparison are 0 to {count - 1}, got {number}")
    for kind, word, known in (
        ("robot", robot, suite.arms),
        ("case", case, suite.tasks),
        ("method", method, suite.entrants),
    ):
        if word not in known:
            raise UnknownName(kind, word, known)
    unit = Unit(
        robot,
        suite.arms[robot],
        suite.tasks[case],
        numbers[0],
        ((suite.entrants[method], numbers[1]),),
        suite.budget,
        suite.rng,
    )
    trial = unit.work()[0]
    row = next((row for row in read_rows(folder) if row.key == trial.key), None)
    return Replay(trial, row, unit.task())


def _numbers(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.6f}" for value in values) + "]"
