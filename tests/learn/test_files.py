"""Trained networks on disk: the same numbers come back, and nothing is run from a file."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from pin_metaik import learn, mobile
from pin_metaik.errors import CannotWrite, InvalidSetting

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (80, 2))


@pytest.fixture(scope="module")
def regressor() -> learn.Regressor:
    return learn.fit(X, X[:, 0] * X[:, 1], (4, 3), "scg", 60)


def test_a_saved_network_gives_the_same_numbers_to_the_last_bit(regressor: learn.Regressor, tmp_path: Path) -> None:
    learn.save_regressor(regressor, tmp_path / "net.npz")
    again = learn.load_regressor(tmp_path / "net.npz")
    assert_array_equal(again(X), regressor(X))
    assert again.network == regressor.network
    assert again.training.iterations == regressor.training.iterations
    assert_array_equal(again.training.trace, regressor.training.trace)
    with pytest.warns(learn.OutsideTraining):
        again([[2.0, 0.0]])


def test_a_saved_turn_has_its_robot_design_and_range(tmp_path: Path) -> None:
    turn = mobile.learn_turn(mobile.NOMAD_200_DRIVER, hidden=(5,), iterations=30)
    turn.save(tmp_path / "turn.npz")
    again = mobile.load_turn(tmp_path / "turn.npz")
    assert (again.vehicle, again.design, again.angles, again.speeds) == (
        turn.vehicle,
        turn.design,
        turn.angles,
        turn.speeds,
    )
    assert_array_equal(again.tangent([0.1, 0.3], [0.5, 1.0]), turn.tangent([0.1, 0.3], [0.5, 1.0]))
    path = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]]
    plans = [mobile.plan_trajectory(path, turn.vehicle, method="ann", model=model) for model in (turn, again)]
    assert plans[0].time == plans[1].time


def test_files_that_are_no_networks_are_named(regressor: learn.Regressor, tmp_path: Path) -> None:
    file = tmp_path / "net.npz"
    with pytest.raises(InvalidSetting, match="cannot read"):
        learn.load_regressor(file)
    for content in (b"", b"PK", pickle.dumps({"w": 1}), b"\x93NUMPY"):
        file.write_bytes(content)
        with pytest.raises(InvalidSetting, match="not a saved network"):
            learn.load_regressor(file)
    np.savez(file, weights=np.zeros(3))
    with pytest.raises(InvalidSetting, match="it has no version, layers"):
        learn.load_regressor(file)
    learn.save_regressor(regressor, file)
    with pytest.raises(InvalidSetting, match="not a saved turn: it has no robot"):
        mobile.load_turn(file)
    with np.load(file) as opened:
        arrays = dict(opened)
    for spoilt, says in (
        ({"weights": np.full(31, np.nan)}, "finite"),
        ({"weights": np.zeros(5)}, "shape"),
        ({"layers": np.array([2, 4, 3, 2])}, "2 outputs"),
        ({"version": np.array(9)}, "version 9"),
        ({"inputs": np.array([["a", "b"], ["c", "d"]])}, "could not convert"),
    ):
        np.savez(file, **{**arrays, **spoilt})
        with pytest.raises(InvalidSetting, match=says):
            learn.load_regressor(file)


def test_an_object_in_a_file_is_never_run(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, ...]:
            return (Path.touch, (tmp_path / "sprung",))

    np.savez(tmp_path / "trap.npz", version=np.array([Trap()], dtype=object))
    with pytest.raises(InvalidSetting, match="not a saved network"):
        learn.load_regressor(tmp_path / "trap.npz")
    assert not (tmp_path / "sprung").exists()


def test_networks_are_written_as_npz_where_that_can_be(regressor: learn.Regressor, tmp_path: Path) -> None:
    with pytest.raises(InvalidSetting, match=r"written as \.npz"):
        learn.save_regressor(regressor, tmp_path / "net.pkl")
    with pytest.raises(CannotWrite, match="no folder"):
        learn.save_regressor(regressor, tmp_path / "none" / "net.npz")
