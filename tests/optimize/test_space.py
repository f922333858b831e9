from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.errors import InvalidBounds
from pin_metaik.optimize import Box


@pytest.mark.parametrize(
    ("lower", "upper", "named"),
    [
        ([0.0, 2.0], [1.0, 1.0], "crossed at index 1"),
        ([0.0, np.nan], [1.0, 1.0], "index 1 is nan"),
        ([0.0], [np.inf], "upper bound at index 0 is inf"),
        ([0.0, 0.0], [1.0], "lower has 2 bounds and upper has 1"),
        ([], [], "at least one"),
        ([[0.0]], [[1.0]], r"shape \(1, 1\)"),
        (0.0, 1.0, r"shape \(\)"),
        (["a"], ["b"], "must be numbers"),
        ([-1.7e308], [1.7e308], "index 0 are so far apart"),
    ],
)
def test_bounds_that_make_no_box_are_named(lower, upper, named):
    with pytest.raises(InvalidBounds, match=named):
        Box(lower, upper)


def test_a_box_cannot_be_changed_neither_by_itself_nor_through_the_arrays_it_was_made_of():
    lower = np.zeros(2)
    box = Box(lower, np.ones(2))
    lower[:] = 5
    assert np.array_equal(box.lower, [0, 0])
    with pytest.raises(ValueError, match="read-only"):
        box.upper[0] = 3


def test_samples_are_uniform_in_the_box():
    box = Box([-1.0, 5.0, 2.0], [1.0, 9.0, 2.0])
    X = box.sample(np.random.default_rng(0), 4000)
    assert X.shape == (4000, 3)
    assert box.contains(X).all()
    np.testing.assert_allclose(X.mean(axis=0), [0, 7, 2], atol=0.08)  # 4 standard errors of the widest
    np.testing.assert_allclose(X.std(axis=0), box.width / np.sqrt(12), atol=0.08)


def test_clip_finds_the_nearest_point_whatever_the_number_of_rows():
    box = Box([0.0, -1.0], [1.0, 1.0])
    rng = np.random.default_rng(0)
    for count in (1, 5, 3, 400, 2):
        X = rng.normal(size=(count, 2)) * 3
        assert np.array_equal(box.clip(X), np.clip(X, box.lower, box.upper))
    assert np.array_equal(box.clip(np.array([2.0, 0.5])), [1.0, 0.5])


def test_contains_answers_for_every_point_and_nan_is_nowhere():
    box = Box([0.0, 0.0], [1.0, 1.0])
    X = np.array([[0.0, 1.0], [0.5, 1.1], [np.nan, 0.5]])
    assert box.contains(X).tolist() == [True, False, False]
    assert box.contains(X[0])
    assert not box.contains_all(X)
    assert box.contains_all(X[:1])


def test_halfway_brings_back_only_what_left():
    box = Box([0.0, 0.0], [1.0, 1.0])
    origin = np.array([[0.4, 0.8]])
    assert np.array_equal(box.halfway(np.array([[-3.0, 0.9]]), origin), [[0.2, 0.9]])
    assert np.array_equal(box.halfway(np.array([[0.1, 7.0]]), origin), [[0.1, 0.9]])
