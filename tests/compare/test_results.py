"""Rows arranged for statistics, and what the report makes of them, on rows whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.compare import Suite, Trial
from pin_metaik.compare.folder.manifest import Manifest
from pin_metaik.compare.report.by_case import by_case, convergence
from pin_metaik.compare.report.comparison import sections
from pin_metaik.compare.report.overview import distributions, overview, reading, winners
from pin_metaik.compare.report.parts import Section
from pin_metaik.compare.report.seeds import seeds_against_restarts
from pin_metaik.compare.report.worst import trouble, worst
from pin_metaik.compare.results.results import Results, cost, summarise
from pin_metaik.compare.results.standing import headline, standing
from pin_metaik.compare.trials.trial import CURVE

METHODS = ("dls+restarts", "gwo+dls", "mtde+dls")
MANIFEST = Manifest.from_suite(Suite(("ur5",), ("random", "path"), METHODS, tasks=40, budget=1000))


def row(method: str, task: int, evaluations: int | None, case: str = "random", seed: int = 0) -> Trial:
    """A trial that solved its task with so many evaluations, or did not."""
    solved = evaluations is not None
    return Trial(
        "ur5", case, method, task, seed, 1000, solved, solved, solved, "SOLVED" if solved else "OUT_OF_TOLERANCE",
        evaluations=1000 if evaluations is None else evaluations, seconds=0.002 + 0.001 * task,
    )  # fmt: skip


@pytest.fixture(scope="module")
def results() -> Results:
    """Restarts take ten times the evaluations of gwo, mtde ten times those of restarts; task 7 it misses."""
    trials = []
    for task in range(40):
        base = 10 + task
        trials += [row("dls+restarts", task, 10 * base), row("gwo+dls", task, base)]
        trials += [row("mtde+dls", task, None if task == 7 else 100 * base)]
    manifest = Manifest.from_suite(Suite(("ur5",), ("random",), METHODS, tasks=40, budget=10_000))
    return Results(manifest, [replace(trial, budget=10_000) for trial in trials])


def table(section: Section | None, name: str) -> dict[str, list[object]]:
    """The columns of a table by their headings."""
    assert section is not None
    found = next(table for table in section.tables if table.name == name)
    return {column.heading: [values[i] for values in found.rows] for i, column in enumerate(found.columns)}


def test_a_summary_counts_and_takes_quantiles_of_what_was_solved() -> None:
    trials = [row("gwo+dls", i, evaluations) for i, evaluations in enumerate([10, 20, 30, None, 40])]
    summary = summarise([*trials, replace(trials[0], met=False, solved=False), replace(trials[0], error="E: e")])
    assert (summary.trials, summary.solved, summary.false_claims, summary.errors) == (7, 5, 1, 1)
    assert summary.evaluations is not None and summary.seconds is not None
    assert_allclose(summary.evaluations, np.quantile([10, 20, 30, 40, 10], [0.5, 0.95]))
    assert_allclose(summary.seconds[0], 0.003)


def test_an_unsolved_task_costs_ten_budgets_and_a_free_answer_one_evaluation() -> None:
    assert cost(row("gwo+dls", 0, None)) == 10_000.0
    assert cost(row("gwo+dls", 0, 0)) == 1.0


def test_all_who_rightly_say_no_rank_alike_and_that_says_nothing_of_seeds(results: Results) -> None:
    told = [replace(t, met=False, claimed=False, status="UNREACHABLE") for t in results.trials if t.solved]
    said = Results(results.manifest, told)
    assert_array_equal(said.costs("random"), 1.0)
    assert said.hopeless("random") and not results.hopeless("random")
    assert seeds_against_restarts(said) is None


def test_seeds_are_taken_together_by_the_geometric_mean_and_unfinished_tasks_are_left_out() -> None:
    suite = Suite(("ur5",), ("random",), ("lm", "dls"), tasks=3, seeds=2)
    trials = [row(m, 0, e, seed=s) for m, pair in (("lm", (10, 1000)), ("dls", (20, 20))) for s, e in enumerate(pair)]
    trials += [row("lm", 1, 10), row("dls", 1, 10), row("dls", 1, 10, seed=1), row("dls", 2, 5)]
    assert_allclose(Results(Manifest.from_suite(suite), trials).costs("random"), [[100.0, 20.0]])


def test_methods_that_do_not_report_evaluations_are_not_ranked(results: Results) -> None:
    silent = [replace(t, evaluations=None) if t.method == "mtde+dls" else t for t in results.trials]
    quiet = Results(results.manifest, silent)
    assert quiet.rankable == ["dls+restarts", "gwo+dls"]
    assert "do not report evaluations: mtde+dls" in " ".join(reading(quiet).text)
    assert table(overview(quiet), "overview")["mean rank by evaluations"][-1] is None


def test_the_overview_ranks_and_counts(results: Results) -> None:
    columns = table(overview(results), "overview")
    assert columns["method"] == ["gwo+dls", "dls+restarts", "mtde+dls"]
    assert columns["mean rank by evaluations"] == [1.0, 2.0, 3.0]
    assert columns["solved"] == [1.0, 1.0, 39 / 40]
    assert columns["evaluations, median"][:2] == [29.5, 295.0]
    assert columns["95 % interval"][2] == "87.1–99.6"  # Wilson, 39 of 40
    assert "40 tasks: chi squared = 80" in overview(results).text[1]  # 12 / (n k (k + 1)) sum R^2 - 3 n (k + 1)


def test_who_solves_all_stands_above_who_is_quick_at_most_of_them(results: Results) -> None:
    quick = [row("gwo+dls", task, None if task < 4 else 1) for task in range(40)]
    slow = [row("dls+restarts", task, 900 + task) for task in range(40)]
    found = Results(MANIFEST, [*quick, *slow, *(row("mtde+dls", task, None) for task in range(40))])
    assert [place.method for place in standing(found)] == ["dls+restarts", "gwo+dls", "mtde+dls"]
    assert table(winners(found), "winners")["winner"] == ["dls+restarts"]
    assert headline(found).startswith("`dls+restarts` comes first: it solves 100.0 % of 40 trials, in 920 evaluations")
    assert "`gwo+dls`, the next, solves 90.0 %, and takes 0.0011 times the evaluations" in headline(found)
    assert headline(results).endswith("solves 100.0 %, and takes 10 times the evaluations, task by task.")


def test_a_figure_opens_with_six_lines_and_the_default_is_among_them() -> None:
    names = ("lm", "dls", "lm+restarts", "dls+restarts", "gwo+dls", "mtde+dls", "sfla+dls", "default")
    trials = [row(name, task, None if name == "default" else 10 + i) for i, name in enumerate(names) for task in (0, 1)]
    found = Results(Manifest.from_suite(Suite(("ur5",), ("random",), names, tasks=2)), trials)
    few, every = distributions(found)
    assert few.shown and not every.shown
    canvas = Figure(figsize=few.size)
    few.draw(canvas)
    widths = {line.get_label(): line.get_linewidth() for line in canvas.axes[0].lines}
    assert len(widths) == 6 and "sfla+dls" not in widths
    assert widths.pop("default") > max(widths.values())


def test_seeds_win_where_they_take_fewer_evaluations_and_lose_where_they_take_more(results: Results) -> None:
    section = seeds_against_restarts(results)
    columns = table(section, "seeds")
    assert columns["seeds"] == ["gwo+dls", "mtde+dls"]
    assert columns["better"] == ["seeds", "restarts"]
    assert_allclose(np.array(columns["evaluations, seeds / restarts"], dtype=float), [0.1, 10.0])
    assert (columns["seeds quicker on"], columns["restarts quicker on"]) == ([40, 0], [0, 40])
    assert section is not None and "restarts are better in 1 of 2 comparisons, seeds in 1" in section.text[0]
    assert "Seeds win: gwo+dls (random)." in section.text[0] and "Seeds solve more tasks: nowhere." in section.text[0]


def test_without_a_control_there_is_no_verdict_on_seeds() -> None:
    assert (
        seeds_against_restarts(
            Results(Manifest.from_suite(Suite(("ur5",), ("random",), ("gwo+dls",))), [row("gwo+dls", 0, 5)])
        )
        is None
    )


def test_winner_and_loser_are_named(results: Results) -> None:
    columns = table(winners(results), "winners")
    assert columns["winner"] == ["gwo+dls"] and columns["fewest solved by"] == ["mtde+dls"]
    assert columns["not significantly different from it"] == ["none"]


def test_the_hardest_task_comes_first_with_the_command_to_see_it(results: Results) -> None:
    columns = table(worst(results, "out/x"), "worst")
    assert columns["task"][0] == 7 and columns["solved"][0] == "2 of 3"
    assert columns["see it again"][0] == "`pin-metaik replay out/x ur5/random/7/mtde+dls/0`"


def test_errors_false_claims_and_overspending_are_told(results: Results) -> None:
    assert trouble(results) is None
    bad = [row("gwo+dls", 0, 5), replace(row("gwo+dls", 1, 5), met=False), row("gwo+dls", 2, 1001)]
    bad.append(replace(row("mtde+dls", 3, None), error="ValueError: no"))
    bad.append(replace(row("mtde+dls", 0, None), status="UNREACHABLE"))  # which gwo+dls met
    bad.append(replace(row("mtde+dls", 4, None), status="UNREACHABLE"))  # which nobody met
    columns = table(trouble(Results(MANIFEST, bad)), "trouble")
    assert columns["method"] == ["mtde+dls", "gwo+dls", "mtde+dls", "gwo+dls"]
    assert [str(what).partition(" trials ")[::2] for what in columns["what"]] == [
        ("1", "raised ValueError: no"),
        ("1", "claimed a solution that Pinocchio (or coal) does not confirm"),
        ("1", "said UNREACHABLE of a target that was met"),
        ("1", "spent more than their budget"),
    ]


def test_pairs_of_a_case_are_all_there(results: Results) -> None:
    columns = table(by_case(results, results.cases["random"]), "pairs_random")
    assert len(columns["method a"]) == 3
    assert all(p < 1e-6 for p in np.array(columns["p, adjusted by Holm"], dtype=float))


def test_convergence_takes_the_median_where_all_trials_have_a_cost() -> None:
    suite = Suite(("ur5",), ("random",), ("gwo",))
    flat = [replace(row("gwo", i, None), curve=(None, *[float(i)] * (len(CURVE) - 1))) for i in range(5)]
    assert convergence(Results(Manifest.from_suite(suite), flat)) is not None
    assert convergence(Results(Manifest.from_suite(suite), [row("gwo", 0, None)])) is None


def test_an_unfinished_comparison_is_called_partial_and_reported_on(results: Results) -> None:
    part = Results(MANIFEST, results.trials[:30])
    found = sections(part, "out", [])
    assert any("PARTIAL: 30 of 240 trials" in text for section in found for text in section.text)


def test_a_distribution_counts_unsolved_trials_as_never(results: Results) -> None:
    assert np.isinf(results.spent("random", "mtde+dls")).sum() == 1
    assert_array_equal(np.sort(results.spent("random", "gwo+dls")), 10.0 + np.arange(40))
