from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize import AskTell, Box
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.pick import below, others

BOX = Box([0.0] * 5, [1.0] * 5)
STRATEGIES = ["rand/1/bin", "best/1/bin", "current-to-best/1/bin"]


@pytest.mark.parametrize("count", [4, 5, 6, 50])
def test_the_others_differ_from_i_and_from_each_other_and_all_are_as_likely(count):
    rng = np.random.default_rng(0)
    rounds = 4000
    seen = np.zeros((3, count))
    for _ in range(rounds):
        r1, r2, r3 = others(rng, count) % count
        i = np.arange(count)
        for one, other in ((r1, i), (r2, i), (r3, i), (r1, r2), (r1, r3), (r2, r3)):
            assert (one != other).all()
        seen += [r1 == 0, r2 == 0, r3 == 0]
    expected = rounds / (count - 1)
    np.testing.assert_allclose(seen[:, 1:], expected, atol=5 * np.sqrt(expected))
    assert not seen[:, 0].any()


def test_below_reaches_every_number_and_no_other():
    drawn = below(np.random.default_rng(0), 7, 7000)
    assert (np.bincount(drawn) > 850).all()
    assert drawn.max() == 6


def first_trials(algorithm, costs):
    search = AskTell(BOX, algorithm, rng=3)
    X = search.ask()
    search.tell(costs)
    return X, search.ask()


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_without_crossover_exactly_one_coordinate_is_new(strategy):
    X, U = first_trials(DE(20, CR=0.0, strategy=strategy), np.arange(20.0))
    changed = (U != X).sum(axis=1)
    assert (changed[1:] == 1).all()
    assert changed[0] <= 1  # towards the best, the best itself may stay


def test_mutants_are_made_as_the_strategy_says():
    """With F = 0 no difference is left, and only the base vector shows."""
    X, U = first_trials(DE(8, F=0.0, CR=1.0, strategy="rand/1/bin"), np.arange(8.0))
    assert all((u == X).all(axis=1).any() for u in U)
    assert (U != X).any(axis=1).all()  # but never its own
    X, U = first_trials(DE(8, F=0.0, CR=1.0, strategy="best/1/bin"), np.arange(8.0))
    assert np.array_equal(U, np.tile(X[0], (8, 1)))
    X, U = first_trials(DE(8, F=0.0, CR=1.0, strategy="current-to-best/1/bin"), np.arange(8.0))
    assert np.array_equal(U, X)


def test_a_rand_1_mutant_is_a_base_and_a_difference_of_three_others():
    box = Box([-1e6], [1e6])  # wide: nothing leaves it
    search = AskTell(box, DE(6, F=0.5, CR=1.0), seeds=np.random.default_rng(0).random((6, 1)))
    x = search.ask().ravel()
    search.tell(x)
    for i, u in enumerate(search.ask().ravel()):
        rest = np.delete(x, i)
        combinations = rest[:, None, None] + 0.5 * (rest[:, None] - rest)
        assert np.isclose(combinations, u).any()


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_trial_replaces_its_own_parent_only_and_only_if_it_is_no_worse(strategy):
    search = AskTell(BOX, DE(6, CR=0.0, strategy=strategy))  # a trial has one coordinate that is not its parent's
    X = search.ask()
    search.tell(np.full(6, 5.0))
    U = search.ask()
    search.tell([4.0, 6.0, 5.0, 6.0, 6.0, 4.0])
    parents = np.where(np.array([1, 0, 1, 0, 0, 1])[:, None], U, X)
    assert ((search.ask() == parents).sum(axis=1) >= BOX.dimension - 1).all()
