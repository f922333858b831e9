import numpy as np
from numpy.testing import assert_allclose

from pin_metaik.compare.papers import Options
from pin_metaik.compare.papers.puma_offset import EXAMPLES, PRINTED_THETA, O, cases, printed_answer, sections
from pin_metaik.ik import IKProblem, Target


def test_the_printed_angles_of_example_b_give_the_printed_tip_to_their_two_decimals():
    tip = EXAMPLES["Example B"].chain().poses(PRINTED_THETA)[0, 0, :3, 3]
    assert_allclose(tip, (4.956, 5.030, 10.000), atol=1e-3)


def test_the_objective_is_the_penalty_times_the_squared_distance():
    problem = IKProblem.of(EXAMPLES["Example B"].chain(), Target.at((5, 5, 10)))
    tip = np.array((4.956, 5.030, 10.000))
    assert_allclose(O(problem, 1000, np.array([PRINTED_THETA])), 1000 * np.sum((tip - (5, 5, 10)) ** 2), rtol=0.02)


def test_the_printed_objective_is_between_what_its_tip_and_its_angles_can_mean():
    values = [row[-1] for row in printed_answer().rows]
    assert_allclose(values, (0.5, 2.87), atol=0.01)


def test_example_a_is_the_catalogues_robot():
    a, b = cases().values()
    assert a.name == "Example A"
    assert_allclose(a.objective(np.zeros((1, 6)))[0], 10 * np.sum((np.array((30, 15, 30)) - (10, 5, 60)) ** 2))
    assert a.problem.chain.model.name == b.problem.chain.model.name == "puma_offset"


def test_what_was_not_run_is_a_dash_and_not_an_error():
    for section in sections([], Options(1)):
        for table in section.tables:
            assert all(len(row) == len(table.columns) for row in table.rows)
        assert not section.figures
