"""The question behind the comparison: do metaheuristic seeds beat restarts of the same refiner at equal evaluations?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pin_metaik.compare.report.parts import Column, Section, Table, Value
from pin_metaik.compare.results.results import Results, summarise
from pin_metaik.compare.results.statistics import Pair, compare_pairs

RESTARTS = "restarts"


def seeds_against_restarts(results: Results) -> Section | None:
    """Each hybrid against its refiner with restarts, case by case; None when there is no such pair.

    Cases in which no target can be met are left out: there it is the proof that counts, and not the starts.
    """
    hybrids = [(m, f"{m.partition('+')[2]}+{RESTARTS}") for m in results.rankable if "+" in m]
    hybrids = [(hybrid, control) for hybrid, control in hybrids if hybrid != control and control in results.rankable]
    where, tests = [], []
    for case in [case for case in results.cases if not results.hopeless(case)]:
        costs = results.costs(case)
        for hybrid, control in hybrids if len(costs) else []:
            column = results.rankable.index
            tests.append((hybrid, control, costs[:, column(hybrid)], costs[:, column(control)]))
            where.append(case)
    if not tests:
        return None
    pairs = compare_pairs(tests)
    rows: list[tuple[Value, ...]] = []
    for case, pair in zip(where, pairs, strict=True):
        rates = [summarise(results.rows(case=case, method=method)).rate for method in (pair.a, pair.b)]
        rows.append((case, pair.a, *rates, pair.better, pair.worse, pair.ratio, pair.adjusted, verdict(pair)))
    columns = (
        Column("case"),
        Column("seeds"),
        Column("seeds solved", ".1%"),
        Column("restarts solved", ".1%"),
        Column("seeds quicker on"),
        Column("restarts quicker on"),
        Column("evaluations, seeds / restarts", ",.1f"),
        Column("p, Holm", ".2g"),
        Column("better"),
    )
    title = "The same refiner, from seeds and from random restarts, on the same tasks"
    return Section(
        "Do seeds beat restarts?",
        (sentence(where, pairs, rows),
         "The ratio is the median over tasks; an unsolved one counts ten times its budget. p is of Wilcoxon's "
         "signed-rank test of the logarithms of the ratios, by Holm for all rows of this table."),
        (Table("seeds", title, columns, rows),),
    )  # fmt: skip


def verdict(pair: Pair) -> str:
    """The better of seeds and restarts, if the difference is significant."""
    if not pair.significant:
        return "-"
    return "seeds" if pair.better > pair.worse else RESTARTS


def sentence(where: Sequence[str], pairs: Sequence[Pair], rows: Sequence[tuple[Value, ...]]) -> str:
    """The table in words."""
    verdicts = [verdict(pair) for pair in pairs]
    seeds = [f"{pair.a} ({case})" for case, pair, who in zip(where, pairs, verdicts, strict=True) if who == "seeds"]
    ratios = [pair.ratio for pair, who in zip(pairs, verdicts, strict=True) if who == RESTARTS]
    gains = [(pair.a, case, _gain(row)) for case, pair, row in zip(where, pairs, rows, strict=True)]
    solved_more = [f"{method} ({case}, by {gain:.1f} points)" for method, case, gain in gains if gain > 0.0]
    parts = [
        f"At equal evaluations restarts are better in {len(ratios)} of {len(pairs)} comparisons, seeds in "
        f"{len(seeds)}, and in {verdicts.count('-')} the difference is not significant."
    ]
    if ratios:
        parts.append(f"Where restarts win, seeds take {np.median(ratios):.3g} times the evaluations in the median.")
    if seeds:
        parts.append(f"Seeds win: {', '.join(seeds)}.")
    parts.append(f"Seeds solve more tasks: {', '.join(solved_more) or 'nowhere'}.")
    return " ".join(parts)


def _gain(row: tuple[Value, ...]) -> float:
    """How much more seeds solved than restarts, in percentage points."""
    seeds, restarts = row[2], row[3]
    return 100.0 * (seeds - restarts) if isinstance(seeds, float) and isinstance(restarts, float) else 0.0
