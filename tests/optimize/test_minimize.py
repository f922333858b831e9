from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from pin_metaik.errors import InvalidBudget, InvalidSetting, UnknownName
from pin_metaik.optimize import Box, Budget, Status, minimize

BOX = Box([-1.0, -1.0], [2.0, 2.0])


def sphere(X):
    return np.square(X).sum(axis=1)


class Fixed:
    """Proposes the given populations, one after the other."""

    def __init__(self, *populations):
        self.populations = populations

    def search(self, run):
        yield from (np.asarray(X) for X in self.populations)


def test_a_user_s_own_object_needs_no_registration():
    result = minimize(sphere, BOX, Fixed([[1.0, 1.0], [0.5, 0.0]], [[0.1, 0.0]]), Budget(100))
    assert result.status is Status.FINISHED
    assert (result.cost, result.evaluations, result.generations) == (pytest.approx(0.01), 3, 2)
    assert result.x.tolist() == [0.1, 0.0]


def test_the_last_batch_is_cut_to_what_the_budget_allows():
    result = minimize(sphere, BOX, Fixed([[1.0, 1.0], [0.5, 0.0], [0.0, 0.0]]), Budget(2))
    assert result.evaluations == 2
    assert result.cost == 0.25  # the third point was not evaluated


def test_a_batch_that_reaches_the_target_counts_whole():
    result = minimize(sphere, BOX, Fixed([[0.0, 0.0], [1.0, 1.0]], [[1.0, 0.0]]), Budget(100, target=0.0))
    assert result.status is Status.TARGET_REACHED
    assert result.evaluations == 2


def test_an_algorithm_that_proposes_nothing_is_told_so():
    class Forgetful:
        def search(self, run):
            return run.start(3)

    with pytest.raises(InvalidSetting, match="Fixed ended without proposing a point"):
        minimize(sphere, BOX, Fixed(), Budget(10))
    with pytest.raises(InvalidSetting, match=r"Forgetful\.search is not a generator"):
        minimize(sphere, BOX, Forgetful(), Budget(10))


def test_an_algorithm_that_leaves_the_box_is_told_so():
    with pytest.raises(InvalidSetting, match=r"Fixed left the box with \[9\. 0\.\]: clip"):
        minimize(sphere, BOX, Fixed([[0.0, 0.0], [9.0, 0.0]]), Budget(10))
    with pytest.raises(InvalidSetting, match="left the box"):
        minimize(sphere, BOX, Fixed([[np.nan, 0.0]]), Budget(10))


@pytest.mark.parametrize("population", [[0.0, 0.0], [[0.0]], np.empty((0, 2)), [[[0.0, 0.0]]]])
def test_a_population_of_the_wrong_shape_is_told_so(population):
    with pytest.raises(InvalidSetting, match=r"expected \(k, 2\), k >= 1"):
        minimize(sphere, BOX, Fixed(population), Budget(10))


@pytest.mark.parametrize("costs", [lambda X: 0.0, lambda X: X, lambda X: np.zeros((len(X), 1)), lambda X: [1.0]])
def test_costs_of_the_wrong_shape_are_told_so(costs):
    with pytest.raises(InvalidSetting, match=r"costs: expected shape \(30,\)"):
        minimize(costs, BOX, "gwo", Budget(100))


def test_nan_counts_as_infinite():
    result = minimize(lambda X: [np.nan, 3.0], BOX, Fixed([[0.0, 0.0], [1.0, 0.0]]), Budget(9))
    assert result.cost == 3
    assert result.x.tolist() == [1, 0]
    nothing = minimize(lambda X: np.full(len(X), np.nan), BOX, "gwo", Budget(99))
    assert nothing.cost == np.inf
    assert BOX.contains(nothing.x)


def test_a_search_that_might_never_end_is_refused():
    with pytest.raises(InvalidBudget, match=r"evaluations=\.\.\. or seconds"):
        minimize(sphere, BOX, "gwo", Budget(target=0.0))


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(UnknownName, match=r"no metaheuristic named 'gow'; did you mean 'gwo'.*pso"):
        minimize(sphere, BOX, "gow", Budget(10))


@pytest.mark.parametrize("seeds", [[[0.0]], [[0.0, np.nan]], [[[0.0, 0.0]]], 0.0])
def test_seeds_that_are_not_points_are_refused(seeds):
    with pytest.raises(InvalidSetting, match="seeds"):
        minimize(sphere, BOX, "gwo", Budget(10), seeds=seeds)


@pytest.mark.parametrize("keep", [0, 1.5])
def test_the_number_of_points_to_keep_is_at_least_one(keep):
    with pytest.raises(InvalidSetting, match="keep"):
        minimize(sphere, BOX, "gwo", Budget(10), keep=keep)


def test_ctrl_c_goes_through_with_the_best_so_far():
    calls = []

    def impatient(X):
        calls.append(X)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return sphere(X)

    with pytest.raises(KeyboardInterrupt) as press:
        minimize(impatient, BOX, "gwo", Budget(1000))
    result = press.value.result
    assert result.status is Status.INTERRUPTED
    assert result.evaluations == 60
    assert result.cost == min(sphere(X).min() for X in calls[:2])


def test_ctrl_c_before_there_is_a_best_goes_through():
    def impatient(X):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        minimize(impatient, BOX, "gwo", Budget(1000))


def test_a_watch_sees_every_generation_and_may_stop():
    seen = []

    def watch(at):
        assert at.total == 1000
        seen.append((at.done, at.best))
        return len(seen) == 4

    result = minimize(sphere, BOX, "gwo", Budget(1000), trace=True, watch=watch)
    assert result.status is Status.INTERRUPTED
    assert np.array_equal(result.trace, seen)
    assert result.trace[-1].tolist() == [120, result.cost]


def test_the_trace_never_rises_and_ends_with_the_result():
    result = minimize(sphere, BOX, "de", Budget(777), trace=True)
    assert (np.diff(result.trace[:, 0]) > 0).all()
    assert (np.diff(result.trace[:, 1]) <= 0).all()
    assert result.trace[-1].tolist() == [777, result.cost]
    assert result.trace.shape == (result.generations, 2)
    assert minimize(sphere, BOX, "de", Budget(10)).trace is None


def test_the_elite_holds_the_best_points_in_order():
    seen = []

    def objective(X):
        seen.append(X)
        return sphere(X)

    result = minimize(objective, BOX, "de", Budget(2000), keep=12)
    X = np.unique(np.concatenate(seen), axis=0)
    assert np.array_equal(result.elite_costs, np.sort(sphere(X))[:12])
    assert np.array_equal(sphere(result.elite), result.elite_costs)
    assert np.array_equal(result.elite[0], result.x)


def test_a_watch_is_handed_the_points_of_every_generation():
    seen = []

    def costs(X):
        f = np.where(X[:, 0] < 0, np.nan, np.square(X).sum(axis=1))
        X[:] = 7.0  # the array an objective gets is its own
        return f

    result = minimize(costs, BOX, "pso", Budget(400), watch=lambda at: seen.append(at.population))
    assert sum(len(generation.X) for generation in seen) == 400
    for X, f in seen:
        assert BOX.contains_all(X)
        assert_array_equal(f, np.where(X[:, 0] < 0, np.inf, np.square(X).sum(axis=1)))
    assert min(f.min() for _, f in seen) == result.cost
    silent = minimize(costs, BOX, "pso", Budget(400))
    assert_array_equal(silent.x, result.x)
