"""One trial of a comparison again: its task, its answer, and whether the answer equals its row."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from pin_metaik.arguments import checked
from pin_metaik.compare.cases.case import Task
from pin_metaik.compare.folder.store import read_manifest, read_rows
from pin_metaik.compare.trials.suite import pair_name
from pin_metaik.compare.trials.trial import Trial
from pin_metaik.compare.trials.work_item import WorkItem
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.plain import plain

ROWS = ("rotation", "", "")  # the word stands before the first row of a matrix


@dataclass(frozen=True)
class Replay:
    """A trial that was run again.

    Attributes:
        trial: The new row.
        row: The stored row; None if there is none yet.
        task: The task; None if the case could not draw it, with the error in ``trial``.
    """

    trial: Trial
    row: Trial | None
    task: Task | None

    @property
    def same(self) -> bool:
        """Whether the new and the stored row are equal, apart from their times."""
        return self.row is None or self.row.reproducible == self.trial.reproducible

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: the new row, the stored one, and whether they are equal."""
        row = None if self.row is None else plain(asdict(self.row))
        return {"name": self.trial.name, "same": self.same, "trial": plain(asdict(self.trial)), "row": row}

    def lines(self) -> Iterator[str]:
        """Lines to print."""
        trial = self.trial
        yield trial.name
        yield from self._asked()
        yield f"{'solved' if trial.solved else 'not solved'}: {trial.status}, claimed: {trial.claimed}"
        if trial.error is not None:
            yield f"raised {trial.error}"
        if trial.x is not None:
            yield f"x = {_numbers(np.array(trial.x, dtype=float))}"
            yield f"errors: {trial.position_error} m, {trial.orientation_error} rad; |x - x0| = {trial.displacement}"
        spent = "does not tell" if trial.evaluations is None else f"{trial.evaluations:,}"
        yield f"kernel evaluations: {spent} of {trial.budget:,}; {1e3 * (trial.seconds or 0.0):.2f} ms"
        if self.row is None:
            yield "its row is not there yet"
        else:
            yield "as its row says" if self.same else f"its row differs: {self.row}"

    def _asked(self) -> Iterator[str]:
        """The poses of the task, or its goals, and the coordinates that they were made from."""
        if self.task is None:
            return
        targets = self.task.targets
        for i, pose in enumerate(targets, start=1):
            which = f", pose {i}" if len(targets) > 1 else ""
            if not isinstance(pose, pin.SE3):
                yield f"task {self.trial.task}{which}: {self.task.problems[i - 1].asked}"
                continue
            yield f"task {self.trial.task}{which}: position {_numbers(pose.translation)} m"
            first, *others = map(_numbers, pose.rotation)
            yield f"          rotation {first}"
            yield from (f"                   {row}" for row in others)
        if self.task.planted is not None:
            yield f"made from x = {_numbers(self.task.planted[-1])}"


@checked
def replay(folder: Path, name: str) -> Replay:
    """Run a trial of a comparison again.

    Args:
        folder: Folder of the comparison.
        name: ``robot/case/task/method/seed``.

    Raises:
        InvalidSetting: The folder holds no comparison, the name is malformed, or the comparison has no such trial.
        UnknownName: The comparison has no such robot, case or method.
    """
    manifest = read_manifest(folder)
    suite = manifest.suite(folder)
    try:
        robot, case, task, method, seed = name.split("/")
        numbers = int(task), int(seed)
    except ValueError:
        raise InvalidSetting(
            f"a trial is ROBOT/CASE/TASK/METHOD/SEED, e.g. panda/singular/17/gwo+dls/0, got {name!r}"
        ) from None
    for kind, number, count in (("task", numbers[0], suite.tasks), ("seed", numbers[1], suite.seeds)):
        if not 0 <= number < count:
            raise InvalidSetting(f"the {kind}s of this comparison are 0 to {count - 1}, got {number}")
    for kind, word, known in (
        ("robot", robot, suite.robots_by_name),
        ("case", case, suite.cases_by_name),
        ("method", method, suite.methods_by_name),
    ):
        if word not in known:
            raise UnknownName(kind, word, known)
    if pair_name(robot, case) in manifest.absent:
        raise InvalidSetting(f"no trial {name}: {manifest.absent[pair_name(robot, case)]}")
    item = WorkItem(
        robot,
        suite.robots_by_name[robot],
        suite.cases_by_name[case],
        numbers[0],
        ((suite.methods_by_name[method], numbers[1]),),
        suite.budget,
        suite.rng,
    )
    trial = item.run()[0]
    row = next((row for row in read_rows(folder) if row.key == trial.key), None)
    return Replay(trial, row, _task(item))


def _task(item: WorkItem) -> Task | None:
    try:
        return item.draw()
    except Exception:  # raised by a user's case; the trial has it
        return None


def _numbers(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.6f}" for value in values) + "]"
