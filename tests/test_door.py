"""Every public door takes what it is given, or says in one family of errors what it would have taken."""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import example_robot_data as erd
import numpy as np
import pinocchio as pin
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik import mobile, stewart
from pin_metaik.errors import MissingExtra, installing

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
EVERY = 11  # of the listed calls, in tests; all of them, and more, in the benchmark


@pytest.fixture
def sweep(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The benchmark's sweep, which is no package."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    return importlib.import_module("door")


def test_every_public_callable_has_a_good_call_with_all_its_arguments(sweep: ModuleType) -> None:
    doors = sweep.doors()
    assert len(doors) > 250
    assert set(doors) == set(sweep.CALLS)
    with sweep.elsewhere():
        for name, door in doors.items():
            assert sweep.parameters(door) <= set(sweep.CALLS[name]()), name
        sweep.warm_up()


def test_odd_arguments_one_at_a_time_lead_to_a_result_or_an_error_of_ours(sweep: ModuleType) -> None:
    with sweep.elsewhere():
        todo = list(sweep.listed(EVERY))
        faults = [fault for door, odd in todo if (fault := sweep.knock(door, odd).fault)]
    assert len(todo) > 2000
    assert not faults, "\n".join(map(str, faults))


def test_drawn_arguments_several_at_a_time_lead_to_a_result_or_an_error_of_ours(sweep: ModuleType) -> None:
    faults = []

    @settings(max_examples=300, deadline=None, database=None, derandomize=True, suppress_health_check=[*HealthCheck])
    @given(st.data())
    def knocks(data: st.DataObject) -> None:
        door, odd = sweep.draw(data)
        faults.extend(filter(None, [sweep.knock(door, odd).fault]))

    with sweep.elsewhere():
        knocks()
    assert not faults, "\n".join(map(str, faults))


PANDA_POSE = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([0.4, 0.0, 0.4]))
BUDGET = mik.Budget(evaluations=10)
NONSENSE: dict[str, Callable[[mik.Robot, mik.Chain], Any]] = {
    r"model is a robot, e.g. mik.load_robot\('panda'\)": lambda robot, chain: mik.Chain("panda", "panda_hand_tcp"),
    "frame: expected a text": lambda robot, chain: mik.Chain(robot.model, robot.model.getFrameId("panda_hand")),
    "at least one frame": lambda robot, chain: mik.Chain(robot.model, []),
    r"chain: expected a Chain \(e.g. mik.Chain\(": lambda robot, chain: mik.solve_ik(robot.model, PANDA_POSE),
    r"solver: expected an IKSolver \(e.g. mik.IKSolver\(": lambda robot, chain: mik.solve_ik(
        chain, PANDA_POSE, solver="gwo"
    ),
    r"budget: expected a Budget \(e.g. mik.Budget\(": lambda robot, chain: mik.IKSolver(budget=1000),
    "select: expected": lambda robot, chain: mik.IKSolver(select=3),
    r"obstacles: .* each entry an Obstacle": lambda robot, chain: mik.CollisionWorld(robot, [{"box": 1}]),
    r"budget: expected a Budget": lambda robot, chain: mik.minimize(np.sum, mik.Box([0], [1]), "mtde", 2000),
    r"box: expected a Box \(e.g. mik.Box\(lower, upper\), the box of a search": lambda robot, chain: mik.minimize(
        np.sum, ([-5] * 2, [5] * 2), "mtde", BUDGET
    ),
    r"locked: .*write \['panda_joint3'\]": lambda robot, chain: mik.Chain(
        robot.model, "panda_hand_tcp", locked="panda_joint3"
    ),
    "an orientation: expected": lambda robot, chain: mik.Target.facing(pin.Quaternion.Identity()),
    "a target is a pin.SE3": lambda robot, chain: mik.solve_ik_path(chain, pin.SE3.Identity()),
    "max_step: expected shape": lambda robot, chain: mik.solve_ik_path(chain, [[0.3, 0.3, 0.4]], max_step=[0.1] * 3),
    "name: expected a text": lambda robot, chain: mik.load_robot(None),
    "world: expected a CollisionWorld": lambda robot, chain: mik.solve_ik(chain, PANDA_POSE, world=robot),
    "workers": lambda robot, chain: mik.solve_ik_batch(chain, [PANDA_POSE], workers=-1),
    "rng is a seed of at least 0": lambda robot, chain: mik.solve_ik(chain, PANDA_POSE, rng="today"),
}


