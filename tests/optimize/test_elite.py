from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.optimize.elite import Elite


@pytest.mark.parametrize("size", [1, 2, 7, 40, 1000])
def test_the_elite_is_the_best_of_all_points_seen(size):
    rng = np.random.default_rng(0)
    elite, X, costs = Elite(size, 3), rng.random((600, 3)), rng.random(600)
    for rows in np.split(np.arange(600), [1, 4, 300, 310]):
        elite.add(X[rows], costs[rows])
    order = costs.argsort()[:size]
    assert np.array_equal(elite.costs, costs[order])
    assert np.array_equal(elite.X, X[order])


def test_a_point_seen_twice_counts_once():
    elite = Elite(3, 1)
    elite.add(np.array([[1.0], [2.0], [1.0]]), np.array([5.0, 5.0, 5.0]))
    elite.add(np.array([[2.0], [3.0]]), np.array([5.0, 6.0]))
    assert elite.X.ravel().tolist() == [1, 2, 3]


def test_it_keeps_copies():
    elite, X = Elite(1, 1), np.array([[1.0]])
    elite.add(X, np.array([0.0]))
    X[:] = 9
    assert elite.X[0, 0] == 1


def test_without_a_finite_cost_it_still_has_a_point():
    elite = Elite(1, 1)
    elite.add(np.array([[1.0], [2.0]]), np.array([np.inf, np.inf]))
    assert elite.X.shape == (1, 1)
