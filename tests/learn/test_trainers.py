import numpy as np
import pytest

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.learn import TRAINERS, OutsideTraining, fit, train
from pin_metaik.learn.network import Network
from pin_metaik.mobile import NOMAD_200
from pin_metaik.mobile.motion.turn import lead_time
from pin_metaik.mobile.motion.turn_data import coarse_grid


def wave(count=200):
    X = np.random.default_rng(0).uniform(-2, 3, (count, 2))
    return X, 10 + np.sin(X[:, 0]) * X[:, 1]


@pytest.mark.parametrize("trainer", TRAINERS)
def test_every_trainer_learns_and_repeats_itself(trainer):
    X, y = wave()
    one, same = (fit(X, y, (8,), trainer, 300, rng=1) for _ in range(2))
    assert np.array_equal(one.w, same.w)
    assert one.training.mse < 0.1 * one.training.trace[0]
    assert one.training.mse == pytest.approx(one.training.trace.min())
    assert one.training.iterations <= 300
    scaled = np.mean((one.predict(X) - y) ** 2) / one.output.half[0] ** 2
    assert scaled == pytest.approx(one.training.mse, rel=1e-9)


@pytest.mark.parametrize("trainer", TRAINERS)
def test_ctrl_c_goes_through_with_the_best_weights_so_far(trainer):
    X, y = wave()

    def stop(at):
        if at.done == 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as press:
        fit(X, y, (5,), trainer, 500, watch=stop)
    model = press.value.result
    assert model.training.interrupted
    assert model.training.iterations == 20
    assert np.isfinite(model.predict(X)).all()


@pytest.mark.parametrize("trainer", ["lm", "minpack", "bfgs", "scg"])
def test_what_a_network_can_do_exactly_is_learned_to_the_end(trainer):
    X = np.random.default_rng(1).uniform(-1, 1, (100, 2))
    model = fit(X, 3 + X @ [2.0, -1.0], (), trainer, 300)
    assert model.training.mse < 1e-20
    assert model.training.converged or model.training.iterations == 300


@pytest.mark.parametrize("seed", range(3))
def test_levenberg_marquardt_beats_rprop_tenfold_on_the_turn(seed):
    v, theta = coarse_grid(NOMAD_200).T
    X, y = np.column_stack((v, theta)), v * lead_time(theta, NOMAD_200)
    lm, rprop = (fit(X, y, (5, 5), trainer, 200, seed).training for trainer in ("lm", "rprop"))
    assert lm.mse * 10 <= rprop.mse


def test_a_network_asked_outside_its_training_range_warns_and_stays_finite():
    X, y = wave()
    model = fit(X, y, (5,), "lm", 50)
    with pytest.warns(OutsideTraining, match="1 of 2 inputs lie outside the training range"):
        assert np.isfinite(model([[0, 0], [1e6, 0]])).all()
    assert list(model.covers(np.array([[0, 0], [1e6, 0]]))) == [True, False]
    for wrong in ([[0, np.nan]], [[0, 0, 0]], [0, 0]):
        with pytest.raises(InvalidSetting):
            model(wrong)


def test_a_column_that_never_changes_does_no_harm():
    X = np.column_stack((np.linspace(0, 1, 50), np.full(50, 7.0)))
    model = fit(X, X[:, 0] ** 2, (3,), "lm", 100)
    assert model.training.mse < 1e-5
    assert np.isfinite(model.predict(X)).all()


def test_nonsense_is_refused_by_name():
    X, y = wave()
    with pytest.raises(UnknownName, match="known: bfgs, lm, minpack, rprop, scg"):
        fit(X, y, (5,), "adam")
    with pytest.raises(InvalidSetting, match="too few for the 21 weights of 2:5:1"):
        fit(X[:20], y[:20], (5,))
    with pytest.raises(InvalidSetting, match="must match"):
        fit(X, y[:10], (5,))
    network = Network(2, (5,))
    with pytest.raises(InvalidSetting, match="iterations"):
        train("lm", network, X, y, network.initial(0), 0)