@pytest.fixture(scope="module")
def panda() -> tuple[mik.Robot, mik.Chain]:
    robot = mik.load_robot("panda")
    return robot, mik.Chain(robot, "panda_hand_tcp")


@pytest.mark.parametrize("says", NONSENSE)
def test_what_a_newcomer_writes_by_mistake_is_told_by_name(says: str, panda: tuple[mik.Robot, mik.Chain]) -> None:
    with pytest.raises(mik.MetaIKError, match=says):
        NONSENSE[says](*panda)


def test_a_robot_and_a_robot_wrapper_are_as_good_as_their_model() -> None:
    wrapper = erd.load("ur5")
    robot = mik.load_robot("ur5")
    pose = pin.SE3(np.eye(3), np.array([0.3, 0.3, 0.4]))
    for one in (robot, robot.model, wrapper, wrapper.model):
        assert mik.solve_ik(mik.Chain(one, "tool0"), pose)
    world = mik.CollisionWorld(wrapper)
    assert world.names == mik.CollisionWorld(robot).names
    assert mik.solve_ik(mik.Chain(wrapper, "tool0"), pose, world=world)


def test_a_result_is_true_when_it_is_a_success() -> None:
    chain = mik.Chain(mik.load_robot("ur5"), "tool0")
    assert mik.solve_ik(chain, [0.3, 0.3, 0.4])
    assert not mik.solve_ik(chain, [3.0, 0.3, 0.4])
    for near, far in (([0.3, 0.3, 0.4], [0.3, 0.3, 0.41]), ([0.3, 0.3, 0.4], [3.0, 0.3, 0.4])):
        assert bool(mik.solve_ik_batch(chain, [near, far])) is (far[0] < 1.0)
        assert bool(mik.solve_ik_path(chain, [near, far])) is (far[0] < 1.0)
    assert not mik.solve_ik_path(chain, [[0.3, 0.3, 0.4], [-0.3, -0.3, 0.4]], max_step=0.01)
    assert mobile.plan_path(mobile.load_scene("ten_obstacles"))
    found = stewart.Designed(stewart.load_mechanism("stroke_50"), None, None)  # type: ignore[arg-type]
    assert not found


class Distribution:
    """A package as installers record it."""

    def __init__(self, record: dict[str, Any] | None) -> None:
        self.record = record

    def read_text(self, name: str) -> str | None:
        assert name == "direct_url.json"
        return None if self.record is None else json.dumps(self.record)


@pytest.mark.parametrize(
    ("record", "command"),
    [
        (None, "pip install 'pin-metaik[mobile]'"),
        ({"url": "file:///home/me/my%20clone", "dir_info": {}}, "pip install '.[mobile]' in /home/me/my clone"),
        (
            {"url": "file:///home/me/clone", "dir_info": {"editable": True}},
            "pip install --editable '.[mobile]' in /home/me/clone",
        ),
        (
            {"url": "https://host/us.git", "vcs_info": {"vcs": "git", "commit_id": "1"}},
            "pip install 'pin-metaik[mobile] @ git+https://host/us.git'",
        ),
        (
            {"url": "file:///tmp/a.whl", "archive_info": {}},
            "pip install 'pin-metaik[mobile] @ file:///tmp/a.whl'",
        ),
    ],
)
def test_a_missing_extra_names_the_command_that_installs_it(
    record: dict[str, Any] | None, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pin_metaik.errors.distribution", lambda name: Distribution(record))
    assert installing("mobile") == command
    assert command in str(MissingExtra("planning", "mobile"))


def test_reading_arguments_changes_no_answer() -> None:
    chain = mik.Chain(mik.load_robot("ur5"), "tool0")
    x = np.array([0.1, -1.0, 1.2, 0.3, 0.5, 0.2])
    assert_allclose(chain.q(x.tolist()), chain.q(x), atol=0)
    assert_allclose(chain.poses([x.tolist()]), chain.poses(x), atol=0)
    assert chain.inside(x).shape == (6,)
