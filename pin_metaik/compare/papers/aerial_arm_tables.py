"""Tables and sentences of the aerial arm's report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from pin_metaik.compare.papers.aerial_arm_setup import (
    READINGS,
    ROWS,
    SIGMA,
    SOLVED,
    TEXT,
    TIMES,
    Reading,
    arm,
    poses,
    total_error,
)
from pin_metaik.compare.papers.arm import Trial, of
from pin_metaik.compare.papers.arm_report import SUMMARY, median_seconds, summary
from pin_metaik.compare.report import Column, Table
from pin_metaik.compare.report.plots import Runs


def table_3(name: str, trials: Sequence[Trial], numbers: Iterable[int], reading: Reading) -> Table:
    """The paper's Table 3 and ours, in one reading."""
    chain = arm(reading.half_range)
    lines = []
    for number in numbers:
        row, runs = ROWS[number], of(trials, case=f"row {number}", method=str(reading))
        total = float(total_error(poses(chain, runs[0].x[None]))[0]) if runs else None
        settings = (number, row.NP, row.iN, row.iM, reading.evaluations(row))
        ours = (*summary(runs)[:3], solved(runs))
        lines.append((*settings, row.J, *ours, row.total, total, row.ms / 1000, median_seconds(runs)))
    columns = (
        *(Column(name) for name in ("row", "NP", "iN", "iM")),
        Column("evals", ","),
        Column("J paper", ".4g"),
        *SUMMARY[:3],
        Column("solved"),
        Column("total paper", ".4g"),
        Column("total ours", ".3g"),
        Column("s paper", ".2f"),
        Column("CPU s ours", ".2f"),
    )
    title = f"J, total error and median time of a run: the paper's, and ours; solved: runs with J <= {SOLVED:g}"
    return Table(name, title, columns, lines)


def table_readings(trials: Sequence[Trial], numbers: Iterable[int]) -> Table:
    """Some rows in every reading."""
    lines = []
    for number in numbers:
        for reading in READINGS:
            runs = of(trials, case=f"row {number}", method=str(reading))
            ours = (*summary(runs)[:3], solved(runs), median_seconds(runs))
            lines.append((f"row {number}", str(reading), reading.evaluations(ROWS[number]), ROWS[number].J, *ours))
    columns = (
        Column("row"),
        Column("which frogs leap, joint range"),
        Column("evals", ","),
        Column("J paper", ".3g"),
        *SUMMARY[:3],
        Column("solved"),
        Column("CPU s", ".2f"),
    )
    return Table("aerial_arm_readings", "J in every reading", columns, lines)


def table_de(trials: Sequence[Trial], numbers: Iterable[int], methods: Mapping[float, str]) -> Table:
    """SFLA by the text, and DE with its evaluations on both ranges of the joints."""
    names = (str(TEXT), *methods.values())
    lines = []
    for number in numbers:
        all_runs = [of(trials, case=f"row {number}", method=method) for method in names]
        results = [value for runs in all_runs for value in (summary(runs)[1], solved(runs))]
        lines.append((number, TEXT.evaluations(ROWS[number]), *results, *map(median_seconds, all_runs[:2])))
    columns = (
        Column("row"),
        Column("evals", ","),
        *(
            Column(f"{label} {what}", form)
            for label in ("SFLA", *(method.replace(", +-", " ") for method in methods.values()))
            for what, form in (("median", ".3g"), ("solved", ""))
        ),
        Column("SFLA CPU s", ".2f"),
        Column("DE CPU s", ".2f"),
    )
    title = f"J of SFLA by the text and of DE (rand/1/bin, 50 agents, F 0.5, CR 0.9); solved: runs with J <= {SOLVED:g}"
    return Table("aerial_arm_de", title, columns, lines)


def solved(runs: Sequence[Trial]) -> str:
    """How many runs found the right region."""
    return f"{sum(trial.cost <= SOLVED for trial in runs)}/{len(runs)}"


def inconsistent() -> str:
    """Rows whose printed J no pose can have: J <= sigma * total whatever the pose."""
    impossible = [str(number) for number, row in ROWS.items() if SIGMA * row.total < row.J]
    return (
        f"J is at most {SIGMA} times the total error of the same pose: the printed rows {', '.join(impossible)} have "
        "more, so their J and total are not of one pose."
    )


def effort() -> str:
    """What the printed times say about the evaluations that were really spent."""
    leap = [1e3 * row.ms / row.leaps for row in ROWS.values()]
    frog = [1e3 * row.ms / row.frog_steps for row in ROWS.values()]
    return (
        f"The printed times are {min(leap):.0f} to {max(leap):.0f} us a leap, but {min(frog):.0f} to {max(frog):.0f} "
        "us for each of the NP frogs at each of the iN iM steps: as if all frogs had been evaluated at every step, "
        "not only the worst of each memeplex."
    )


def versus_de(trials: Sequence[Trial], methods: Mapping[float, str]) -> str:
    """How often each of the methods finds the right region, in a sentence."""
    found = "; ".join(
        f"{name}: {solved(of(trials, method=name))}" for name in (str(TEXT), str(TIMES), *methods.values())
    )
    return f"Runs that found the right region, of all rows: {found}. DE has the evaluations of the text's SFLA."


def at_the_walls(trials: Sequence[Trial]) -> str:
    """How many of the runs that found no solution ended at a joint limit, in a sentence."""
    stuck = [trial.x for trial in trials if trial.cost > SOLVED]
    walled = sum(bool((np.pi - np.abs(x) < np.radians(0.1)).any()) for x in stuck)
    return (
        f"Of the {len(stuck)} runs that found no solution between -180 and 180 degrees, {walled} ended with a joint at "
        "one of them: the limits are assumed, the paper prints none, and solutions lie just across these walls."
    )


def panels(
    trials: Sequence[Trial], numbers: Sequence[int], methods: Mapping[str, str], printed: bool
) -> dict[str, dict[str, Runs]]:
    """Results by row, a panel a method, for the figure; with the printed J or without."""
    return {
        title: {
            str(number): Runs(
                method,
                [trial.cost for trial in of(trials, case=f"row {number}", method=method)],
                ROWS[number].J if printed else None,
            )
            for number in numbers
        }
        for title, method in methods.items()
    }
