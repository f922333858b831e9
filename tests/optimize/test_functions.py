from __future__ import annotations

import numpy as np
import pytest

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.optimize.functions import FUNCTIONS, shifted


@pytest.mark.parametrize("dimension", [1, 2, 6, 10])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_optimum_costs_nothing_and_everything_else_more(name, dimension):
    f = shifted(name, dimension)
    X = np.concatenate((f.box.sample(np.random.default_rng(0), 500), f.optimum + 1e-3 * np.eye(dimension)))
    np.testing.assert_allclose(f(f.optimum[None]), 0, atol=1e-14)  # Ackley sums exponentials of order e
    assert (f(X) > 1e-9).all()
    assert f(X).shape == (500 + dimension,)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_optimum_is_inside_the_box_and_not_at_the_origin(name):
    f = shifted(name, 6)
    assert f.box.contains(f.optimum)
    assert (np.abs(f.optimum) > 0.01 * f.box.width).all()


@pytest.mark.parametrize("shift", [1.5, [1.5, -0.5]])
def test_the_optimum_goes_where_one_says(shift):
    f = shifted("rastrigin", 2, shift)
    assert np.array_equal(f.optimum, np.broadcast_to(shift, 2))


def test_known_values():
    assert shifted("rosenbrock", 2, 0.0)(np.array([[-1.0, -1.0]])) == 1  # y = 0
    assert shifted("rastrigin", 1, 0.0)(np.array([[3.0]])) == pytest.approx(9)
    assert shifted("sphere", 2, 1.0)(np.array([[4.0, 5.0]])) == 25


def test_what_cannot_be_built_is_refused():
    with pytest.raises(UnknownName, match="did you mean 'sphere'"):
        shifted("spher", 2)
    with pytest.raises(InvalidSetting, match="outside its box"):
        shifted("rastrigin", 2, 9.0)
    with pytest.raises(InvalidSetting, match="dimension"):
        shifted("rastrigin", 0)
