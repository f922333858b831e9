"""The rows of a comparison, arranged for statistics."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.compare.folder.manifest import CaseEntry, Manifest
from pin_metaik.compare.folder.store import read_manifest, read_rows
from pin_metaik.compare.results.statistics import Pair, compare_all, wilson
from pin_metaik.compare.trials.trial import Trial
from pin_metaik.ik import IKStatus
from pin_metaik.plain import fields_of

PENALTY = 10.0  # an unsolved trial costs this many times its budget ("PAR10")


@dataclass(frozen=True)
class Summary:
    """Counts and quantiles of some trials.

    Attributes:
        trials: Number of trials.
        solved: Number of successes.
        evaluations: Median and 95th percentile of the kernel evaluations of the solved trials; None without any.
        seconds: Median and 95th percentile of the processor time of all trials, s.
        false_claims: Number of trials whose method claimed success wrongly.
        errors: Number of trials whose method raised an error.
    """

    trials: int
    solved: int
    evaluations: tuple[float, float] | None
    seconds: tuple[float, float] | None
    false_claims: int
    errors: int

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        names = ("trials", "solved", "rate", "interval", "evaluations", "seconds", "false_claims", "errors")
        return fields_of(self, *names)

    @property
    def rate(self) -> float:
        """Share of successes."""
        return self.solved / self.trials if self.trials else 0.0

    @property
    def interval(self) -> tuple[float, float]:
        """95 % confidence interval of the share of successes."""
        return wilson(self.solved, self.trials)


@dataclass(frozen=True, eq=False)
class Results:
    """The rows of a comparison, with statistics.

    Attributes:
        manifest: The settings of the comparison.
        trials: The rows so far.
    """

    manifest: Manifest
    trials: Sequence[Trial]

    @property
    def robots(self) -> list[str]:
        """Names of the robots."""
        return list(self.manifest.robots)

    @property
    def cases(self) -> dict[str, CaseEntry]:
        """The cases by name."""
        return self.manifest.cases

    @property
    def methods(self) -> list[str]:
        """Names of the methods."""
        return list(self.manifest.methods)

    @cached_property
    def rankable(self) -> list[str]:
        """Names of the methods that report their evaluations: only these can be ranked by evaluations."""
        without_count = {trial.method for trial in self.trials if trial.evaluations is None and trial.error is None}
        return [method for method in self.methods if method not in without_count]

    @checked
    def rows(self, *, robot: str | None = None, case: str | None = None, method: str | None = None) -> list[Trial]:
        """The rows of a robot, case and method."""
        if method is None:
            groups: Iterable[list[Trial]] = self._groups.values()
            return [t for group in groups for t in group if robot in (None, t.robot) and case in (None, t.case)]
        robots = self.robots if robot is None else [robot]
        cases = list(self.cases) if case is None else [case]
        return [t for r in robots for c in cases for t in self._groups.get((r, c, method), ())]

    @checked
    def spent(self, case: str, method: str, robot: str | None = None) -> Array:
        """Evaluations to solution of each row, ``inf`` of unsolved ones."""
        rows = self.rows(robot=robot, case=case, method=method)
        return np.array(
            [t.evaluations if t.solved and t.evaluations is not None else np.inf for t in rows], dtype=float
        )

    @checked
    def costs(self, case: str, robot: str | None = None) -> Array:
        """Costs (b, k) of the methods that can be ranked, on every task of a case that all of them tried.

        A trial costs its evaluations, at least 1, if it solved the task, otherwise ten times its budget; a correct
        UNREACHABLE costs 1, because its evaluations are spent on the nearest pose. Several seeds are combined by the
        geometric mean.
        """
        if (case, robot) not in self._costs:
            self._costs[case, robot] = self._table(case, robot)
        return self._costs[case, robot]

    @checked
    def hopeless(self, case: str) -> bool:
        """Whether every success in a case is a correct UNREACHABLE, so that the case tells nothing about searches."""
        ends = {trial.status for trial in self.rows(case=case) if trial.solved}
        return ends == {IKStatus.UNREACHABLE}

    @checked
    def pairs(self, case: str, robot: str | None = None) -> list[Pair]:
        """Every pair of methods that can be ranked, tested on a case."""
        if (case, robot) not in self._pairs:
            self._pairs[case, robot] = compare_all(self.rankable, self.costs(case, robot))
        return self._pairs[case, robot]

    def _table(self, case: str, robot: str | None) -> Array:
        table: dict[tuple[str, int], dict[str, list[float]]] = {}
        for method in self.rankable:
            for trial in self.rows(robot=robot, case=case, method=method):
                table.setdefault((trial.robot, trial.task), {}).setdefault(method, []).append(cost(trial))
        whole = [
            [float(np.exp(np.mean(np.log(row[method])))) for method in self.rankable]
            for row in table.values()
            if len(row) == len(self.rankable) and len({len(costs) for costs in row.values()}) == 1
        ]
        return np.array(whole).reshape(-1, len(self.rankable))

    @cached_property
    def _costs(self) -> dict[tuple[str, str | None], Array]:
        return {}

    @cached_property
    def _pairs(self) -> dict[tuple[str, str | None], list[Pair]]:
        return {}

    @cached_property
    def _groups(self) -> dict[tuple[str, str, str], list[Trial]]:
        groups: dict[tuple[str, str, str], list[Trial]] = {}
        for trial in sorted(self.trials, key=lambda trial: (trial.task, trial.seed)):
            if self.manifest.contains(trial):
                groups.setdefault((trial.robot, trial.case, trial.method), []).append(trial)
        return groups


@checked
def read_results(folder: Path) -> Results:
    """Read the comparison in a folder and its rows so far.

    Raises:
        InvalidSetting: The folder holds no comparison, or a line before the last is not a row.
    """
    return Results(read_manifest(folder), read_rows(folder))


def cost(trial: Trial) -> float:
    """Cost of a trial: its evaluations, or ten times its budget if it failed; 1 for a right UNREACHABLE."""
    if trial.solved and trial.status == IKStatus.UNREACHABLE:
        return 1.0
    if trial.solved and trial.evaluations is not None:
        return max(1.0, float(trial.evaluations))
    return PENALTY * trial.budget


@checked
def summarise(trials: Sequence[Trial]) -> Summary:
    """Counts and quantiles of these trials."""
    solved = [trial for trial in trials if trial.solved]
    return Summary(
        trials=len(trials),
        solved=len(solved),
        evaluations=_median_and_tail([t.evaluations for t in solved if t.evaluations is not None]),
        seconds=_median_and_tail([t.seconds for t in trials if t.seconds is not None]),
        false_claims=sum(trial.claimed and not trial.met for trial in trials),
        errors=sum(trial.error is not None for trial in trials),
    )


def _median_and_tail(values: Sequence[float]) -> tuple[float, float] | None:
    if not values:
        return None
    median, tail = np.quantile(np.asarray(values, dtype=float), [0.5, 0.95])
    return float(median), float(tail)
