"""What went wrong: the hardest tasks, to be run again by one command, and the trials that raised errors."""

from __future__ import annotations

from collections import Counter

import numpy as np

from pin_metaik.compare.report.parts import Column, Section, Table, Value
from pin_metaik.compare.results.results import Results, cost, summarise
from pin_metaik.compare.trials.trial import Trial
from pin_metaik.ik import IKStatus

SHOWN = 5  # of each case


def worst(results: Results, folder: str) -> Section:
    """The tasks that fewest trials solved, or that took most evaluations, with the command that runs one again."""
    by_task: dict[tuple[str, str, int], list[Trial]] = {}
    for trial in results.rows():
        by_task.setdefault((trial.robot, trial.case, trial.task), []).append(trial)
    rate = {method: summarise(results.rows(method=method)).rate for method in results.methods}
    able = {method for method in results.methods if rate[method] >= 0.5} or set(results.methods)

    def hardness(task: tuple[str, str, int]) -> tuple[float, float]:
        tries = [trial for trial in by_task[task] if trial.method in able]
        missed = sum(not trial.solved for trial in tries) / max(1, len(tries))
        return missed, float(np.median([cost(trial) for trial in tries])) if tries else 0.0

    rows: list[tuple[Value, ...]] = []
    for case in results.cases:
        tasks = sorted(sorted(task for task in by_task if task[1] == case), key=hardness, reverse=True)
        for task in tasks[:SHOWN]:
            trials = by_task[task]
            again = max(trials, key=lambda t: (t.method in able, not t.solved, rate[t.method], cost(t)))
            solved = sum(trial.solved for trial in trials)
            rows.append((*task, f"{solved} of {len(trials)}", f"`{replay(folder, again)}`"))
    columns = (Column("robot"), Column("case"), Column("task"), Column("solved"), Column("see it again"))
    text = (
        "Of each case the tasks that the largest share of trials missed, then by the median of evaluations, counting "
        "methods that solve at least half of all tasks. The command runs the trial of the best method that "
        "missed it, or of the slowest, shows the pose and the answer, and says whether it is the same.",
    )
    return Section("The hardest tasks", text, (Table("worst", "The hardest of each case", columns, rows),))


def trouble(results: Results) -> Section | None:
    """Errors that were raised, successes that were none, and targets called out of reach that others met."""
    errors = Counter((t.method, t.case, t.error) for t in results.trials if t.error is not None)
    rows: list[tuple[Value, ...]] = [
        (method, case, f"{count:,} trials raised {error}") for (method, case, error), count in errors.most_common()
    ]
    for method in results.methods:
        for case in results.cases:
            claims = summarise(results.rows(case=case, method=method)).false_claims
            if claims:
                rows.append(
                    (method, case, f"{claims:,} trials claimed a solution that Pinocchio (or coal) does not confirm")
                )
    met = {(t.robot, t.case, t.task) for t in results.trials if t.met}
    denied = [t for t in results.trials if t.status == IKStatus.UNREACHABLE and (t.robot, t.case, t.task) in met]
    wrong = Counter((t.method, t.case) for t in denied)
    rows += [(*who, f"{count:,} trials said UNREACHABLE of a target that was met") for who, count in wrong.items()]
    over = Counter((t.method, t.case) for t in results.trials if (t.evaluations or 0) > t.budget)
    rows += [(*who, f"{count:,} trials spent more than their budget") for who, count in over.items()]
    if not rows:
        return None
    table = Table("trouble", "By method and case", (Column("method"), Column("case"), Column("what")), rows)
    return Section("Errors and false claims", (), (table,))


def replay(folder: str, trial: Trial) -> str:
    """The command that runs a trial again."""
    return f"pin-metaik replay {folder} {trial.name}"
