"""Any of several targets: those that are hard to decide are not in the way of the others."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle
from pin_metaik.errors import InvalidTarget
from tests.collision.worlds import robot_of
from tests.robots_under_test import chain_of

DOWN = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2)
GRASPS = [pin.SE3(pin.rpy.rpyToMatrix(np.pi, 0.0, yaw), np.array([0.4, 0.1, 0.3])) for yaw in np.linspace(-1.5, 1.5, 7)]
FAR = pin.SE3(DOWN, np.array([3.0, 0.0, 0.3]))


def test_the_first_target_that_is_met_is_chosen() -> None:
    choice = mik.solve_ik_any(chain_of("panda"), [FAR, *GRASPS])
    assert choice
    assert choice.index == 1
    assert choice.result is not None
    assert choice.result.verify()
    assert choice.status[:2] == (mik.IKStatus.UNREACHABLE, mik.IKStatus.SOLVED)
    assert choice.status[2:] == (None,) * 6
    assert "target 1 is met" in str(choice)


def test_a_target_that_is_hard_to_decide_costs_little_before_a_good_one() -> None:
    chain, robot = chain_of("panda"), robot_of("panda")
    world = mik.CollisionWorld(robot, [Obstacle("block", Box((0.1, 0.1, 0.2)), (0.45, -0.3, 0.3))])
    hidden = [pin.SE3(pin.exp3(0.3 * np.eye(3)[k]) @ DOWN, np.array([0.45, -0.3, 0.25])) for k in range(3)]
    alone = mik.solve_ik(chain, hidden[0], world=world)
    assert alone.status is mik.IKStatus.IN_COLLISION
    choice = mik.solve_ik_any(chain, [*hidden, GRASPS[3]], world=world)
    assert choice.index == 3
    assert choice.evaluations < 3 * 1500
    assert not mik.solve_ik_any(chain, hidden[:1], world=world, solver=mik.IKSolver(budget=mik.Budget(2000)))


def test_the_nearest_and_the_best_are_the_least_of_those_of_single_targets() -> None:
    chain = chain_of("ur5")
    q0 = mik.solve_ik(chain, GRASPS[4]).q
    near = mik.solve_ik_any(chain, GRASPS, q0, solver=mik.IKSolver(select="nearest"))
    assert near.index == 4
    for select, measure in (("manipulability", manipulability), ("limits", crowding)):
        solver = mik.IKSolver(select=select)
        choice = mik.solve_ik_any(chain, GRASPS, q0, solver=solver)
        single = [measure(mik.solve_ik(chain, grasp, q0, solver=solver)) for grasp in GRASPS]
        assert choice.result is not None
        assert measure(choice.result) <= min(single) + 1e-3


def manipulability(result: mik.IKResult) -> float:
    J = result.problem.linearize(result.x)[1].T
    return -float(np.sqrt(np.linalg.det(J @ J.T)))


def crowding(result: mik.IKResult) -> float:
    limits = result.chain.limits
    return float(np.abs((2 * result.x - limits.lower - limits.upper) / (limits.upper - limits.lower)).max())


def test_none_is_met_where_none_can_be() -> None:
    choice = mik.solve_ik_any(chain_of("ur5"), [FAR, FAR])
    assert not choice
    assert choice.index is None
    assert choice.q is None
    assert set(choice.status) == {mik.IKStatus.UNREACHABLE}
    assert choice.as_dict()["success"] is False


def test_a_watch_ends_the_search_and_time_may_be_limited() -> None:
    chain = chain_of("ur5")
    stopped = mik.solve_ik_any(chain, [FAR, *GRASPS], watch=lambda at: at.done == 1)
    assert stopped.interrupted
    assert stopped.status[0] is mik.IKStatus.UNREACHABLE
    timed = mik.IKSolver(budget=mik.Budget(seconds=120.0))  # a machine may have to compile first
    assert mik.solve_ik_any(chain, [FAR, *GRASPS], solver=timed).index == 1


def test_positions_in_an_array_and_several_frames() -> None:
    assert mik.solve_ik_any(chain_of("ur5"), np.array([[3.0, 0.0, 0.0], [0.3, 0.3, 0.4]])).index == 1


def test_bad_input_is_told_by_name() -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidTarget, match="at least one"):
        mik.solve_ik_any(chain, [])
    with pytest.raises(InvalidTarget, match="target 1"):
        mik.solve_ik_any(chain, [GRASPS[0], [1.0, 2.0]])
    with pytest.raises(InvalidTarget, match="a target is"):
        mik.solve_ik_any(chain, GRASPS[0])
