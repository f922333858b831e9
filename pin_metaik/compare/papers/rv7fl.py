"""RV-7FL-D, position only: GWO, improved GWO and MTDE, in the paper's units of budget and at equal evaluations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from statistics import median
from typing import TypeAlias

from pin_metaik.compare.papers.arm import Trial, hybrid, of, search
from pin_metaik.compare.papers.arm_report import (
    SUMMARY,
    angles,
    convergence,
    every_run,
    hybrids,
    median_seconds,
    per_run,
    seconds_per_evaluation,
    summary,
)
from pin_metaik.compare.papers.paper import Job, Options, Paper
from pin_metaik.compare.papers.rv7fl_setup import (
    EQUAL,
    LONG,
    METHODS,
    PRINTED,
    SHORT,
    SOLVED,
    TARGETS,
    TENTH,
    Printed,
    cases,
)
from pin_metaik.compare.report import Column, Section, Table
from pin_metaik.compare.report.plots import Runs

ROUNDING = 1e-9  # mm; smaller differences do not count

Outcomes: TypeAlias = dict[tuple[str, str], Printed]  # by case and method


def jobs(options: Options) -> Iterator[Job[Trial]]:
    """The comparison in both units and the hybrids, then MTDE's long budget, then the wolves'."""
    arms = cases()

    def try_all(trial: Callable[..., Job[Trial]], budgets: Mapping[str, int]) -> Iterator[Job[Trial]]:
        for run in range(options.runs):  # outermost, so that there is something to compare whenever it is interrupted
            for number, case in enumerate(arms):
                for method, budget in budgets.items():
                    yield trial(case, method, METHODS[method], budget, run, options.generator(number, run))

    yield from try_all(search, SHORT)
    yield from try_all(search, {"MTDE": EQUAL["MTDE"]})  # the wolves' short budget is this already
    yield from try_all(hybrid, TENTH)
    if not options.quick:
        yield from try_all(search, {"MTDE": LONG["MTDE"]})
    if options.long:
        yield from try_all(search, {method: LONG[method] for method in LONG if method != "MTDE"})


def sections(trials: Sequence[Trial], options: Options) -> list[Section]:
    """The paper's table in its own units of budget and at equal evaluations, the long budget, and the hybrids."""
    searches = [trial for trial in trials if trial.trace is not None]
    comparison = [trial for trial in searches if trial.budget <= EQUAL["MTDE"]]
    return [
        Section(
            "As printed: 1000 iterations, which are not the same for all",
            (
                "An iteration of the wolves is 300 evaluations, one of MTDE is a single one.",
                versus("MTDE", trials, SHORT),
                versus("improved GWO", trials, SHORT),
            ),
            (side_by_side("rv7fl_as_printed", trials, SHORT, SHORT),),
        ),
        Section(
            "At equal evaluations: 300,000 for each",
            (f"What changes. {versus('MTDE', trials, EQUAL)}", verdict(trials)),
            (side_by_side("rv7fl_equal", trials, EQUAL, SHORT),),
            convergence(
                "rv7fl_convergence",
                "Medians thick, runs thin; below 1e-12 mm is rounding.",
                comparison,
                "best F so far, mm",
                1e-12,
            )
            + per_run(
                "rv7fl_per_run",
                "Every run, the median, and as a diamond the paper's best of 10.",
                panels(trials),
                "F, mm",
                1e-12,
            ),
        ),
        Section(
            "The long budget: 600,000 iterations",
            (wolves_need(trials, options),),
            (side_by_side("rv7fl_long", trials, LONG, LONG),),
        ),
        Section(
            "Hybrids: the seeder at a tenth of the budget, then damped least squares",
            (
                f"Solved means to {SOLVED:g} mm. Case 1 lies on the inner wall of the reachable tube, where the "
                "Jacobian is singular and damped least squares slow down.",
            ),
            (hybrids("rv7fl_hybrids", trials, "F mm"),),
        ),
        Section(
            "Joint angles",
            ("The tip depends on the first three joints only; the others are where the search left them.",),
            (angles("rv7fl_angles", "Best runs", searches, "rad", "F mm"), every_run("rv7fl_runs", trials, "F mm")),
        ),
    ]


def side_by_side(name: str, trials: Sequence[Trial], budgets: Mapping[str, int], papers: Mapping[str, int]) -> Table:
    """The paper's best of 10 and ours, its evaluations and ours."""
    rows = []
    for case in TARGETS:
        for method, budget in budgets.items():
            ours, paper = of(trials, case=case, method=method, budget=budget), PRINTED[case, method, papers[method]]
            spent = (papers[method], budget)
            rows.append((case, method, *spent, paper.F, *summary(ours), paper.seconds, median_seconds(ours)))
    evaluations = (Column("evals paper", ","), Column("evals ours", ","))
    times = (Column("s paper", ".3f"), Column("CPU s ours", ".3f"))
    columns = (Column("case"), Column("method"), *evaluations, Column("paper", ".4g"), *SUMMARY, *times)
    return Table(name, "F in mm and median time of a run in s; the paper's best of 10 runs, and ours", columns, rows)


