"""Arm of an aerial manipulator, full pose: the 20 settings of the modified SFLA read in two ways, and DE."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from pin_metaik.compare.papers.aerial_arm_setup import FREE, READINGS, ROWS, TEXT, TIMES, WALLS, Reading, arm, case
from pin_metaik.compare.papers.aerial_arm_tables import (
    at_the_walls,
    effort,
    inconsistent,
    panels,
    table_3,
    table_de,
    table_readings,
    versus_de,
)
from pin_metaik.compare.papers.arm import ArmTrial, hybrid, search
from pin_metaik.compare.papers.arm_report import angles, convergence, every_run, hybrids, per_run
from pin_metaik.compare.papers.paper import Job, Options, Paper
from pin_metaik.compare.report import Section
from pin_metaik.optimize.de import DE

LONG = 35_000  # evaluations of the text's reading; --quick leaves out rows with more
COMPARED = (14, 17, 18, 19)  # rows that are run in every reading, and whose convergence is drawn
DE_METHODS = {half_range: f"DE, +-{half_range:g} deg" for half_range in (WALLS, FREE)}
FLOOR = 1e-12  # of the figures: below is rounding
SMALL_BATCHES = 25  # times as long takes an evaluation in batches of three as one in batches of hundreds


def jobs(options: Options) -> Iterator[Job[ArmTrial]]:
    """Every row by SFLA, by DE, and by the hybrid at a tenth of the text's evaluations; the short rows first."""
    chains = {half_range: arm(half_range) for half_range in (WALLS, FREE)}
    for run in range(options.runs):
        for number in sorted(rows(options), key=lambda number: TEXT.evaluations(ROWS[number])):
            row = ROWS[number]
            cases = {half_range: case(chain, number) for half_range, chain in chains.items()}
            budget = TEXT.evaluations(row)
            for reading in readings(number):
                spent = reading.evaluations(row)
                job = search(
                    cases[reading.half_range],
                    str(reading),
                    reading.sfla(row),
                    spent,
                    run,
                    options.generator(number, run),
                )
                yield replace(job, size=SMALL_BATCHES * spent) if reading.leapers == "worst" else job
            for half_range, method in DE_METHODS.items():
                yield search(cases[half_range], method, DE(), budget, run, options.generator(number, run))
            yield hybrid(cases[WALLS], "SFLA", TEXT.sfla(row), budget // 10, run, options.generator(number, run))


def rows(options: Options) -> list[int]:
    """The rows to run."""
    return [number for number, row in ROWS.items() if not (options.quick and TEXT.evaluations(row) > LONG)]


def readings(number: int) -> Sequence[Reading]:
    """How a row is read: by the text, by the times, and some rows in between, too."""
    return READINGS if number in COMPARED else (TEXT, TIMES)


def sections(trials: Sequence[ArmTrial], options: Options) -> list[Section]:
    """Table 3 in both readings, what makes their difference, DE, the hybrids, and what the printed table tells."""
    trials = sorted(trials, key=lambda trial: int(trial.case.removeprefix("row ")))
    searches = [trial for trial in trials if trial.trace is not None]
    compared = [trial for trial in searches if trial.case in {f"row {number}" for number in COMPARED}]
    frogs = [trial for trial in searches if trial.method in {str(TEXT), str(TIMES)}]
    numbers = rows(options)
    return [
        Section(
            "Table 3 by the text: only the worst frog of each memeplex leaps, joints from -180 to 180 degrees",
            (
                "J = 0.7 |p_G - p| + 0.3 |rpy_G - rpy| in cm and degrees; total: the six absolute differences "
                "added up, at the best J. Evaluations: one a frog and three a leap, all that its fall-backs may need.",
                inconsistent(),
            ),
            (table_3("aerial_arm_text", trials, numbers, TEXT),),
        ),
        Section(
            "Table 3 by its printed times: every frog leaps at every step, and no joint ends at 180 degrees",
            (effort(),),
            (table_3("aerial_arm_times", trials, numbers, TIMES),),
            per_run(
                "aerial_arm_per_run",
                "Every run of every row, the median, and as a diamond the paper's J.",
                panels(trials, numbers, {f"{reading}, by row": str(reading) for reading in (TEXT, TIMES)}, True),
                "J, cm and deg",
                FLOOR,
            ),
        ),
        Section(
            "What makes the difference",
            (at_the_walls([trial for trial in searches if trial.method.endswith(f"{WALLS:g} deg")]),),
            (table_readings(trials, [number for number in COMPARED if number in numbers]),),
            convergence(
                "aerial_arm_convergence",
                "Best J so far on some rows: medians thick, runs thin; below 1e-12 is rounding.",
                compared,
                "best J so far, cm and deg",
                FLOOR,
            ),
        ),
        Section(
            "Differential evolution",
            (versus_de(trials, DE_METHODS),),
            (table_de(trials, numbers, DE_METHODS),),
            per_run(
                "aerial_arm_de_per_run",
                "Every run of DE with the evaluations of every row, and the median.",
                panels(trials, numbers, {f"{method}, by row": method for method in DE_METHODS.values()}, False),
                "J, cm and deg",
                FLOOR,
            ),
        ),
        Section(
            "Hybrids: the seeder at a tenth of the text's budget, then damped least squares",
            (),
            (hybrids("aerial_arm_hybrids", trials, "J"),),
        ),
        Section(
            "Joint angles",
            ("Angles beyond 180 degrees are shown a turn back: the posture is the same.",),
            (
                angles("aerial_arm_angles", "Best runs of SFLA", [turned_back(t) for t in frogs], "deg", "J"),
                every_run("aerial_arm_runs", trials, "J"),
            ),
        ),
    ]


def turned_back(trial: ArmTrial) -> ArmTrial:
    """The same posture with every angle from -180 to 180 degrees."""
    return replace(trial, x=trial.x - 2 * np.pi * np.rint(trial.x / (2 * np.pi)))


AERIAL_ARM = Paper(
    "aerial_arm",
    "Inverse kinematics of an aerial manipulator's arm by modified shuffled frog leaping and differential evolution",
    "Ibrahim 2018, DOI 10.22213/2413-1172-2018-4-28-34",
    3,
    jobs,
    sections,
)
