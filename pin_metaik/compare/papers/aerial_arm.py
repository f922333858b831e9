"""Arm of an aerial manipulator, full pose: the 20 settings of the modified SFLA, and DE with the same evaluations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from pin_metaik.compare.papers.aerial_arm_setup import (
    MEMEPLEXES,
    ROWS,
    SIGMA,
    SOLVED,
    Row,
    arm,
    case,
    poses,
    total_error,
)
from pin_metaik.compare.papers.arm import Trial, hybrid, of, search
from pin_metaik.compare.papers.arm_report import (
    SUMMARY,
    angles,
    convergence,
    every_run,
    hybrids,
    median_seconds,
    per_run,
    summary,
)
from pin_metaik.compare.papers.paper import Job, Options, Paper
from pin_metaik.compare.papers.plots import Runs
from pin_metaik.compare.report import Column, Section, Table
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.sfla import SFLA

METHODS = ("SFLA", "DE")
LONG = 35_000  # evaluations; --quick leaves out rows with more
DRAWN = (14, 17, 18, 19)  # rows whose convergence is drawn
FLOOR = 1e-12  # of the figures: below is rounding


def jobs(options: Options) -> Iterator[Job[Trial]]:
    """Every row by SFLA, by DE, and by the hybrid at a tenth of its evaluations; the short rows first."""
    chain = arm()
    for run in range(options.runs):
        for number in sorted(rows(options), key=lambda number: ROWS[number].evaluations):
            row, here = ROWS[number], case(chain, number)
            for make, method, algorithm, budget in (
                (search, "SFLA", sfla(row), row.evaluations),
                (search, "DE", DE(), row.evaluations),
                (hybrid, "SFLA", sfla(row), row.evaluations // 10),
            ):
                yield make(here, method, algorithm, budget, run, options.generator(number, run))


def rows(options: Options) -> list[int]:
    """The rows to run."""
    return [number for number, row in ROWS.items() if not (options.quick and row.evaluations > LONG)]


def sfla(row: Row) -> SFLA:
    """The modified SFLA of a row: leap C_L = 1.3, three memeplexes, with the fall-backs of SFLA as published."""
    return SFLA(frogs=row.NP, memeplexes=MEMEPLEXES, leaps=row.iM, leap=1.3)


def sections(trials: Sequence[Trial], options: Options) -> list[Section]:
    """Table 3 again, DE with the same evaluations, the hybrids, and what the printed table says of itself."""
    trials = sorted(trials, key=lambda trial: int(trial.case.removeprefix("row ")))
    searches = [trial for trial in trials if trial.trace is not None]
    frogs = [trial for trial in searches if trial.method == "SFLA"]
    return [
        Section(
            "Table 3: the modified SFLA",
            (
                "J = 0.7 |p_G - p| + 0.3 |rpy_G - rpy| in cm and degrees; total: the six absolute differences "
                "added up, at the best J. Evaluations: one a frog and three a leap, all that its fall-backs may need.",
                inconsistent(),
                effort(),
            ),
            (table_3(trials, options),),
        ),
        Section(
            "Differential evolution with the same evaluations",
            (versus_de(trials), at_the_walls(searches)),
            (table_de(trials, options),),
            convergence(
                "aerial_arm_convergence",
                "Best J so far on some rows: medians thick, runs thin; below 1e-12 is rounding.",
                [trial for trial in searches if trial.case in {f"row {number}" for number in DRAWN}],
                "best J so far, cm and deg",
                FLOOR,
            )
            + per_run(
                "aerial_arm_per_run",
                "Every run of every row, the median, and as a diamond the paper's J.",
                panels(trials, options),
                "J, cm and deg",
                FLOOR,
            ),
        ),
        Section(
            "Hybrids: the seeder at a tenth of the budget, then damped least squares",
            (),
            (hybrids("aerial_arm_hybrids", trials, "J"),),
        ),
        Section(
            "Joint angles",
            (),
            (
                angles("aerial_arm_angles", "Best runs of SFLA", frogs, "deg", "J"),
                every_run("aerial_arm_runs", trials, "J"),
            ),
        ),
    ]


def table_3(trials: Sequence[Trial], options: Options) -> Table:
    """The paper's Table 3 and ours."""
    chain = arm()
    lines = []
    for number in rows(options):
        row, runs = ROWS[number], of(trials, case=f"row {number}", method="SFLA")
        total = float(total_error(poses(chain, runs[0].x[None]))[0]) if runs else None
        settings = (number, row.NP, row.iN, row.iM, row.evaluations)
        lines.append((*settings, row.J, *summary(runs), row.total, total, row.ms / 1000, median_seconds(runs)))
    columns = (
        *(Column(name) for name in ("row", "NP", "iN", "iM")),
        Column("evals", ","),
        Column("J paper", ".4g"),
        *SUMMARY,
        Column("total paper", ".4g"),
        Column("total ours", ".3g"),
        Column("s paper", ".2f"),
        Column("CPU s ours", ".2f"),
    )
    return Table("aerial_arm_table_3", "J, total error and median time of a run: the paper's, and ours", columns, lines)