def versus(method: str, trials: Sequence[Trial], budgets: Mapping[str, int]) -> str:
    """How a method compares with GWO, here and in the paper, in a sentence."""
    best: Outcomes = {}
    for case in TARGETS:
        for name in (method, "GWO"):
            if runs := of(trials, case=case, method=name, budget=budgets[name]):
                best[case, name] = Printed(runs[0].cost, median_seconds(runs) or 0.0)
    printed = {
        (case, name): PRINTED[case, name, budgets[name]]
        for case in TARGETS
        for name in (method, "GWO")
        if (case, name, budgets[name]) in PRINTED
    }
    theirs = f"; in the paper: {record(method, printed)}" if printed.keys() >= best.keys() else ""
    against = (
        f"{method[0].upper()}{method[1:]} with {budgets[method]:,} evaluations, against GWO with {budgets['GWO']:,}"
    )
    return f"{against}: {record(method, best)}{theirs}."


def record(method: str, outcomes: Outcomes) -> str:
    """On how many cases a method is better than GWO, and in which share of its time."""
    pairs = [(outcomes[c, method], outcomes[c, "GWO"]) for c in TARGETS if {(c, method), (c, "GWO")} <= outcomes.keys()]
    if not pairs:
        return "not run"
    better = sum(ours.F < gwo.F - ROUNDING for ours, gwo in pairs)
    worse = sum(ours.F > gwo.F + ROUNDING for ours, gwo in pairs)
    ratio = median(ours.seconds / gwo.seconds for ours, gwo in pairs)
    time = f"{ratio:.1f} times the time" if ratio > 0.1 else f"1/{1 / ratio:.0f} of the time"
    return (
        f"better on {better}, equal on {len(pairs) - better - worse}, worse on {worse} of {len(pairs)} cases in {time}"
    )


def verdict(trials: Sequence[Trial]) -> str:
    """What the printed times measured, in a sentence."""
    wolves, mtde = (seconds_per_evaluation(of(trials, method=m, budget=EQUAL[m])) for m in ("GWO", "MTDE"))
    if wolves is None or mtde is None:
        return "GWO and MTDE were not both run."
    slower = "slower" if mtde > wolves else "faster"
    return (
        f"An evaluation takes {1e6 * mtde:.2f} us in MTDE and {1e6 * wolves:.2f} us in GWO: MTDE is the {slower} one; "
        f"the speed the paper reports for it is that it was given 1/{SHORT['GWO'] // SHORT['MTDE']} of the evaluations."
    )


def wolves_need(trials: Sequence[Trial], options: Options) -> str:
    """What the wolves' long budget costs, estimated from their short one."""
    wolves = [method for method in LONG if method != "MTDE"]
    each = [seconds_per_evaluation(of(trials, method=method, budget=SHORT[method])) for method in wolves]
    if options.long or None in each:
        return f"For the wolves it is {LONG['GWO']:,} evaluations a run."
    hours = sum(LONG[m] * (s or 0.0) for m, s in zip(wolves, each, strict=True)) * len(TARGETS) * options.runs / 3600
    return (
        f"For the wolves it is {LONG['GWO']:,} evaluations a run. At the speed measured above their "
        f"{len(wolves) * len(TARGETS) * options.runs} runs would take {hours:.1f} hours: --long runs them."
    )


def panels(trials: Sequence[Trial]) -> dict[str, dict[str, Runs]]:
    """Results by method and budget by case, for the figure."""
    short = {"GWO": "GWO", "improved GWO": "impr.\nGWO", "MTDE": "MTDE"}
    budgets = [*SHORT.items(), ("MTDE", EQUAL["MTDE"]), ("MTDE", LONG["MTDE"])]
    return {
        case: {
            f"{short[method]}\n{budget // 1000}k": Runs(
                method,
                [trial.cost for trial in of(trials, case=case, method=method, budget=budget)],
                PRINTED[case, method, budget].F if (case, method, budget) in PRINTED else None,
            )
            for method, budget in budgets
        }
        for case in TARGETS
    }


RV7FL = Paper(
    "rv7fl",
    "Inverse kinematics of the RV-7FL-D by GWO, improved GWO and MTDE",
    "DEU FMD 26(78), 2024, 449-457",
    10,
    jobs,
    sections,
)
