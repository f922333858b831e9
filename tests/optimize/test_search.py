from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize import ALGORITHMS, Box, Budget, Metaheuristic, Search

BOX = Box([0.0, 0.0], [1.0, 1.0])


def search(budget: Budget, seeds=None) -> Search:
    return Search(BOX, np.random.default_rng(0), np.empty((0, 2)) if seeds is None else seeds, budget)


def test_progress_is_the_share_of_evaluations_spent():
    run = search(Budget(200, seconds=1e-9))
    assert run.progress == 0
    run.evaluations = 50
    assert run.progress == 0.25
    assert run.remaining == 150


def test_progress_is_the_share_of_time_when_evaluations_are_not_limited():
    run = search(Budget(seconds=1e-9))
    assert run.remaining is None
    assert run.progress == 1  # long past, and never beyond 1


def test_without_a_budget_there_is_no_progress():
    run = search(Budget())
    run.evaluations = 10**6
    assert run.progress == 0


@pytest.mark.parametrize("count", [1, 2, 3, 10])
def test_a_start_takes_the_seeds_first(count):
    seeds = np.array([[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])
    X = search(Budget(1), seeds).start(count)
    assert X.shape == (count, 2)
    assert np.array_equal(X[:3], seeds[:count])
    assert BOX.contains(X).all()


def test_any_object_with_a_search_method_is_a_metaheuristic():
    class Mine:
        def search(self, run):
            while True:
                yield run.start(3)

    assert isinstance(Mine(), Metaheuristic)
    assert not isinstance(object(), Metaheuristic)
    assert all(isinstance(algorithm(), Metaheuristic) for algorithm in ALGORITHMS.values())
