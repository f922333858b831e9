from __future__ import annotations

import math

import numpy as np
import pytest

from pin_metaik.optimize import AskTell, Box, Budget, minimize
from pin_metaik.optimize.functions import shifted
from pin_metaik.optimize.gwo import GWO
from pin_metaik.optimize.igwo import IGWO

from .rv7fl import BOX, miss


def test_a_falls_from_two_to_zero_in_a_line():
    assert [GWO().a(t) for t in (0, 0.25, 0.5, 1)] == [2, 1.5, 1, 0]


def test_improved_a_falls_exponentially_the_faster_the_more_wolves():
    assert IGWO(300).a(0) == 2
    assert IGWO(300).a(0.01) == pytest.approx(2 * math.exp(-3))
    assert IGWO(30).a(0.01) == pytest.approx(2 * math.exp(-0.3))


@pytest.mark.parametrize("algorithm", [GWO(5), IGWO(5)])
def test_a_step_is_what_the_paper_s_equations_say_wolf_by_wolf(algorithm):
    box = Box([-10.0, -10.0], [10.0, 10.0])
    search = AskTell(box, algorithm, rng=1, budget=Budget(50))
    rng = np.random.default_rng(1)
    rng.random((5, 2))  # the initial population
    X = search.ask()
    costs = np.array([4.0, 0.0, 3.0, 1.0, 2.0])
    search.tell(costs)
    alpha, beta, delta = X[1], X[3], X[4]
    r1, r2 = rng.random((2, 3, 5, 2))
    a = algorithm.a(5 / 50)
    expected = np.empty((5, 2))
    for i in range(5):
        moved = []
        for k, leader in enumerate((alpha, beta, delta)):
            A, C = 2 * a * r1[k, i] - a, 2 * r2[k, i]
            moved.append(leader - A * np.abs(C * leader - X[i]))
        expected[i] = np.clip(np.mean(moved, axis=0), -10, 10)
    np.testing.assert_allclose(search.ask(), expected, atol=1e-13)  # sums in another order


def test_the_leaders_are_the_best_three_ever_not_those_of_the_generation():
    """With a = 0 every wolf goes to the mean of the leaders, so the leaders can be read off."""

    class Settled(GWO):
        def a(self, progress):
            return 0.0

    search = AskTell(Box([0.0], [100.0]), Settled(4), seeds=[[3.0], [6.0], [9.0], [90.0]])
    assert search.ask().ravel().tolist() == [3, 6, 9, 90]
    search.tell([1.0, 2.0, 3.0, 4.0])
    assert search.ask().ravel().tolist() == [6, 6, 6, 6]  # mean of 3, 6, 9
    search.tell([5.0, 5.0, 5.0, 2.5])  # one of the new wolves is third
    np.testing.assert_allclose(search.ask().ravel(), 5)  # mean of 3, 6, 6
    search.tell([9.0, 9.0, 9.0, 9.0])
    np.testing.assert_allclose(search.ask().ravel(), 5)


def test_it_drifts_to_the_origin_which_is_why_test_functions_are_shifted():
    """On the 30-D sphere, 15,000 evaluations, Mirjalili prints 7e-28 (ours 2e-31; shifted by 1: 3)."""
    at_origin, elsewhere = (
        np.median([minimize(f, f.box, "gwo", Budget(15_000), rng=seed).cost for seed in range(3)])
        for f in (shifted("sphere", 30, 0.0), shifted("sphere", 30, 1.0))
    )
    assert at_origin < 1e-20
    assert elsewhere > 0.1


def test_it_reaches_the_paper_s_targets_to_a_tenth_of_a_millimetre():
    """With the paper's 300 agents x 1000 iterations, best of 2 where the paper takes the best of 10."""
    for case in (1, 2, 3):
        assert min(minimize(miss(case), BOX, GWO(300), Budget(300_000), rng=seed).cost for seed in range(2)) < 0.1


def test_the_improved_one_is_worse_on_most_cases():
    """In the paper's short runs it is on all three: 0.021, 0.028, 0.11 mm to 0.0005, 0.01, 0. Here with a tenth."""
    worse = 0
    for case in (1, 2, 3):
        gwo, igwo = (
            np.median([minimize(miss(case), BOX, algorithm, Budget(30_000), rng=seed).cost for seed in range(3)])
            for algorithm in (GWO(300), IGWO(300))
        )
        worse += igwo > gwo
    assert worse >= 2
