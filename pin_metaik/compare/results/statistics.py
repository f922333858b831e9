"""The statistics of a comparison: intervals of rates, distributions of what was spent, and rank tests of methods.

``scipy.stats`` is imported late: it takes a third of a second.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arrays import Array

CONFIDENCE, SIGNIFICANT = 0.95, 0.05
EXACT = 50  # differences, up to which p-values are exact: a quarter of a millisecond each


def wilson(successes: int, trials: int) -> tuple[float, float]:
    """The 95 % interval of a rate (Wilson 1927): sound for few trials, and for rates of 0 and 1 too."""
    if trials == 0:
        return 0.0, 1.0
    from scipy import stats

    interval = stats.binomtest(successes, trials).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def ecdf(spent: ArrayLike, at: ArrayLike) -> Array:
    """The share of trials that were solved within ``at`` (m,) evaluations; unsolved trials have spent ``inf``."""
    sorted_spent = np.sort(np.asarray(spent, dtype=float))
    share: Array = np.searchsorted(sorted_spent, np.asarray(at, dtype=float), side="right") / max(1, len(sorted_spent))
    return share


@dataclass(frozen=True, eq=False)
class Friedman:
    """Friedman's (1937) test of whether any of several methods differs from the others.

    Attributes:
        statistic: Chi squared, with ties corrected for.
        p: Its p-value, with methods - 1 degrees of freedom.
        ranks: (k,) mean rank of each method, 1 the best.
        blocks: Tasks.
    """

    statistic: float
    p: float
    ranks: Array
    blocks: int


def friedman(costs: ArrayLike) -> Friedman:
    """Friedman's test of costs (b, k) of k methods on b tasks; small costs are good.

    With less than three methods, or no differences at all, nothing can be shown: p is 1.
    """
    from scipy import stats

    table = np.asarray(costs, dtype=float)
    b, k = table.shape
    ranks = stats.rankdata(table, axis=1) if b else np.full((1, k), (k + 1) / 2.0)
    mean = ranks.mean(axis=0)
    if k < 3 or b < 2 or (ranks == ranks[:, :1]).all():
        return Friedman(0.0, 1.0, mean, b)
    statistic, p = stats.friedmanchisquare(*ranks.T)
    return Friedman(float(statistic), float(p), mean, b)


def holm(p: ArrayLike) -> Array:
    """P-values (m,) adjusted for m tests at once (Holm 1979): reject where they are below the level."""
    given = np.asarray(p, dtype=float)
    order = np.argsort(given, kind="stable")
    steps = given[order] * np.arange(len(given), 0, -1)
    adjusted = np.empty(len(given))
    adjusted[order] = np.minimum(np.maximum.accumulate(steps), 1.0)
    return adjusted


@dataclass(frozen=True)
class Pair:
    """Two methods on the same tasks.

    Attributes:
        a: One method ...
        b: ... and the other.
        better: Tasks on which a costs less.
        worse: Tasks on which it costs more.
        ratio: Median of cost of a over cost of b.
        p: Two-sided p-value of Wilcoxon's (1945) signed-rank test of the logarithms of these ratios.
        adjusted: The same, adjusted by Holm for all pairs that were tested together.
    """

    a: str
    b: str
    better: int
    worse: int
    ratio: float
    p: float
    adjusted: float

    @property
    def significant(self) -> bool:
        """Whether they differ at the level of 0.05, all tests considered."""
        return self.adjusted < SIGNIFICANT


def signed_rank(difference: ArrayLike) -> float:
    """Two-sided p-value of Wilcoxon's signed-rank test; tasks without a difference are left out, as he did.

    Exact for up to 50 differences, ties or not: the sums of ranks that all 2^n choices of signs give are counted. For
    more, the normal approximation, with its variance corrected for ties.
    """
    from scipy import stats

    d = np.asarray(difference, dtype=float)
    d = d[d != 0.0]
    n = len(d)
    if n == 0:
        return 1.0
    ranks = stats.rankdata(np.abs(d))
    above = float(ranks[d > 0.0].sum())
    if n > EXACT:
        _, ties = np.unique(ranks, return_counts=True)
        variance = n * (n + 1) * (2 * n + 1) / 24.0 - float((ties**3 - ties).sum()) / 48.0
        return math.erfc(abs(above - n * (n + 1) / 4.0) / math.sqrt(2.0 * variance))
    doubled = np.round(2.0 * ranks).astype(np.int64)  # ranks of ties are halves
    share = np.zeros(int(doubled.sum()) + 1)  # of the choices of signs, by twice their sum of ranks
    share[0] = 1.0
    for rank in doubled:
        share[rank:] += share[:-rank].copy()
        share /= 2.0
    at = round(2.0 * above)
    return float(min(1.0, 2.0 * min(share[: at + 1].sum(), share[at:].sum())))


def compare_pairs(pairs: Sequence[tuple[str, str, ArrayLike, ArrayLike]]) -> list[Pair]:
    """Test pairs (a, b, costs of a (b,), costs of b (b,)), costs above 0, with Holm's correction for all of them."""
    tested = []
    for a, b, of_a, of_b in pairs:
        d = np.log10(np.asarray(of_a, dtype=float)) - np.log10(np.asarray(of_b, dtype=float))
        tested.append((a, b, int((d < 0).sum()), int((d > 0).sum()), float(10.0 ** np.median(d)), signed_rank(d)))
    adjusted = holm([p for *_, p in tested])
    return [Pair(*test, float(q)) for test, q in zip(tested, adjusted, strict=True)]


def compare_all(names: Sequence[str], costs: ArrayLike) -> list[Pair]:
    """Test every pair of k methods by their costs (b, k)."""
    table = np.asarray(costs, dtype=float)
    if not len(table):
        return []
    columns = itertools.combinations(range(len(names)), 2)
    return compare_pairs([(names[i], names[j], table[:, i], table[:, j]) for i, j in columns])
