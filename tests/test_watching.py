"""One protocol to watch long work and to end it, for everything that takes long."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik import learn, mobile, stewart
from pin_metaik.errors import Cancelled
from pin_metaik.interrupts import Interrupted
from pin_metaik.watching import Progress, Watch
from tests.robots_under_test import chain_of

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (60, 2))
Y = X[:, 0] * X[:, 1]


def small_design(watch: Watch) -> Any:
    return stewart.design(stewart.load_mechanism("stroke_50"), watch=watch)


WORK: dict[str, Callable[[Watch], Any]] = {
    "minimize": lambda watch: mik.minimize(
        lambda Q: (Q**2).sum(axis=1), mik.Box([-1, -1], [1, 1]), "gwo", mik.Budget(evaluations=3000), watch=watch
    ),
    "fit": lambda watch: learn.fit(X, Y, (3,), iterations=200, watch=watch).training,
    "fuzzy_c_means": lambda watch: learn.fuzzy_c_means(X, 3, watch=watch),
    "plan_path": lambda watch: mobile.plan_path(mobile.load_scene("ten_obstacles"), "pso", watch=watch),
    "design": small_design,
}


@pytest.mark.parametrize("name", WORK)
def test_a_watch_hears_how_far_work_is_and_ends_it_with_what_was_found(name: str) -> None:
    heard: list[Progress] = []

    def watch(at: Progress) -> bool:
        heard.append(at)
        return len(heard) == 3

    found = WORK[name](watch)
    assert len(heard) == 3
    assert all(0 < at.done <= at.total for at in heard)
    assert [at.done for at in heard] == sorted(at.done for at in heard)
    assert all(at.best is not None for at in heard)
    interrupted = found.status is mik.optimize.Status.INTERRUPTED if name == "minimize" else found.interrupted
    assert interrupted


@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_in_a_watch_is_still_one(name: str) -> None:
    def press(at: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stop:
        WORK[name](press)
    assert type(stop.value) is Interrupted
    assert stop.value.result is not None


def places(chain: mik.Chain, count: int) -> np.ndarray:
    """Poses (k, 4, 4) along a line in configurations."""
    middle = 0.5 * (chain.box.lower + chain.box.upper) + 0.3
    x = np.linspace(middle - 0.1, middle + 0.1, count)
    return chain.poses(x)[:, 0]


def test_a_watch_ends_a_batch_whose_other_targets_are_stopped() -> None:
    chain = chain_of("panda")
    poses = places(chain, 2000)
    heard: list[float] = []
    whole = mik.solve_ik_batch(chain, poses, workers=2, watch=lambda at: heard.append(at.done))
    assert whole
    assert heard == sorted(heard)
    assert heard[-1] == len(poses)
    part = mik.solve_ik_batch(chain, poses, workers=2, watch=lambda at: True)
    assert 0 < part.success.sum() < len(poses)
    assert all(part.status[~part.success] == mik.IKStatus.STOPPED)
    assert_array_equal(part.q[part.success], whole.q[part.success])
    alone = mik.solve_ik_batch(
        chain, [mik.Target.at(pose[:3, 3]) for pose in poses[:5]], workers=1, watch=lambda at: True
    )
    assert alone.success.tolist() == [True, False, False, False, False]
    assert np.isnan(alone.position_error[1:]).all()
    assert "watch" in alone[1].why


def test_a_watch_ends_a_path_whose_other_poses_are_not_met() -> None:
    chain = chain_of("ur5")
    path = mik.solve_ik_path(chain, places(chain, 10), watch=lambda at: at.done == 4)
    assert path.interrupted
    assert not path
    assert path.success.tolist() == [True] * 4 + [False] * 6
    assert not mik.solve_ik_path(chain, places(chain, 3), watch=lambda at: None).interrupted


def test_a_watch_ends_the_search_for_all_solutions_with_those_so_far() -> None:
    chain = chain_of("panda")
    found = mik.solve_ik_all(chain, places(chain, 1)[0], limit=1000, watch=lambda at: 0 < at.done < at.total)
    assert found.interrupted
    assert found.complete is None
    assert len(found)
    assert all(found.problem.accepts(q) for q in found)


def test_a_watch_ends_a_world_that_is_not_made_yet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path))  # where nothing is known of the robot's links yet
    heard: list[Progress] = []

    def watch(at: Progress) -> bool:
        heard.append(at)
        return len(heard) == 5

    with pytest.raises(Cancelled, match="which links ever touch"):
        mik.CollisionWorld(mik.load_robot("ur5"), watch=watch)
    assert [at.done for at in heard] == [0, 1, 2, 3, 4]
    assert all(at.total > at.done for at in heard)
    heard.clear()
    world = mik.CollisionWorld(mik.load_robot("ur5"), watch=lambda at: heard.append(at))
    assert heard[-1].done == heard[-1].total - 1
    assert world.pairs == mik.CollisionWorld(mik.load_robot("ur5")).pairs
