"""Every result has a form of plain values, which JSON takes as it is."""

import json
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik import learn, mobile
from pin_metaik.plain import plain
from tests.robots_under_test import chain_of


class Pair(NamedTuple):
    name: str
    depth: float


class Kind(Enum):
    GOOD = "good"


def test_values_become_plain_and_what_json_does_not_have_is_none() -> None:
    given = {"a": np.array([[1.0, np.nan]]), "b": (np.int64(2), np.bool_(True)), "c": Pair("x", np.inf), "d": Kind.GOOD}
    assert plain(given) == {"a": [[1.0, None]], "b": [2, True], "c": {"name": "x", "depth": None}, "d": "good"}
    assert plain(Path("a") / "b") == str(Path("a") / "b")
    assert [type(one) for one in plain((np.float64(1.0), np.int64(1), np.bool_(False), 3))] == [float, int, bool, int]
    with pytest.raises(TypeError, match="no plain value"):
        plain(object())


UR5_POSE = np.array([[0.0, 0.0, 1.0, 0.3], [0.0, 1.0, 0.0, 0.3], [-1.0, 0.0, 0.0, 0.4], [0.0, 0.0, 0.0, 1.0]])
PANDA = np.array([0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3, 0.0])
X = np.random.default_rng(0).random((40, 2))
RESULTS: dict[str, Callable[[], Any]] = {
    "IKResult": lambda: mik.solve_ik(chain_of("ur5"), UR5_POSE),
    "IKResult out of reach": lambda: mik.solve_ik(chain_of("ur5"), [9.0, 0.0, 0.0]),
    "IKBatch": lambda: mik.solve_ik_batch(chain_of("ur5"), [UR5_POSE, [9.0, 0.0, 0.0]]),
    "IKPath": lambda: mik.solve_ik_path(chain_of("ur5"), [UR5_POSE, [9.0, 0.0, 0.0]]),
    "SelfMotions": lambda: mik.self_motions(chain_of("panda"), chain_of("panda").placements(PANDA)[0], resolution=0.4),
    "IKSolutions": lambda: mik.solve_ik_all(chain_of("ur5"), UR5_POSE),
    "Result": lambda: mik.minimize(
        lambda Q: np.square(Q).sum(axis=1), mik.Box([-1.0], [1.0]), "de", mik.Budget(200), trace=True
    ),
    "Training": lambda: learn.fit(X, X[:, 0], (2,), iterations=5).training,
    "Clusters": lambda: learn.fuzzy_c_means(X, 2),
    "PathPlan": lambda: mobile.plan_path(mobile.load_scene("ten_obstacles")),
}


@pytest.mark.parametrize("name", RESULTS)
def test_json_takes_every_result_and_gives_it_back(name: str) -> None:
    values = RESULTS[name]().as_dict()
    assert json.loads(json.dumps(values, allow_nan=False)) == values
    assert "seconds" in values or name == "Clusters"
