"""What the figures of a comparison show, as numbers: of one case, of all robots together or of one."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.compare.results.results import Results, summarise
from pin_metaik.compare.results.statistics import ecdf
from pin_metaik.compare.trials.trial import CURVE

FEWEST, POINTS = 4.0, 240  # evaluations at which distributions begin, and how many points they have


@dataclass(frozen=True, eq=False)
class Duels:
    """Every method that can be ranked against every other.

    Attributes:
        methods: Names of the k methods.
        ratios: (k, k) log10 of how many times the evaluations of the column's method the row's takes, in the median
            over tasks, where an unsolved task counts ten times its budget.
        certain: (k, k) whether the difference is significant (Wilcoxon, Holm, 0.05).
    """

    methods: tuple[str, ...]
    ratios: Array
    certain: NDArray[np.bool_]

    def among(self, methods: Container[str]) -> Duels | None:
        """The same of some of the methods; None if there are no two of them."""
        rows = [i for i, name in enumerate(self.methods) if name in methods]
        if len(rows) < 2:
            return None
        part = np.ix_(rows, rows)
        return Duels(tuple(self.methods[i] for i in rows), self.ratios[part], self.certain[part])


def evaluations_of(results: Results) -> Array:
    """Evaluations (m,) at which distributions are drawn, up to the largest budget."""
    return np.geomspace(FEWEST, max((trial.budget for trial in results.trials), default=10.0 * FEWEST), POINTS)


def distributions(results: Results, case: str, at: Array, robot: str | None = None) -> dict[str, Array]:
    """Share of trials solved within so many evaluations ``at`` (m,), by method that can be ranked."""
    return {method: ecdf(results.spent(case, method, robot), at) for method in results.rankable}


def rates(results: Results, case: str, robot: str | None = None) -> dict[str, tuple[float, float, float]]:
    """Share of trials solved, and both ends of its 95 % interval, by method."""
    found = {method: summarise(results.rows(robot=robot, case=case, method=method)) for method in results.methods}
    return {method: (summary.rate, *summary.interval) for method, summary in found.items()}


def duels(results: Results, case: str, robot: str | None = None) -> Duels | None:
    """Every method against every other; None where there are no two, or no task that all tried."""
    names, costs = results.rankable, results.costs(case, robot)
    if len(names) < 2 or not len(costs):
        return None
    logs = np.log10(costs)
    certain = np.eye(len(names), dtype=bool)
    for pair in results.pairs(case, robot):
        i, j = names.index(pair.a), names.index(pair.b)
        certain[i, j] = certain[j, i] = pair.significant
    return Duels(tuple(names), np.median(logs[:, :, None] - logs[:, None, :], axis=0), certain)


def convergence(results: Results, case: str, robot: str | None = None) -> dict[str, Array]:
    """Quartiles (3, m) of the best cost so far at ``CURVE`` of the budget, by method that keeps it."""
    curves: dict[str, Array] = {}
    for method in results.methods:
        rows = results.rows(robot=robot, case=case, method=method)
        kept = [trial.curve for trial in rows if trial.curve is not None]
        if kept:
            table = np.array(kept, dtype=float)  # (trials, m), NaN before the first generation
            known = ~np.isnan(table).any(axis=0)
            quartiles = np.full((3, len(CURVE)), np.nan)
            quartiles[:, known] = np.quantile(table[:, known], [0.25, 0.5, 0.75], axis=0)
            curves[method] = quartiles
    return curves
