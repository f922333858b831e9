import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting
from pin_metaik.learn import Network

NETWORKS = [Network(2, (5,)), Network(2, (5, 5)), Network(3, (4, 2, 3)), Network(1, (1,)), Network(2, ())]


@pytest.fixture(params=NETWORKS, ids=str)
def case(request):
    rng = np.random.default_rng(0)
    network = request.param
    return network, rng.normal(size=network.count), rng.uniform(-1, 1, (40, network.inputs)), rng.normal(size=40)


def test_the_number_of_weights_is_that_of_the_paper():
    assert [Network(2, (5,)).count, Network(2, (5, 5)).count] == [21, 51]
    assert str(Network(2, (5, 5))) == "2:5:5:1"


def test_the_jacobian_is_that_of_finite_differences(case):
    network, w, X, _ = case
    step = 1e-6  # central differences are then right to about 1e-9
    numeric = [
        (network.outputs(w + step * e, X) - network.outputs(w - step * e, X)) / (2 * step) for e in np.eye(len(w))
    ]
    assert_allclose(network.jacobian(w, X), np.array(numeric).T, atol=1e-7)


def test_the_gradient_is_the_jacobians(case):
    network, w, X, y = case
    mse, gradient = network.gradient(w, X, y)
    error = network.outputs(w, X) - y
    assert mse == pytest.approx(np.mean(error**2))
    assert_allclose(gradient, 2 / len(y) * network.jacobian(w, X).T @ error, atol=1e-12)


def test_first_weights_are_reproducible_and_spread_the_neurons(case):
    network, *_ = case
    assert np.array_equal(network.initial(1), network.initial(1))
    assert network.initial(1).shape == (network.count,)
    X = np.random.default_rng(1).uniform(-1, 1, (200, network.inputs))
    assert np.isfinite(network.outputs(network.initial(1), X)).all()


def test_layers_without_neurons_are_refused():
    for inputs, hidden in ((0, (5,)), (2, (5, 0))):
        with pytest.raises(InvalidSetting):
            Network(inputs, hidden)