def table_de(trials: Sequence[Trial], options: Options) -> Table:
    """SFLA and DE side by side."""
    lines = []
    for number in rows(options):
        both = [of(trials, case=f"row {number}", method=method) for method in METHODS]
        results = [value for runs in both for value in (*summary(runs)[:2], solved(runs))]
        lines.append((number, ROWS[number].evaluations, *results, *map(median_seconds, both)))
    columns = (
        Column("row"),
        Column("evals", ","),
        *(
            Column(f"{method} {what}", form)
            for method in METHODS
            for what, form in (("best", ".3g"), ("median", ".3g"), ("solved", ""))
        ),
        *(Column(f"{method} CPU s", ".2f") for method in METHODS),
    )
    title = f"J of SFLA and of DE (rand/1/bin, 50 agents, F 0.5, CR 0.9); solved: runs with J <= {SOLVED:g}"
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
    frog = [1e3 * row.ms / (row.NP * row.iN * row.iM) for row in ROWS.values()]
    return (
        f"The printed times are {min(leap):.0f} to {max(leap):.0f} us a leap, but {min(frog):.0f} to {max(frog):.0f} "
        "us for each of the NP frogs at each of the iN iM steps: as if all frogs had been evaluated at every step, "
        "not only the worst of each memeplex."
    )


def versus_de(trials: Sequence[Trial]) -> str:
    """How often each of the two finds the right region, in a sentence."""
    sfla, de = (of(trials, method=method) for method in METHODS)
    return f"Runs that found the right region, of all rows: SFLA {solved(sfla)}, DE {solved(de)}."


def at_the_walls(trials: Sequence[Trial]) -> str:
    """How many of the runs that found no solution ended at a joint limit, in a sentence."""
    stuck = [trial.x for trial in trials if trial.cost > SOLVED]
    walled = sum(bool((np.pi - np.abs(x) < np.radians(0.1)).any()) for x in stuck)
    return (
        f"Of the {len(stuck)} runs that did not, {walled} ended with a joint at -180 or 180 degrees: the limits are "
        "assumed, the paper prints none, and solutions lie just across these walls."
    )


def panels(trials: Sequence[Trial], options: Options) -> dict[str, dict[str, Runs]]:
    """Results by row by method, for the figure."""
    return {
        f"{method}, by row of Table 3": {
            str(number): Runs(
                method,
                [trial.cost for trial in of(trials, case=f"row {number}", method=method)],
                ROWS[number].J if method == "SFLA" else None,
            )
            for number in rows(options)
        }
        for method in METHODS
    }


AERIAL_ARM = Paper(
    "aerial_arm",
    "Inverse kinematics of an aerial manipulator's arm by modified shuffled frog leaping and differential evolution",
    "Ibrahim 2018, DOI 10.22213/2413-1172-2018-4-28-34",
    3,
    jobs,
    sections,
)
