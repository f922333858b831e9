"""Batches: every answer is the one its target gets alone, whatever the number of workers."""

import pickle
import time

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.collision import load_scene
from pin_metaik.errors import InvalidConfiguration, InvalidSetting, InvalidTarget
from pin_metaik.ik.threads import run_parallel
from tests.robots_under_test import chain_of


@pytest.mark.parametrize("name", ["panda", "ur5", "kinova", "tiago"])
def test_a_batch_is_what_each_target_gets_alone_for_any_number_of_workers(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(0)
    poses = chain.poses(chain.box.sample(rng, 600))[:, 0]
    poses[5, :3, 3] += 5.0  # one out of reach
    starts = chain.q(chain.box.sample(rng, 600))
    one = mik.solve_ik_batch(chain, poses, starts, workers=1)
    two = mik.solve_ik_batch(chain, poses, starts, workers=2)
    assert_array_equal(one.q, two.q)
    assert_array_equal(one.evaluations, two.evaluations)
    assert one.status[5] is mik.IKStatus.UNREACHABLE
    assert np.delete(one.success, 5).all()
    for i in [*range(40), 5]:
        alone = mik.solve_ik(chain, poses[i], starts[i])
        assert_array_equal(alone.q, one.q[i])
        assert alone.status is one[i].status
        assert alone.evaluations == one[i].evaluations
        assert one[i].verify() == one[i].success


@pytest.mark.parametrize("name", ["ur5", "tiago"])  # tiago's other limbs are left out of Pinocchio's computation
def test_the_errors_of_a_batch_are_pinocchios(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(1)
    q = chain.q(chain.box.sample(rng, 30))
    for turn in (1e-9, 1e-6, 1e-3, 1.0, np.pi - 1e-6):
        for one in q:
            offset = pin.SE3(pin.exp3(turn * pin.exp3(rng.normal(size=3))[0]), 1e-6 * rng.normal(size=3))
            goal = chain.placements(one)[0] * offset
            out = np.empty((1, 2))
            reached = np.array(pin.SE3ToXYZQUATtuple(chain.tip.fk(one)))
            chain.kernels.distances(goal.homogeneous[None], reached[None], out)
            # Entries of order 1, of a product of ten rotations, are rounded to 1e-16 each.
            assert_allclose(out[0], [np.linalg.norm(offset.translation), turn], atol=3e-15)


def test_positions_and_lists_of_targets_are_batches_too() -> None:
    chain = chain_of("ur5")
    poses = chain.poses(chain.box.sample(np.random.default_rng(0), 20))[:, 0]
    positions = mik.solve_ik_batch(chain, poses[:, :3, 3])
    assert positions.success.all()
    for pose, found in zip(poses, positions.q, strict=True):
        for same in (pose[:3, 3], pose[:3, 3].tolist(), mik.Target.at(pose[:3, 3])):
            assert_array_equal(mik.solve_ik(chain, same).q, found)
    assert (positions.orientation_error == 0.0).all()
    mixed = mik.solve_ik_batch(chain, [pin.SE3(pose) for pose in poses[:5]] + [mik.Target.at(poses[6, :3, 3])])
    assert mixed.success.all()
    assert_array_equal(mixed.q[:5], mik.solve_ik_batch(chain, poses[:5]).q)
    assert len(mik.solve_ik_batch(chain, np.empty((0, 4, 4)))) == 0


def test_two_frames_and_other_solvers_go_through_too() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    pairs = [[pin.SE3(pose) for pose in both] for both in chain.poses(chain.box.sample(np.random.default_rng(0), 5))]
    assert mik.solve_ik_batch(chain, pairs).success.all()
    ur5 = chain_of("ur5")
    poses = ur5.poses(ur5.box.sample(np.random.default_rng(0), 4))[:, 0]
    assert mik.solve_ik_batch(ur5, poses, solver=mik.IKSolver("sfla", "dls")).success.all()


def test_bad_input_names_the_target() -> None:
    chain = chain_of("ur5")
    poses = np.repeat(np.eye(4)[None], 3, axis=0)
    poses[1, 0, 0] = np.nan
    with pytest.raises(InvalidTarget, match=r"target 1: .*finite"):
        mik.solve_ik_batch(chain, poses)
    poses[1] = 2.0 * np.eye(4)
    with pytest.raises(InvalidTarget, match="target 1"):
        mik.solve_ik_batch(chain, poses)
    with pytest.raises(InvalidTarget, match="shape"):
        mik.solve_ik_batch(chain, np.eye(4))
    with pytest.raises(InvalidConfiguration, match=r"\(3, 6\), got \(2, 6\)"):
        mik.solve_ik_batch(chain, np.repeat(np.eye(4)[None], 3, axis=0), np.zeros((2, 6)))
    with pytest.raises(InvalidSetting, match="workers"):
        mik.solve_ik_batch(chain, [[0.3, 0.3, 0.3]], workers=0)


def test_a_batch_in_a_world_is_what_each_target_gets_alone_there() -> None:
    robot = mik.load_robot("ur5")
    chain, world = mik.Chain(robot.model, robot.frame), mik.CollisionWorld(robot, load_scene("table"))
    poses = chain.poses(chain.box.sample(np.random.default_rng(0), 60))[:, 0]
    one, two = (mik.solve_ik_batch(chain, poses, world=world, workers=workers) for workers in (1, 2))
    assert_array_equal(one.q, two.q)
    assert one.success.any()
    assert not world.in_collision_batch(one.q[one.success]).any()
    for i in range(60):
        alone = mik.solve_ik(chain, poses[i], world=world)
        assert_array_equal(alone.q, one.q[i])
        assert alone.status is one[i].status
        assert alone.contacts == one[i].contacts
    with pytest.raises(InvalidSetting, match="not of the chain's model"):
        mik.solve_ik_batch(chain_of("panda"), poses, world=world)


def test_a_world_comes_out_of_a_pickle_as_it_was() -> None:
    robot = mik.load_robot("ur5")
    chain, world = mik.Chain(robot.model, robot.frame), mik.CollisionWorld(robot, load_scene("table"))
    again = pickle.loads(pickle.dumps(world))
    Q = chain.q(chain.box.sample(np.random.default_rng(0), 200))
    assert_array_equal(again.in_collision_batch(Q), world.in_collision_batch(Q))


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_all_parts_are_done_once_and_after_an_error_no_more_are_taken(workers: int) -> None:
    done: list[int] = []
    run_parallel(done.append, range(500), workers)
    assert sorted(done) == list(range(500))

    def fail(part: int) -> None:
        time.sleep(1e-4)
        done.append(part)
        if part == 20:
            raise KeyboardInterrupt

    done.clear()
    with pytest.raises(KeyboardInterrupt):
        run_parallel(fail, range(10_000), workers)
    assert 20 in done
    assert len(done) < 5_000  # two dozen, where nothing else runs
