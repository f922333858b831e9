"""Joint moves round obstacles, by OMPL."""

from __future__ import annotations

import gc

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from benchmarks.collision_cases import gantry
from pin_metaik.collision import Box, Obstacle
from pin_metaik.errors import InvalidConfiguration, InvalidSetting, UnknownName
from pin_metaik.planning import Adapter, installed, plan_joint_move
from tests.collision.worlds import robot_of

pytestmark = pytest.mark.skipif(not installed(), reason="OMPL is not installed")
WALL = Obstacle("wall", Box((0.002, 0.5, 2.0)), (0.0, 0.0, 0.0))  # the way round it leads by its sides


def behind_a_wall() -> tuple[mik.Chain, mik.CollisionWorld]:
    robot = gantry("gantry, box")
    return mik.Chain(robot, "tool"), mik.CollisionWorld(robot, [WALL])


def test_a_way_leads_round_a_thin_wall_and_every_part_of_it_is_proved_free() -> None:
    chain, world = behind_a_wall()
    q0, q1 = np.array([-0.3, 0.0, 0.0, 0.0]), np.array([0.3, 0.0, 0.0, 1.0])
    assert not world.clear_between(q0, q1)
    plan = plan_joint_move(chain, world, q0, q1)
    assert plan
    assert plan.goal == 0
    assert_allclose(plan.q[[0, -1]], [q0, q1])
    assert world.clear_between_batch(plan.q[:-1], plan.q[1:]).all()
    assert plan.as_dict()["success"] is True


def test_any_of_several_goals_will_do_and_one_in_collision_is_left_out() -> None:
    chain, robot = mik.Chain(robot_of("ur5"), "tool0"), robot_of("ur5")
    world = mik.CollisionWorld(robot, [Obstacle("post", Box((0.05, 0.05, 1.0)), (0.35, 0.0, 0.5))])
    pose = pin.SE3(pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2), np.array([0.35, 0.3, 0.35]))
    q0 = mik.solve_ik(chain, pose * pin.SE3(np.eye(3), np.array([0.0, 0.6, 0.0])), world=world).q
    goals = mik.solve_ik_all(chain, pose, q0, world=world).q
    inside = mik.solve_ik(chain, [0.35, 0.0, 0.35]).q
    assert world.in_collision(inside)
    plan = plan_joint_move(chain, world, q0, np.concatenate([[inside], goals]))
    assert plan.goal is not None
    assert plan.goal > 0
    reached = chain.placements(plan.q[-1])[0]
    assert np.linalg.norm(reached.translation - pose.translation) < 1e-4
    assert not plan_joint_move(chain, world, q0, inside)
    assert not plan_joint_move(chain, world, inside, goals)


def test_continuous_joints_turn_the_short_way() -> None:
    robot = robot_of("kinova")
    chain, world = mik.Chain(robot, robot.frame), mik.CollisionWorld(robot)
    q = mik.solve_ik(chain, [0.3, 0.3, 0.4], world=world).q
    x = chain.x(q)
    turned = x + np.where(chain.limits.periodic, 2.0 * np.pi - 0.3, 0.0)
    plan = plan_joint_move(chain, world, q, chain.q(turned, q))
    assert plan
    assert np.abs(plan.x[-1] - plan.x[0])[chain.limits.periodic].max() == pytest.approx(0.3)


def test_the_adapter_is_what_a_planner_of_ones_own_needs() -> None:
    from ompl import geometric as og

    chain, world = behind_a_wall()
    adapter = Adapter(chain, world)
    q = np.array([-0.3, 0.1, 0.2, 0.5])
    assert_allclose(adapter.q(adapter.state(q)), q)
    setup = adapter.setup()
    information = setup.getSpaceInformation()
    assert information.isValid(adapter.state(q))
    assert not information.isValid(adapter.state([0.0, 0.0, 0.0, 0.0]))
    assert not information.checkMotion(adapter.state([-0.3, 0.0, 0.0, 0.0]), adapter.state([0.3, 0.0, 0.0, 0.0]))
    assert og.RRTConnect(information)
    del setup, information
    gc.collect()


def test_bad_input_is_told_by_name() -> None:
    chain, world = behind_a_wall()
    q = np.zeros(4)
    with pytest.raises(UnknownName, match="RRTConnect"):
        plan_joint_move(chain, world, q, q, planner="rrt connect")
    with pytest.raises(InvalidConfiguration, match="goals"):
        plan_joint_move(chain, world, q, np.empty((0, 4)))
    with pytest.raises(InvalidSetting, match="seconds"):
        plan_joint_move(chain, world, q, q, seconds=0.0)
    with pytest.raises(InvalidSetting, match="model"):
        Adapter(mik.Chain(robot_of("ur5"), "tool0"), world)
    with pytest.raises(InvalidSetting, match="state"):
        Adapter(chain, world).q(None)
