import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.compare.papers import Options, Paper, reproduce
from pin_metaik.compare.papers.arm import TRACE_POINTS, ArmCase, hybrid, search, thinned, trials_of
from pin_metaik.compare.papers.arm_report import angles, every_run, hybrids, summary
from pin_metaik.compare.papers.rv7fl_setup import cases
from pin_metaik.interrupts import kept
from pin_metaik.optimize.gwo import GWO


@pytest.fixture(scope="module")
def case():
    return cases()[1]


def rng():
    return np.random.default_rng(0)


def test_a_search_spends_its_budget_and_reports_the_papers_objective(case):
    trial = search(case, "GWO", GWO(agents=30), 600, 0, rng()).work()
    assert trial.evaluations == trial.budget == 600
    assert_allclose(case.objective(trial.x[None])[0], trial.cost)
    assert trial.trace[-1].tolist() == [600, trial.cost]


def test_a_hybrid_ends_when_it_is_solved(case):
    trial = hybrid(case, "GWO", GWO(agents=30), 5000, 0, rng()).work()
    assert trial.method == "GWO + DLS"
    assert trial.cost < 1e-4  # mm, the tolerance
    assert trial.evaluations < 5000


def test_ctrl_c_within_a_search_ends_the_experiment_and_not_only_the_search(case):
    calls = []

    def impatient(X):
        calls.append(len(X))
        if len(calls) == 30:
            raise KeyboardInterrupt
        return case.objective(X)

    interrupted = ArmCase(case.name, case.problem, impatient)
    jobs = [search(interrupted, "GWO", GWO(agents=30), 600, run, rng()) for run in range(5)]
    paper = Paper("p", "t", "s", 1, lambda options: jobs, lambda done, options: [done])
    again = kept(lambda: reproduce(paper, Options(5)))
    assert again.done == 1  # the first of 20 generations; the second was cut short and does not count
    assert len(calls) == 30


def test_a_trace_is_thinned_to_points_on_a_logarithmic_axis_and_keeps_its_ends():
    full = np.column_stack((np.arange(300, 300_001, 300), np.linspace(10, 1, 1000)))
    thin = thinned(full)
    assert len(thin) <= TRACE_POINTS
    assert thin[0].tolist() == [300, 10] and thin[-1].tolist() == [300_000, 1]
    assert (np.diff(thin[:, 1]) <= 0).all()


def test_trials_are_chosen_by_what_is_named_the_best_first(case):
    trials = [search(case, "GWO", GWO(agents=30), budget, 0, rng()).work() for budget in (60, 600)]
    assert [trial.budget for trial in trials_of(trials, case=case.name)] == [600, 60]
    assert trials_of(trials, budget=60) == [trials[0]]
    assert trials_of(trials, method="MTDE") == []


def test_nothing_run_is_summarised_as_nothing():
    assert summary([]) == (None, None, None, 0)


def test_tables_have_a_value_for_every_column(case):
    trials = [make(case, "GWO", GWO(agents=30), 300, 0, rng()).work() for make in (search, hybrid)]
    for table in (
        angles("a", "Best", trials, "deg", "F"),
        every_run("e", trials, "F"),
        hybrids("h", trials, "F"),
    ):
        assert table.rows
        assert all(len(row) == len(table.columns) for row in table.rows)
