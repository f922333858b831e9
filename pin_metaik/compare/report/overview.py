"""The first sections of a comparison's report: a summary, the best and worst methods, and what was compared."""

from __future__ import annotations

from collections.abc import Sequence

from pin_metaik.compare.methods.cost import FK_WITH_JACOBIAN
from pin_metaik.compare.report import figures
from pin_metaik.compare.report.parts import Column, Figure, Section, Table, Value
from pin_metaik.compare.results import series
from pin_metaik.compare.results.results import Results, Summary
from pin_metaik.compare.results.standing import Place, costs, foremost, standing
from pin_metaik.compare.results.statistics import compare_pairs, friedman

SPENT = (
    Column("solved", ".1%", meter=True),
    Column("95 % interval"),
    Column("evaluations, median", ",.0f"),
    Column("evaluations, 95th percentile", ",.0f"),
    Column("CPU ms, median", ".2f"),
    Column("CPU ms, 95th percentile", ".2f"),
)

RANKED = (Column("method"), Column("mean rank by evaluations", ".2f"), *SPENT)
DEFAULTS = {"default", "default_nearest"}
TWO_DEFAULTS = (
    "`default` and `default_nearest` answer different questions: the first is `solve_ik` without settings, which "
    "returns any solution; the second asks for the one nearest to the start. Where only the nearest counts "
    "(`minimal_displacement`), `default_nearest` is the call to make, and `default` shows how often any solution will "
    "do."
)
LINES = 6
"""Methods in a figure of lines that a page opens with."""


def spent(summary: Summary) -> tuple[Value, ...]:
    """Values of the columns ``SPENT``."""
    evaluations = summary.evaluations or (None, None)
    seconds = (None, None) if summary.seconds is None else tuple(1e3 * value for value in summary.seconds)
    return (summary.rate if summary.trials else None, interval(summary), *evaluations, *seconds)


def interval(summary: Summary) -> str:
    """The 95 % interval of a rate, in percent; one word, so that no table breaks it."""
    low, high = summary.interval
    return f"{100.0 * low:.1f}–{100.0 * high:.1f}"


def in_words(p: float) -> str:
    """A p-value; one too small for a float is given as a bound."""
    return f"p = {p:.2g}" if p > 0.0 else "p < 1e-300"


def overview(results: Results) -> Section:
    """How every method fared, over all robots and cases."""
    test = friedman(costs(results))
    places = standing(results)
    table = Table("overview", "All robots and cases together", RANKED, ranked(places))
    text: tuple[str, ...] = (
        "Methods that solve as many trials as the best one, to one in a hundred, are ordered by their rank; the "
        "others follow by the share they solve. The rank is by evaluations to solution on each task, 1 being the best; "
        "methods that did not solve it share the last place. Evaluations are those of the solved trials, processor "
        "time that of all. Where no target can be met, solved means that the method said so, and all that did share "
        "the first place.",
        f"Friedman's test over {test.blocks:,} tasks: chi squared = {test.statistic:.4g}, {in_words(test.p)}.",
    )
    if set(results.methods) >= DEFAULTS:
        text += (TWO_DEFAULTS,)
    return Section("In short", text, (table,), distributions(results))


def ranked(places: Sequence[Place]) -> list[tuple[Value, ...]]:
    """Rows of the columns ``RANKED``."""
    return [(place.method, place.rank, *spent(place.summary)) for place in places]


def distributions(results: Results, name: str = "ecdf") -> tuple[Figure, ...]:
    """Share of tasks solved against evaluations, a panel a case."""
    if not results.trials or not results.rankable:
        return ()
    at = series.evaluations_of(results)
    shares = {case: series.distributions(results, case, at) for case in results.cases}
    looks, size = figures.lines(results.methods, thick=DEFAULTS), figures.panel_size(len(shares))
    few = [m for m in foremost(standing(results), sorted(DEFAULTS), LINES) if m in results.rankable]
    some = {case: {method: of_case[method] for method in few} for case, of_case in shares.items()}
    caption = (
        "Share of trials solved within so many kernel evaluations: higher and farther left is better. Colour says "
        "where starts come from, the style of the line what follows."
    )
    opened = Figure(name, caption, lambda canvas: figures.distributions(canvas, some, at, looks), size)
    if len(few) == len(results.rankable):
        return (opened,)
    every = Figure(
        f"{name}_all",
        f"The same for all {len(results.rankable)} methods.",
        lambda canvas: figures.distributions(canvas, shares, at, looks),
        size,
        shown=False,
    )
    return opened, every


