"""Other processes: chains and problems go there, results and errors come back, and none of them is large."""

import copy
import multiprocessing
import pickle
from functools import partial

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik import errors
from pin_metaik.collision import load_scene
from pin_metaik.mobile.errors import Blocked, NoPath
from tests.robots_under_test import chain_of

DOWN = np.diag([1.0, -1.0, -1.0])
RAISED = [
    errors.UnknownName("robot", "pnda", ["panda"]),
    errors.FrameNotFound("tip", ["tool0"]),
    errors.MissingExtra("planning", "mobile"),
    errors.InvalidTarget("no pose"),
    Blocked("start", (0.0, 1.0), 0.5, None),
    NoPath((0.0, 1.0), (2.0, 3.0), 0.5),
]


def poses(count: int) -> list[pin.SE3]:
    return [pin.SE3(DOWN, np.array([0.4, 0.02 * i, 0.4])) for i in range(count)]


def fail(number: int) -> None:
    raise RAISED[number]


@pytest.mark.parametrize("how", ["fork", "spawn", "forkserver"])
def test_a_pool_gives_the_answers_of_this_process(how: str) -> None:
    chain = chain_of("panda")
    here = [mik.solve_ik(chain, pose) for pose in poses(6)]
    with multiprocessing.get_context(how).Pool(2) as pool:
        there = pool.map_async(partial(mik.solve_ik, chain), poses(6)).get(timeout=300)
    assert_array_equal([result.q for result in here], [result.q for result in there])
    assert len({id(result.chain) for result in there}) == 1  # they come one by one, and share what they have in common


@pytest.mark.parametrize("number", range(len(RAISED)))
def test_an_error_comes_back_from_another_process_as_it_was_raised(number: int) -> None:
    again = pickle.loads(pickle.dumps(RAISED[number]))
    assert type(again) is type(RAISED[number])
    assert (str(again), vars(again)) == (str(RAISED[number]), vars(RAISED[number]))


def test_a_pool_does_not_hang_on_an_error() -> None:
    with multiprocessing.get_context("fork").Pool(1) as pool, pytest.raises(errors.UnknownName, match="'panda'"):
        pool.map_async(fail, [0]).get(timeout=300)


def test_a_pickled_result_is_kilobytes_and_leaves_its_world_behind() -> None:
    robot = mik.load_robot("panda")
    chain, world = mik.Chain(robot.model, robot.frame), mik.CollisionWorld(robot, load_scene("table"))
    result = mik.solve_ik(chain, poses(1)[0], world=world)
    pickled = pickle.dumps(result)
    assert len(pickled) < 5_000
    again = pickle.loads(pickled)
    assert result.world is world
    assert again.world is None
    assert again.verify()
    again.world = pickle.loads(pickle.dumps(world))
    assert again.verify()
    assert copy.copy(result).world is world
    assert len(pickle.dumps([mik.solve_ik(chain, pose) for pose in 100 * poses(1)])) < 50_000
    everything = mik.solve_ik_all(chain, poses(1)[0], world=world)
    assert len(pickle.dumps(everything)) < 30_000
    assert_array_equal(pickle.loads(pickle.dumps(everything)).x, everything.x)


def test_what_collided_is_known_without_the_world() -> None:
    robot = mik.load_robot("ur5")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, [mik.collision.Obstacle("ball", mik.collision.Sphere(0.1), [0.4, 0.1, 0.4])])
    result = mik.solve_ik(chain, pin.SE3(DOWN, np.array([0.4, 0.1, 0.4])), world=world)
    batch = mik.solve_ik_batch(chain, [result.target], world=world)
    for again in (pickle.loads(pickle.dumps(result)), pickle.loads(pickle.dumps(batch))[0]):
        assert again.status is mik.IKStatus.IN_COLLISION
        assert "ball" in again.why
        assert not again.verify()


def test_problems_paths_and_batches_come_out_of_a_pickle_as_they_were() -> None:
    chain = chain_of("panda")
    path, batch = mik.solve_ik_path(chain, poses(3)), mik.solve_ik_batch(chain, poses(3))
    for before in (path, batch):
        after = pickle.loads(pickle.dumps(before))
        assert_array_equal(after.q, before.q)
        assert_array_equal(after.success, before.success)
    problem = mik.IKProblem.of(chain, poses(1)[0])
    again = pickle.loads(pickle.dumps(problem))
    assert_array_equal(mik.IKSolver("gwo", "dls").solve(again).q, mik.IKSolver("gwo", "dls").solve(problem).q)
