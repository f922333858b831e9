"""Every statistic on data whose answer is printed somewhere, or can be counted on one's fingers."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import stats

from pin_metaik.compare.results.statistics import compare_all, compare_pairs, ecdf, friedman, holm, signed_rank, wilson

# Hollander and Wolfe (1973), pp. 140 ff.: times of 22 players with three ways of rounding first base.
ROUNDING_TIMES = np.array(
    [5.40, 5.50, 5.55, 5.85, 5.70, 5.75, 5.20, 5.60, 5.50, 5.55, 5.50, 5.40, 5.90, 5.85, 5.70, 5.45, 5.55, 5.60, 5.40,
     5.40, 5.35, 5.45, 5.50, 5.35, 5.25, 5.15, 5.00, 5.85, 5.80, 5.70, 5.25, 5.20, 5.10, 5.65, 5.55, 5.45, 5.60, 5.35,
     5.45, 5.05, 5.00, 4.95, 5.50, 5.50, 5.40, 5.45, 5.55, 5.50, 5.55, 5.55, 5.35, 5.45, 5.50, 5.55, 5.50, 5.45, 5.25,
     5.65, 5.60, 5.40, 5.70, 5.65, 5.55, 6.30, 6.30, 6.25]
).reshape(22, 3)  # fmt: skip
# The same, pp. 29 f.: depression of nine patients before and after a tranquillizer.
BEFORE = np.array([1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30])
AFTER = np.array([0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29])


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilson_intervals_are_those_that_newcombe_prints(
    successes: int, trials: int, low: float, high: float
) -> None:  # Newcombe 1998, Statistics in Medicine 17, Table I, method 3
    assert_allclose(wilson(successes, trials), (low, high), atol=5e-5)  # four digits are printed


def test_nothing_is_known_of_a_rate_without_trials() -> None:
    assert wilson(0, 0) == (0.0, 1.0)


def test_a_distribution_counts_what_was_done_by_then_and_never_what_was_not() -> None:
    assert_array_equal(ecdf([3.0, 1.0, np.inf, 3.0], [0.5, 1.0, 2.9, 3.0, 1e9]), [0.0, 0.25, 0.25, 0.75, 0.75])


def test_friedman_is_that_of_hollander_and_wolfe() -> None:
    test = friedman(ROUNDING_TIMES)
    assert_allclose(test.statistic, 11.143, atol=5e-4)
    assert_allclose(test.p, 0.003805, atol=5e-7)
    assert test.blocks == 22
    assert_allclose(test.ranks.sum(), 6.0)
    assert test.ranks.argmin() == 2


def test_friedman_sees_nothing_where_there_is_nothing_to_see() -> None:
    assert friedman(np.ones((5, 4))).p == 1.0
    assert friedman([[1.0, 2.0], [1.0, 2.0]]).p == 1.0
    assert_allclose(friedman(np.empty((0, 3))).ranks, 2.0)


def test_unsolved_tasks_share_the_last_rank() -> None:
    assert_array_equal(
        friedman([[1.0, np.inf, np.inf], [2.0, np.inf, np.inf], [1.0, np.inf, np.inf]]).ranks, [1, 2.5, 2.5]
    )


def test_the_signed_rank_test_is_that_of_hollander_and_wolfe() -> None:
    assert_allclose(signed_rank(BEFORE - AFTER), 0.0390625)  # twice the one-sided 0.01953 that they print


def test_no_difference_is_no_evidence() -> None:
    assert signed_rank(np.zeros(9)) == 1.0


def test_holm_steps_down() -> None:
    assert_allclose(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02])
    assert_array_equal(holm([0.9, 0.8]), [1.0, 1.0])


def test_pairs_count_who_is_cheaper_and_by_how_much() -> None:
    a, b = np.array([10.0, 10.0, 10.0, 10.0, 40.0, 10.0]), np.array([20.0, 20.0, 20.0, 10.0, 20.0, 20.0])
    (pair,) = compare_pairs([("a", "b", a, b)])
    assert (pair.better, pair.worse) == (4, 1)
    assert_allclose(pair.ratio, 0.5)
    assert pair.adjusted == pair.p


def test_all_pairs_are_adjusted_together() -> None:
    costs = np.column_stack([np.arange(1.0, 21.0), 2.0 * np.arange(1.0, 21.0), 3.0 * np.arange(1.0, 21.0)])
    pairs = compare_all(["a", "b", "c"], costs)
    assert [(pair.a, pair.b) for pair in pairs] == [("a", "b"), ("a", "c"), ("b", "c")]
    assert_allclose([pair.ratio for pair in pairs], [1 / 2, 1 / 3, 2 / 3])
    assert all(pair.significant and pair.worse == 0 for pair in pairs)
    assert_allclose([pair.adjusted for pair in pairs], holm([pair.p for pair in pairs]))


@pytest.mark.parametrize("digits", [0, 3])
def test_small_signed_rank_tests_count_every_choice_of_signs_also_with_ties(digits: int) -> None:
    rng = np.random.default_rng(0)
    for n in range(1, 11):
        d = rng.normal(0.5, 2.0, n).round(digits)
        d = d[d != 0.0]
        ranks = stats.rankdata(np.abs(d))
        sums = np.array([ranks @ signs for signs in itertools.product((0, 1), repeat=len(d))])
        tails = (sums <= ranks[d > 0].sum()).mean(), (sums >= ranks[d > 0].sum()).mean()
        assert_allclose(signed_rank(d), min(1.0, 2.0 * min(tails)), atol=1e-12)


def test_large_signed_rank_tests_are_those_of_scipy() -> None:
    rng = np.random.default_rng(0)
    d = rng.normal(0.2, 1.0, 50)
    assert_allclose(signed_rank(d), stats.wilcoxon(d, method="exact").pvalue, rtol=1e-9)
    for digits in (1, 8):
        d = rng.normal(0.2, 1.0, 300).round(digits)
        assert_allclose(signed_rank(d), stats.wilcoxon(d[d != 0.0], method="approx").pvalue, rtol=1e-9)
