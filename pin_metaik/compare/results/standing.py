"""The order of methods: share solved first, evaluations second, and the sentence that says who won and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.results.results import Results, Summary, summarise
from pin_metaik.compare.results.statistics import friedman

LEVEL = 0.01  # share of the trials that a method may solve fewer than the best, and still be ranked by evaluations


@dataclass(frozen=True)
class Place:
    """A method and how it fared.

    Attributes:
        method: Its name.
        rank: Mean rank by evaluations to solution, 1 the best; None if it does not report evaluations.
        summary: Counts and quantiles of its trials.
        level: Whether it solves as many trials as the best, to one in a hundred.
    """

    method: str
    rank: float | None
    summary: Summary
    level: bool


def standing(results: Results, *, robot: str | None = None, case: str | None = None) -> list[Place]:
    """The methods in their order, over all or one of the robots and cases.

    Methods that solve as many trials as the best one, to one in a hundred, come first, in the order of their mean rank
    by evaluations; the others follow by the share that they solve. So a method that is quick at few targets stands
    below one that solves all.
    """
    summaries = {m: summarise(results.rows(robot=robot, case=case, method=m)) for m in results.methods}
    most = max((summary.rate for summary in summaries.values()), default=0.0)
    ranks = dict(zip(results.rankable, friedman(costs(results, robot, case)).ranks.tolist(), strict=True))
    places = [
        Place(method, ranks.get(method), summary, summary.rate >= most - LEVEL) for method, summary in summaries.items()
    ]
    return sorted(places, key=_key)


def costs(results: Results, robot: str | None = None, case: str | None = None) -> Array:
    """Costs (b, k) of the methods that can be ranked; see ``Results.costs``."""
    cases = list(results.cases) if case is None else [case]
    return np.concatenate([results.costs(each, robot) for each in cases])


def headline(results: Results) -> str:
    """One sentence: which method won, and by how much."""
    places = standing(results)
    if not results.trials or not places or not places[0].summary.solved:
        return "No method solved anything."
    first = places[0]
    sentence = f"`{first.method}` comes first: it solves {_percent(first)} of {first.summary.trials:,} trials"
    if first.summary.evaluations is not None:
        sentence += f", in {first.summary.evaluations[0]:,.0f} evaluations in the median"
    if len(places) == 1:
        return sentence + "."
    second = places[1]
    sentence += f"; `{second.method}`, the next, solves {_percent(second)}"
    if first.rank is None or second.rank is None:
        return sentence + "."
    return f"{sentence}, and takes {_ratio(results, second.method, first.method)} evaluations, task by task."


def _ratio(results: Results, method: str, other: str) -> str:
    """How many times the evaluations of another a method takes on the tasks that both solve, in the median."""
    table = costs(results)
    column = results.rankable.index
    a, b = table[:, column(method)], table[:, column(other)]
    budget = max(trial.budget for trial in results.trials)
    both = (a <= budget) & (b <= budget)
    if not both.any():
        return "an unknown number of"
    ratio = float(np.median(a[both] / b[both]))
    return "as many" if round(ratio, 2) == 1.0 else f"{ratio:.2g} times the"


def _percent(place: Place) -> str:
    return f"{100.0 * place.summary.rate:.1f} %"


def _key(place: Place) -> tuple[bool, float, float]:
    rank = np.inf if place.rank is None else place.rank
    return (not place.level, rank, -place.summary.rate) if place.level else (True, -place.summary.rate, rank)


def foremost(places: Sequence[Place], always: Sequence[str], count: int) -> list[str]:
    """Names of the first few methods, with those that are always among them, in their order."""
    names = [place.method for place in places]
    wanted = [name for name in names if name in always]
    rest = [name for name in names if name not in always][: max(0, count - len(wanted))]
    return [name for name in names if name in (*wanted, *rest)]