def winners(results: Results) -> Section:
    """The best and the worst methods, by case and robot."""
    rows: list[tuple[Value, ...]] = []
    for case in results.cases:
        for robot in results.robots:
            table, names = results.costs(case, robot), results.rankable
            if not len(table):
                continue
            places = standing(results, robot=robot, case=case)
            first = next(place for place in places if place.rank is not None)
            best = names.index(first.method)
            others = [i for i in range(len(names)) if i != best]
            pairs = compare_pairs([(names[i], names[best], table[:, i], table[:, best]) for i in others])
            equals = ", ".join(pair.a for pair in pairs if not pair.significant) or "none"
            rates = {place.method: place.summary.rate for place in places}
            least = min(rates.values())
            losers = ", ".join(method for method, rate in rates.items() if rate == least) if least < 1.0 else None
            rows.append((case, robot, first.method, first.summary.rate, equals, losers, least))
    columns = (
        Column("case"),
        Column("robot"),
        Column("winner"),
        Column("share the winner solves", ".1%"),
        Column("not significantly different from it"),
        Column("fewest solved by"),
        Column("share these solve", ".1%"),
    )
    text = (
        "The winner has the best mean rank by evaluations, of the methods that solve as many trials as the best one, "
        "to one in a hundred. Not significantly different from it: methods with p >= 0.05 in Wilcoxon's signed-rank "
        "test of the evaluations, by Holm for all methods at once.",
    )
    return Section("Winners and losers", text, (Table("winners", "By case and robot", columns, rows),))


def reading(results: Results) -> Section:
    """The methods, cases and budgets compared, and the meaning of the terms."""
    manifest = results.manifest
    sizes = (
        f"{len(results.methods)} methods on {len(results.cases)} cases and {len(results.robots)} robots "
        f"({', '.join(results.robots)}), {manifest.tasks} tasks each, "
        f"{manifest.seeds} {'seed' if manifest.seeds == 1 else 'seeds'}: {len(results.trials):,} trials."
    )
    text: tuple[str, ...] = (
        sizes,
        f"Every trial may spend {manifest.budget:,} kernel evaluations on a target: forward kinematics count 1, "
        f"forward kinematics with a Jacobian {FK_WITH_JACOBIAN:g}, as measured. Trials over budget count as unsolved. "
        "All methods get the same targets and, in the same repetition, the same start.",
        "`lm` is Levenberg-Marquardt (Chan) from the given start alone, `lm+restarts` goes on from random ones; `dls` "
        "is the compiled damped least squares with limits inside the step, `qp` a quadratic program a step. `gwo` is a "
        "metaheuristic alone, `gwo+dls` lets it find starts (a quarter of what is left of the budget, then its eight "
        "best points are refined, and again). `default` is `solve_ik` without settings.",
    )
    unranked = [method for method in results.methods if method not in results.rankable]
    if unranked:
        text += (f"Not ranked, because they do not report evaluations: {', '.join(unranked)}.",)
    text += tuple(f"Not compared: {pair}: {reason}." for pair, reason in manifest.absent.items())
    if len(results.trials) < manifest.trials:
        text += (f"PARTIAL: {len(results.trials):,} of {manifest.trials:,} trials are done.",)
    columns = (Column("case"), Column("targets"), Column("counts as solved"))
    rows: list[tuple[Value, ...]] = [(case.name, case.about, case.success) for case in results.cases.values()]
    return Section("What was compared", text, (Table("cases", "Cases", columns, rows),))
