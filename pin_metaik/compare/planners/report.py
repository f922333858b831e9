"""The report on a comparison of path planners: a table with the gaps to the shortest paths, and figures."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median
from typing import Any

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.planners.figures import Overlaid, overlay, shape_of, times
from pin_metaik.compare.planners.run import PlannerComparison, PlannerRun
from pin_metaik.compare.report import Column, Figure, Section, Table, Value, plots

PANEL = 3.4  # inches


def sections(comparison: PlannerComparison) -> list[Section]:
    """The table, every run, and the figures."""
    text = (
        "Gaps are to the shortest path, in percent of it, over the runs whose path is free by the exact test. An "
        "evaluation is a path of a metaheuristic, or a straight line that another planner tests. Times are processor "
        "time, from the free space on.",
    )
    tables = (comparison_table(comparison), every_run(comparison))
    return [Section("Path planners", text, tables, figures(comparison) if comparison.runs else ())]


def comparison_table(comparison: PlannerComparison) -> Table:
    """Every scene and planner, in numbers."""
    rows: list[tuple[Value, ...]] = []
    for scene in comparison.problems:
        for method in comparison.methods:
            runs = comparison.of(scene, method)
            if not runs:
                continue
            gaps = [100 * run.plan.gap for run in runs if run.plan.gap is not None]
            gap = (min(gaps), median(gaps), max(gaps)) if gaps else (None, None, None)
            free = 100 * sum(run.plan.success for run in runs) / len(runs)
            spent, ms = median(run.plan.evaluations for run in runs), 1e3 * median(run.seconds for run in runs)
            rows.append((scene, method, len(runs), free, *gap, spent, ms))
    columns = (
        *(Column("scene"), Column("planner"), Column("runs"), Column("free %", ".0f")),
        *(Column("best gap %", ".2f"), Column("median %", ".2f"), Column("worst %", ".1f")),
        *(Column("evaluations", ",.0f"), Column("ms", ".1f")),
    )
    return Table("planners", "Gap to the shortest path", columns, rows)


def every_run(comparison: PlannerComparison) -> Table:
    """Every run, for the CSV file."""
    headings = ("scene", "planner", "run", "seed", "status", "length", "gap", "cost", "evaluations", "seconds")
    rows: list[tuple[Value, ...]] = [
        (
            *(run.scene, run.method, run.run, run.plan.seed, str(run.plan.status), run.plan.length, run.plan.gap),
            *(run.plan.cost if np.isfinite(run.plan.cost) else None, run.plan.evaluations, run.seconds),
        )
        for run in comparison.runs
    ]
    return Table("planners_runs", "Every run", tuple(map(Column, headings)), rows, shown=False)


def figures(comparison: PlannerComparison) -> tuple[Figure, ...]:
    """The paths of all runs, how they converged, and the times."""
    ran = {
        method: {scene: comparison.of(scene, method) for scene in comparison.problems} for method in comparison.methods
    }
    improving = [
        method
        for method, by_scene in ran.items()
        if any(len(_trace(run)) for runs in by_scene.values() for run in runs)
    ]

    def paths(canvas: Any) -> None:
        overlay(
            canvas, comparison.problems, {m: {s: _overlaid(runs) for s, runs in by.items()} for m, by in ran.items()}
        )

    def convergence(canvas: Any) -> None:
        panels = {
            scene: {method: _together(ran[method][scene]) for method in improving} for scene in comparison.problems
        }
        plots.convergence(canvas, panels, "best cost or length so far", 1e-3)

    def duration(canvas: Any) -> None:
        panels = {
            scene: {method: [run.seconds for run in ran[method][scene]] for method in comparison.methods}
            for scene in comparison.problems
        }
        times(canvas, panels, log=True)

    count = len(comparison.problems)
    wide = plots.size(*[1] * count)
    down, across = shape_of(len(comparison.methods), count)
    tall = (PANEL * across, PANEL * down + 0.2)
    caption = "All runs over one another, dotted if they collide or found nothing; dashed: the shortest path."
    drawn = [Figure("planners_paths", caption, paths, tall)]
    if improving:
        caption = "Best cost of metaheuristics, and best length of others, so far: medians thick, runs thin."
        drawn.append(Figure("planners_convergence", caption, convergence, wide))
    return (*drawn, Figure("planners_times", "Processor time of every run.", duration, wide))


def _overlaid(runs: Sequence[PlannerRun]) -> Overlaid:
    return Overlaid([run.plan.path.points for run in runs], [run.plan.success for run in runs])


def _trace(run: PlannerRun) -> Array:
    return np.empty((0, 2)) if run.plan.trace is None else run.plan.trace


def _together(runs: Sequence[PlannerRun]) -> list[Array]:
    """The traces of runs at the same evaluations; inf where a run had nothing yet."""
    traces = [trace for run in runs if len(trace := _trace(run))]
    if not traces:
        return []
    at = np.unique(np.concatenate([trace[:, 0] for trace in traces]))
    together = []
    for trace in traces:
        last = np.searchsorted(trace[:, 0], at, side="right") - 1
        together.append(np.column_stack((at, np.where(last < 0, np.inf, trace[last, 1]))))
    return together
