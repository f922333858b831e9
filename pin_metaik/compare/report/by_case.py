"""A section for each case: rates and evaluations of each method, robot by robot, and every pair of methods compared."""

from __future__ import annotations

from collections import Counter
from typing import Any

from pin_metaik.compare.folder.manifest import CaseEntry
from pin_metaik.compare.report import figures
from pin_metaik.compare.report.overview import DEFAULTS, RANKED, in_words, ranked
from pin_metaik.compare.report.parts import Column, Figure, Section, Table, Value
from pin_metaik.compare.results import series
from pin_metaik.compare.results.results import Results, summarise
from pin_metaik.compare.results.standing import standing
from pin_metaik.compare.results.statistics import Pair, friedman
from pin_metaik.compare.trials.trial import CURVE


def by_case(results: Results, case: CaseEntry) -> Section:
    """All there is to know of one case."""
    test = friedman(results.costs(case.name))
    pairs = results.pairs(case.name)
    text: tuple[str, ...] = (
        case.about,
        case.success,
        f"Friedman's test over {test.blocks:,} tasks: chi squared = {test.statistic:.4g}, {in_words(test.p)}.",
    )
    trials = results.rows(case=case.name)
    if trials and all(trial.error is not None for trial in trials):
        ((error, count),) = Counter(trial.error for trial in trials).most_common(1)
        text += (f"No trial came to an end: {count:,} of {len(trials):,} raised {error}",)
    places = standing(results, case=case.name)
    rows: list[tuple[Value, ...]] = []
    for place, whole in zip(places, ranked(places), strict=True):
        of_robots = [results.rows(robot=robot, case=case.name, method=place.method) for robot in results.robots]
        rows.append((*whole, *(summarise(trials).rate for trials in of_robots)))
    columns = (*RANKED, *(Column(f"solved, {robot}", ".1%") for robot in results.robots))
    tables = (Table(f"case_{case.name}", "All robots together; the last columns robot by robot", columns, rows),)
    return Section(f"Case: {case.name}", text, (*tables, *_pairs(case.name, pairs)))


def rates(results: Results) -> tuple[Figure, ...]:
    """Solve rates with their intervals."""
    found = {case: series.rates(results, case) for case in results.cases}

    def draw(canvas: Any) -> None:
        figures.rates(canvas, found)

    width, height = figures.panel_size(len(found))
    height *= max(1.0, len(results.methods) / 12.0)
    caption = "Share of trials solved (dot) with its 95 % Wilson interval (bar), all robots together."
    return (Figure("rates", caption, draw, (width, height)),)


def duels(results: Results) -> tuple[Figure, ...]:
    """Every method against every other."""
    fought = {case: found for case in results.cases if (found := series.duels(results, case)) is not None}
    if not fought:
        return ()

    def draw(canvas: Any) -> None:
        figures.duels(canvas, fought)

    width, height = figures.panel_size(len(fought))
    caption = (
        "How many times the evaluations of the method of a column that of a row takes, in the median over tasks, where "
        "an unsolved task counts ten times its budget: blue is fewer, red is more. In grey: the difference is "
        "not significant (Wilcoxon, Holm, 0.05)."
    )
    return (Figure("duels", caption, draw, (width, height + 1.0)),)


def convergence(results: Results) -> Section | None:
    """Best cost against evaluations, of the methods that keep it; None if none does."""
    curves = {case: found for case in results.cases if (found := series.convergence(results, case))}
    if not curves:
        return None

    def draw(canvas: Any) -> None:
        figures.convergence(
            canvas, curves, CURVE * results.manifest.budget, figures.lines(results.methods, thick=DEFAULTS)
        )

    caption = "Median of the best cost so far over all targets and robots; the middle half of the trials is shaded."
    figure = Figure("convergence", caption, draw, figures.panel_size(len(curves)))
    text = (
        "Metaheuristics alone: the distance in metres plus the angle in radians that is left. A pose counts as met at "
        "1e-5. Compiled descents record no convergence.",
    )
    return Section("Convergence", text, (), (figure,))


def _pairs(case: str, pairs: list[Pair]) -> tuple[Table, ...]:
    rows: list[tuple[Value, ...]] = [
        (p.a, p.b, p.better, p.worse, p.ratio, p.p, p.adjusted) for p in sorted(pairs, key=lambda pair: pair.adjusted)
    ]
    columns = (
        Column("method a"),
        Column("method b"),
        Column("tasks on which a takes fewer evaluations", ","),
        Column("tasks on which b does", ","),
        Column("evaluations a / b, median", ".3g"),
        Column("p", ".2g"),
        Column("p, adjusted by Holm", ".2g"),
    )
    return (
        (Table(f"pairs_{case}", "Every pair: Wilcoxon's signed-rank test", columns, rows, shown=False),) if rows else ()
    )
