import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.compare.papers import Options
from pin_metaik.compare.papers.arm import ArmTrial
from pin_metaik.compare.papers.rv7fl import jobs, record, sections, verdict, wolves_need
from pin_metaik.compare.papers.rv7fl_setup import EQUAL, LONG, METHODS, PRINTED, SHORT, TARGETS, Printed, cases


def trial(case, method, budget, cost, seconds):
    return ArmTrial(case, method, budget, 0, cost, np.zeros(6), budget, seconds, np.array([[budget, cost]]))


def test_at_zero_the_tip_is_on_case_3():
    objectives = [case.objective(np.zeros((1, 6)))[0] for case in cases()]
    assert_allclose(objectives[2], 0.0, atol=1e-12)  # mm: rounding of metres
    assert min(objectives[:2]) > 1.0


def test_case_1_lies_on_the_inner_wall_of_the_tube_and_is_solved_by_a_folded_arm():
    folded = np.array([[0.0, 0.0, np.pi / 2, 0.3, -0.2, 1.0]])
    assert_allclose(cases()[0].objective(folded), 0.0, atol=1e-12)


def test_the_tip_depends_on_the_first_three_joints_only():
    case, rng = cases()[1], np.random.default_rng(0)
    X = np.repeat(case.problem.box.sample(rng, 1), 20, axis=0)
    X[:, 3:] = case.problem.box.sample(rng, 20)[:, 3:]
    assert np.ptp(case.objective(X)) < 1e-9  # mm


def test_data_every_result_is_printed_at_the_budgets_of_the_paper():
    assert set(PRINTED) == {(case, m, budget[m]) for case in TARGETS for m in METHODS for budget in (SHORT, LONG)}


def test_data_the_printed_times_are_one_time_an_evaluation_only_if_iterations_are_not_the_same_for_all():
    each = [PRINTED[case, m, LONG[m]].seconds / LONG[m] for case in TARGETS for m in METHODS]
    assert 20e-6 < min(each) < max(each) < 31e-6  # s


@pytest.mark.parametrize(
    ("options", "budgets"),
    [
        (Options(1, quick=True), {1000, 30_000, 300_000}),
        (Options(1), {1000, 30_000, 300_000, 600_000}),
        (Options(1, long=True), {1000, 30_000, 300_000, 600_000, 180_000_000}),
    ],
)
def test_the_options_choose_the_budgets(options, budgets):
    assert {job.size for job in jobs(options)} == budgets


def test_the_short_jobs_come_first():
    sizes = [job.size for job in jobs(Options(2, long=True))]
    assert sizes.index(600_000) > max(i for i, size in enumerate(sizes) if size == 300_000)
    assert sizes.index(180_000_000) > max(i for i, size in enumerate(sizes) if size == 600_000)


def test_the_record_counts_cases_and_takes_rounding_for_equal():
    outcomes = {
        ("Case 1", "MTDE"): Printed(1.0, 2.0),
        ("Case 1", "GWO"): Printed(2.0, 1.0),
        ("Case 2", "MTDE"): Printed(0.0, 2.0),
        ("Case 2", "GWO"): Printed(1e-13, 1.0),
        ("Case 3", "GWO"): Printed(0.0, 1.0),
    }
    assert record("MTDE", outcomes) == "better on 1, equal on 1, worse on 0 of 2 cases in 2.0 times the time"


def test_the_verdict_follows_the_measured_times():
    trials = [trial("Case 1", "GWO", 300_000, 1.0, 0.3), trial("Case 1", "MTDE", 300_000, 1.0, 0.6)]
    assert "2.00 us in MTDE and 1.00 us in GWO: MTDE is the slower one" in verdict(trials)


def test_the_long_budget_is_estimated_from_the_short_one():
    trials = [trial("Case 1", method, EQUAL[method], 1.0, 0.3) for method in ("GWO", "improved GWO")]
    assert "60 runs would take 3.0 hours: --long runs them" in wolves_need(trials, Options(10))


def test_what_was_not_run_is_a_dash_and_not_an_error():
    for section in sections([], Options(1)):
        for table in section.tables:
            assert all(len(row) == len(table.columns) for row in table.rows)
        assert not section.figures
