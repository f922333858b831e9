"""Puma with an offset wrist, position only: GA and PSO on the two examples of the toolbox."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.papers.arm import ArmCase, Trial, hybrid, of, search
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
from pin_metaik.compare.report import Column, Section, Table
from pin_metaik.compare.report.plots import Runs
from pin_metaik.ik import IKProblem, Target
from pin_metaik.kinematics import Chain
from pin_metaik.optimize import Metaheuristic
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.pso import PSO
from pin_metaik.robots import load_robot

AGENTS = 100
METHODS: dict[str, Metaheuristic] = {
    "GA": GA(agents=AGENTS, crossover_rate=0.9, mutation_rate=0.2, elites=1),
    "PSO": PSO(agents=AGENTS, variant="inertia", c1=2, c2=2, w_max=0.9, w_min=0.4),
}
SOLVED = 1e-9  # in the unit of the lengths, for the hybrids
FLOOR = 1e-20  # of the figures: below is rounding


@dataclass(frozen=True)
class Example:
    """An example of the paper; it gives its lengths no unit.

    Attributes:
        lengths: h, d1, l1 .. l4.
        goal: x, y, z.
        iterations: Of 100 agents.
        p: Penalty.
    """

    lengths: Mapping[str, float]
    goal: tuple[float, float, float]
    iterations: int
    p: float

    @property
    def budget(self) -> int:
        """Evaluations."""
        return self.iterations * AGENTS

    def chain(self) -> Chain:
        """The robot with these lengths."""
        robot = load_robot("puma_offset", parameters=self.lengths)
        return Chain(robot.model, robot.frame)


EXAMPLES = {
    "Example A": Example({"h": 30, "d1": 5, "l1": 10, "l2": 10, "l3": 10, "l4": 10}, (10, 5, 60), 1000, 10),
    "Example B": Example({"h": 10, "d1": 4, "l1": 5, "l2": 5, "l3": 5, "l4": 5}, (5, 5, 10), 100, 1000),
}

# Example B by PSO (Fig. 18); theta5 as -1.57 where the print has "-.157".
PRINTED_O, PRINTED_S = 0.386079, 0.946
PRINTED_THETA = (0.19, -0.95, 1.90, 1.28, -1.57, 0.0)  # rad
PRINTED_TIP = (5.0, 4.99, 10.02)


def O(problem: IKProblem, p: float, X: Array) -> Array:  # noqa: E743  the paper's letter
    """O = p d^2 (Eq. 9-10), d the distance of the tip to the goal, for joint angles X (k, 6)."""
    return p * problem.costs(X) ** 2


def cases() -> dict[str, ArmCase]:
    """The two examples."""
    made = {}
    for name, example in EXAMPLES.items():
        problem = IKProblem.of(example.chain(), Target.at(example.goal, tolerance=SOLVED))
        made[name] = ArmCase(name, problem, partial(O, problem, example.p))
    return made


def jobs(options: Options) -> Iterator[Job[Trial]]:
    """Both examples by GA, by PSO, and by the hybrids at a tenth of the evaluations."""
    for run in range(options.runs):
        for number, (name, case) in enumerate(cases().items()):
            budget = EXAMPLES[name].budget
            for method, algorithm in METHODS.items():
                yield search(case, method, algorithm, budget, run, options.generator(number, run))
                yield hybrid(case, method, algorithm, budget // 10, run, options.generator(number, run))


def sections(trials: Sequence[Trial], options: Options) -> list[Section]:
    """The two examples, what the printed answer is worth, and the hybrids."""
    searches = [trial for trial in trials if trial.trace is not None]
    panels = {
        name: {
            method: Runs(
                method,
                [trial.cost for trial in of(trials, case=name, method=method)],
                PRINTED_O if (name, method) == ("Example B", "PSO") else None,
            )
            for method in METHODS
        }
        for name in EXAMPLES
    }
    return [
        Section(
            "GA and PSO",
            (
                "O = p d^2, with p = 10 in Example A and 1000 in Example B. The paper's result is that of its Fig. 18: "
                "Example B by PSO.",
            ),
            (table(trials),),
            convergence(
                "puma_offset_convergence",
                "Best O so far: medians thick, runs thin; below 1e-20 is rounding.",
                searches,
                "best O so far",
                FLOOR,
            )
            + per_run("puma_offset_per_run", "Every run, the median, and the printed O.", panels, "O", FLOOR),
        ),
        Section("The printed answer of Example B", (), (printed_answer(),)),
        Section(
            "Hybrids: the seeder at a tenth of the budget, then damped least squares",
            (),
            (hybrids("puma_offset_hybrids", trials, "O"),),
        ),
        Section(
            "Joint angles",
            (),
            (
                angles("puma_offset_angles", "Best runs", trials, "rad", "O"),
                every_run("puma_offset_runs", trials, "O"),
            ),
        ),
    ]


def table(trials: Sequence[Trial]) -> Table:
    """O and time, the paper's and ours."""
    rows = []
    for name, example in EXAMPLES.items():
        for method in METHODS:
            runs = of(trials, case=name, method=method)
            d = float(np.sqrt(runs[0].cost / example.p)) if runs else None
            paper = (PRINTED_O, PRINTED_S) if (name, method) == ("Example B", "PSO") else (None, None)
            results = (paper[0], *summary(runs), d, paper[1], median_seconds(runs))
            rows.append((name, method, example.budget, *results))
    columns = (
        Column("case"),
        Column("method"),
        Column("evals", ","),
        Column("O paper", ".3g"),
        *SUMMARY,
        Column("d best", ".2g"),
        Column("s paper", ".3f"),
        Column("CPU s ours", ".3f"),
    )
    return Table("puma_offset_o", "O and median time of a run: the paper's, and ours", columns, rows)


def printed_answer() -> Table:
    """O of what is printed: the number, the tip, and the tip that the angles give."""
    example = EXAMPLES["Example B"]
    reached = example.chain().poses(PRINTED_THETA)[0, 0, :3, 3].tolist()
    rows = [
        (what, *tip, example.p * float(np.sum(np.subtract(tip, example.goal) ** 2)))
        for what, tip in (("tip as printed", PRINTED_TIP), ("tip at the printed angles", reached))
    ]
    columns = (Column(""), *(Column(axis, ".3f") for axis in "xyz"), Column("O", ".3g"))
    return Table("puma_offset_printed", f"Printed: O = {PRINTED_O:.3g}", columns, rows)


PUMA_OFFSET = Paper(
    "puma_offset",
    "Inverse kinematics of a Puma with an offset wrist by GA and PSO",
    "Toz, Erdogmus, Sahin: e-J. New World Sci. Acad. 6(4), 2011, 1A0269",
    10,
    jobs,
    sections,
)
