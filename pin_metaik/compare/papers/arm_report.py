"""What the arm papers' reports share: summaries of runs, hybrids, joint angles, every single run, figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any, Literal

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.papers.arm import Trial, of
from pin_metaik.compare.report import Column, Figure, Table, Value, plots

SUMMARY = (Column("best", ".3g"), Column("median", ".3g"), Column("worst", ".3g"), Column("runs"))


def summary(trials: Sequence[Trial]) -> tuple[Value, ...]:
    """Best, median and worst cost and the number of runs: the columns ``SUMMARY``."""
    costs = [trial.cost for trial in trials]
    return (min(costs), median(costs), max(costs), len(costs)) if costs else (None, None, None, 0)


def median_seconds(trials: Sequence[Trial]) -> float | None:
    """Median processor time of a run, in s."""
    return median(trial.seconds for trial in trials) if trials else None


def seconds_per_evaluation(trials: Sequence[Trial]) -> float | None:
    """Median processor time of an evaluation with all that the method does around it, in s."""
    return median(trial.seconds / trial.evaluations for trial in trials) if trials else None


def hybrids(name: str, trials: Sequence[Trial], cost: str) -> Table:
    """What the hybrids reached and spent, by case and method."""
    rows: list[tuple[Value, ...]] = []
    for case, method, budget in _groups([trial for trial in trials if trial.trace is None]):
        runs = of(trials, case=case, method=method, budget=budget)
        spent = [trial.evaluations for trial in runs]
        milliseconds = 1e3 * median(trial.seconds for trial in runs)
        rows.append((case, method, budget, *summary(runs), median(spent), max(spent), milliseconds))
    columns = (
        Column("case"),
        Column("method"),
        Column("evals allowed", ","),
        *SUMMARY,
        Column("evals median", ",.0f"),
        Column("evals most", ","),
        Column("CPU ms", ".1f"),
    )
    return Table(name, f"{cost}: the seeder at a tenth of the budget, then DLS until it is solved", columns, rows)


def angles(name: str, title: str, trials: Sequence[Trial], unit: Literal["rad", "deg"], cost: str) -> Table:
    """Joint angles of the best run of every case, method and budget."""
    best = [of(trials, case=case, method=method, budget=budget)[0] for case, method, budget in _groups(trials)]
    scale, form = (1.0, ".3f") if unit == "rad" else (np.degrees(1.0), ".2f")
    head = (Column("case"), Column("method"), Column("evals", ","), Column(cost, ".3g"))
    return Table(
        name,
        f"{title}, joint angles in {unit}",
        head + tuple(Column(f"q{i + 1}", form) for i in range(_joints(trials))),
        [(trial.case, trial.method, trial.budget, trial.cost, *(scale * trial.x).tolist()) for trial in best],
    )


def every_run(name: str, trials: Sequence[Trial], cost: str) -> Table:
    """Every single run, for the CSV file."""
    headings = ("case", "method", "budget", "run", cost, "evaluations", "seconds")
    return Table(
        name,
        "Every run",
        tuple(map(Column, headings)) + tuple(Column(f"q{i + 1} rad") for i in range(_joints(trials))),
        [(t.case, t.method, t.budget, t.run, t.cost, t.evaluations, t.seconds, *t.x.tolist()) for t in trials],
        shown=False,
    )


def convergence(name: str, caption: str, trials: Sequence[Trial], cost: str, floor: float) -> tuple[Figure, ...]:
    """Best cost against evaluations, a panel a case, each method at its longest budget; none if nothing was run."""
    longest: dict[tuple[str, str], int] = {}
    for case, method, budget in _groups([trial for trial in trials if trial.trace is not None]):
        longest[case, method] = max(budget, longest.get((case, method), 0))
    panels: dict[str, dict[str, list[Array]]] = {}
    for (case, method), budget in longest.items():
        runs = of(trials, case=case, method=method, budget=budget)
        panels.setdefault(case, {})[method] = [trial.trace for trial in runs if trial.trace is not None]

    def draw(canvas: Any) -> None:
        plots.convergence(canvas, panels, cost, floor)

    return (Figure(name, caption, draw, plots.size(*(1 for _ in panels))),) if panels else ()


def per_run(
    name: str, caption: str, panels: Mapping[str, Mapping[str, plots.Runs]], cost: str, floor: float
) -> tuple[Figure, ...]:
    """Every run's result as a dot; none if nothing was run."""

    def draw(canvas: Any) -> None:
        plots.strip(canvas, panels, cost, floor)

    ran = any(runs.costs for panel in panels.values() for runs in panel.values())
    return (Figure(name, caption, draw, plots.size(*map(len, panels.values()))),) if ran else ()


def _groups(trials: Sequence[Trial]) -> list[tuple[str, str, int]]:
    """The cases, methods and budgets there are, in the order of the cases."""
    found = dict.fromkeys((trial.case, trial.method, trial.budget) for trial in trials)
    cases = list(dict.fromkeys(trial.case for trial in trials))
    return sorted(found, key=lambda group: cases.index(group[0]))


def _joints(trials: Sequence[Trial]) -> int:
    return len(trials[0].x) if trials else 0
