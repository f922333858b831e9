"""Paths: no joint jumps silently."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidSetting, InvalidTarget
from tests.robots_under_test import chain_of

DOWN = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2)
LINE = [pin.SE3(DOWN, np.array([0.35, y, 0.35])) for y in np.linspace(-0.3, 0.3, 200)]
CIRCLE = [
    pin.SE3(DOWN, np.array([0.45 + 0.12 * np.cos(a), 0.12 * np.sin(a), 0.4])) for a in np.linspace(0, 2 * np.pi, 200)
]


@pytest.mark.parametrize("poses", [LINE, CIRCLE], ids=["line", "circle"])
@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_a_line_and_a_circle_are_followed_without_a_step_above_the_bound(name: str, poses: list[pin.SE3]) -> None:
    chain = chain_of(name)
    path = mik.solve_ik_path(chain, poses, max_step=0.1)
    assert path.continuous
    assert np.abs(np.diff(path.x, axis=0)).max() <= 0.1
    assert path.longest_step == pytest.approx(np.abs(np.diff(path.x, axis=0)).max())
    for q, pose in zip(path.q, poses, strict=True):
        error = pose.actInv(chain.placements(q)[0])
        assert np.linalg.norm(error.translation) <= 1e-5
        assert np.linalg.norm(pin.log3(error.rotation)) <= 1e-5


def test_the_path_begins_near_the_start_when_one_is_given() -> None:
    chain = chain_of("ur5")
    every = mik.solve_ik_all(chain, LINE[0])
    for x in every.x[:4]:
        path = mik.solve_ik_path(chain, LINE[:20], chain.q(x + 0.01), max_step=0.1)
        assert np.abs(path.x[0] - x).max() < 0.1


def test_through_a_wrist_singularity_a_jump_is_reported_or_bridged() -> None:
    chain = chain_of("puma560")
    # The hand keeps its orientation while the forearm comes into line with it: joints 4 and 6 turn half round there.
    goal = chain.placements(chain.q([0.0, 0.5, -2.0, 0.0, 0.0, 0.0]))[0]
    side = np.linspace(-0.1, 0.1, 60)
    poses = [pin.SE3(goal.rotation, goal.translation + np.array([0.0, y, 0.0])) for y in side]
    path = mik.solve_ik_path(chain, poses, max_step=0.15)
    steps = np.abs(np.diff(path.x, axis=0)).max(axis=1)
    assert path.success.all()
    assert (steps <= 0.15).all() or [int(i) + 1 for i in np.flatnonzero(steps > 0.15)] == list(path.breaks)


def test_poses_without_a_solution_are_reported_and_the_rest_is_followed() -> None:
    chain = chain_of("ur5")
    poses = [*LINE[:10], pin.SE3(DOWN, np.array([3.0, 0.0, 0.3])), *LINE[10:20]]
    path = mik.solve_ik_path(chain, poses, max_step=0.1)
    assert not path.continuous
    assert path.success.tolist() == [i != 10 for i in range(21)]
    assert path.breaks == ()  # the joints wait where they were, and go on from there


def test_a_leap_between_poses_is_a_break() -> None:
    chain = chain_of("ur5")
    path = mik.solve_ik_path(chain, [*LINE[:5], *LINE[150:155]], max_step=0.1)
    assert path.breaks == (5,)
    assert path.success.all()
    assert path.longest_step <= 0.1


def test_the_same_path_again() -> None:
    chain = chain_of("panda")
    assert_array_equal(mik.solve_ik_path(chain, LINE[:20]).q, mik.solve_ik_path(chain, LINE[:20]).q)


def test_bad_input() -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidTarget, match="at least one"):
        mik.solve_ik_path(chain, [])
    with pytest.raises(InvalidSetting, match="max_step"):
        mik.solve_ik_path(chain, LINE[:2], max_step=0.0)
