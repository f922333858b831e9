"""Every target is solved or proved to be out of reach, by every way of asking, and nothing is both."""

from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle
from tests.robots_under_test import chain_of

DECIDED = {mik.IKStatus.SOLVED, mik.IKStatus.UNREACHABLE}
RESTARTS = mik.IKSolver(None, "dls", mik.Budget(evaluations=5_000))  # proves nothing but by the links


@cache
def any_orientations(name: str, count: int) -> np.ndarray:
    """Poses (count, 4, 4) at positions that the arm reaches, in orientations that it may not have there."""
    chain, rng = chain_of(name), np.random.default_rng(8)
    poses = chain.poses(chain.box.sample(rng, count))[:, 0]
    for pose in poses:
        pose[:3, :3] = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
    return poses


def measured(name: str) -> mik.Chain:
    """An arm whose joints are a millimetre and a milliradian off their places, so that it has no closed form."""
    model, rng = chain_of(name).model.copy(), np.random.default_rng(0)
    for joint in range(1, model.njoints):
        off = pin.SE3(pin.exp3(1e-3 * rng.uniform(-1, 1, 3)), 1e-3 * rng.uniform(-1, 1, 3))
        model.jointPlacements[joint] = model.jointPlacements[joint] * off
    return mik.Chain(model, chain_of(name).frames[0])


@pytest.mark.parametrize("name", ["ur5", "rv7fl", "z1", "kinova", "puma560", "talos_arm", "panda", "baxter"])
def test_every_target_is_solved_or_proved_out_of_reach_and_restarts_do_not_contradict(name: str) -> None:
    chain, poses = chain_of(name), any_orientations(name, 40)
    results = [mik.solve_ik(chain, pose) for pose in poses]
    assert {result.status for result in results} == DECIDED
    for pose, result in zip(poses, results, strict=True):
        assert (result.proof is None) == result.success
        assert result.success or not mik.solve_ik(chain, pose, solver=RESTARTS).success
        assert chain.limits.contains(result.x)


def test_an_arm_off_its_closed_form_is_decided_by_boxes() -> None:
    chain = measured("puma560")
    results = [mik.solve_ik(chain, pose) for pose in any_orientations("puma560", 30)]
    assert not len(chain.form)
    assert {result.status for result in results} == DECIDED
    assert mik.Proof.BOXES in {result.proof for result in results}


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_a_batch_says_of_each_what_it_is_told_alone(name: str) -> None:
    chain, poses = chain_of(name), any_orientations(name, 40)
    batch = mik.solve_ik_batch(chain, poses, workers=2)
    for i, pose in enumerate(poses):
        alone = mik.solve_ik(chain, pose)
        assert_array_equal(batch.q[i], alone.q)
        assert (batch.status[i], batch.proof[i]) == (alone.status, alone.proof)
        assert batch[i].why == alone.why


def planar(*limits: tuple[float, float], mimic: bool = False) -> mik.Chain:
    """Links of 0.4 m whose joints turn about z; with ``mimic`` the last follows the one before."""
    model, joint = pin.Model(), 0
    for i, (low, high) in enumerate(limits):
        way, ten = pin.SE3(np.eye(3), np.array([0.4 if i else 0.0, 0.0, 0.0])), np.array([10.0])
        bounds = np.array([low]), np.array([high])
        joint = model.addJoint(joint, pin.JointModelRZ(), way, f"j{i}", ten, ten, *bounds)
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3(np.eye(3), np.array([0.4, 0, 0])), pin.FrameType.OP_FRAME))
    if mimic:
        model = pin.transformJointIntoMimic(model, joint - 1, joint, 1.0, 0.0)
    return mik.Chain(model, "tip")


def test_positions_free_axes_and_orientations_are_decided_too() -> None:
    chain = planar((-3.0, 3.0), (0.5, 1.0), (0.5, 1.0))
    near, far = chain.poses(np.array([0.2, 1.0, 1.0]))[0, 0], chain.poses(np.array([0.2, 0.5, 0.5]))[0, 0]
    inside = 0.5 * (np.linalg.norm(near[:2, 3]))
    for distance, proof in ((inside, mik.Proof.BOXES), (float(np.linalg.norm(far[:2, 3])) + 0.01, mik.Proof.BOXES)):
        assert mik.solve_ik(chain, [distance, 0.0, 0.0]).proof is proof
        turned = mik.Target(pin.SE3(np.eye(3), np.array([distance, 0, 0])), orientation_tolerance=(1e-5, 1e-5, np.inf))
        assert mik.solve_ik(chain, turned).proof is proof
    for x in chain.box.sample(np.random.default_rng(0), 20):
        goal = chain.placements(chain.q(x))[0]
        assert mik.solve_ik(chain, goal.translation).success
        assert mik.solve_ik(chain, mik.Target(goal, orientation_tolerance=(1e-5, 1e-5, np.inf))).success
    tilted = mik.Target.facing(pin.utils.rotate("x", 0.1))  # it can only turn about z
    assert mik.solve_ik(chain, tilted).proof is mik.Proof.BOXES
    assert mik.solve_ik(chain, mik.Target.facing(pin.utils.rotate("z", 0.1))).success


def test_a_follower_and_two_frames_are_decided() -> None:
    chain = planar((-1.0, 1.0), (0.3, 1.0), (0.3, 1.0), mimic=True)
    assert chain.n == 2
    for x in chain.box.sample(np.random.default_rng(0), 20):
        goal = chain.placements(chain.q(x))[0]
        assert mik.solve_ik(chain, goal).success
        goal.translation[0] += 0.01
        assert mik.solve_ik(chain, goal).proof is mik.Proof.BOXES
    arm = chain_of("baxter")
    other = {"left_gripper": "right_gripper", "right_gripper": "left_gripper"}[arm.frames[0]]
    hands = mik.Chain(arm.model, [arm.frames[0], other])
    poses = [pin.SE3(pose) for pose in any_orientations("baxter", 40)]
    proved = [pose for pose in poses if mik.solve_ik(arm, pose).proof is mik.Proof.BOXES]
    assert proved
    for pose in proved[:3]:
        assert mik.solve_ik(hands, [pose, hands.placements(hands.reference)[1]]).proof is mik.Proof.BOXES


def test_a_budget_is_kept_by_boxes_too() -> None:
    chain = chain_of("tiago")
    for most in (1, 50, 600, 5_000):
        solver = mik.IKSolver(budget=mik.Budget(evaluations=most))
        for pose in any_orientations("tiago", 8):
            assert mik.solve_ik(chain, pose, solver=solver).evaluations <= most + 100 * (most < 100)


def test_a_path_leaves_out_what_is_refuted() -> None:
    chain = chain_of("ur5")
    line = [pin.SE3(pin.utils.rotate("x", np.pi), np.array([0.4, y, 0.3])) for y in np.linspace(-0.1, 0.1, 9)]
    line[4] = pin.SE3(line[4].rotation, np.array([0.05, 0.0, 0.3]))  # in the shoulder's shadow
    assert mik.solve_ik(chain, line[4]).proof is mik.Proof.CLOSED_FORM
    path = mik.solve_ik_path(chain, line)
    assert path.success.tolist() == [i != 4 for i in range(9)]


@pytest.mark.parametrize(
    ("name", "proof"), [("ur5", "CLOSED_FORM"), ("puma560", "CLOSED_FORM"), ("talos_arm", "BOXES")]
)
def test_what_is_called_complete_has_all_that_many_descents_find(name: str, proof: str) -> None:
    chain, rng = chain_of(name), np.random.default_rng(4)
    certified = 0
    for x in chain.box.sample(rng, 20):
        goal = chain.placements(chain.q(x))[0]
        every = mik.solve_ik_all(chain, goal)
        assert every.complete in (proof, None)
        certified += every.complete is not None
        if every.complete is None:
            continue
        for start in chain.box.sample(rng, 100):
            exactly = mik.Target(goal, position_tolerance=1e-9, orientation_tolerance=1e-9)
            found = mik.solve_ik(chain, exactly, chain.q(start), solver=mik.IKSolver(None, "dls", starts=1))
            ways = np.abs((found.x - every.x + np.pi) % (2 * np.pi) - np.pi)
            assert not found.success or ways.max(axis=1).min() < 1e-2
    assert certified >= 19


@pytest.mark.parametrize("bend", [1e-2, -1e-3, 1e-4])
def test_near_a_singularity_each_solution_comes_once_and_exact_wherever_one_starts(bend: float) -> None:
    chain, rng = chain_of("ur5"), np.random.default_rng(0)
    x = np.array([0.3, -1.2, 1.4, -0.9, bend, 0.6])
    goal = chain.placements(chain.q(x))[0]
    sets = [mik.solve_ik_all(chain, goal, chain.q(start)) for start in chain.box.sample(rng, 10)]
    assert {len(found) for found in sets} == {len(sets[0])}
    for found in sets:
        assert found.complete or abs(bend) < 1e-2  # nearer, rounding hides how many branches there are
        for q in found:
            error = goal.actInv(chain.placements(q)[0])
            assert np.linalg.norm(pin.log6(error).vector) < 1e-9


def walled(name: str) -> tuple[mik.Chain, mik.CollisionWorld]:
    """A chain, and a wall between it and what is behind."""
    robot = mik.load_robot(name)
    wall = Obstacle("wall", Box((0.02, 4.0, 4.0)), (0.3, 0.0, 0.5))
    return mik.Chain(robot.model, robot.frame), mik.CollisionWorld(robot, [wall])


def test_behind_a_wall_every_solution_of_a_closed_form_collides_which_is_proved() -> None:
    chain, world = walled("ur5")
    result = mik.solve_ik(chain, pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.6, 0.0, 0.45])), world=world)
    assert (result.status, result.proof) == (mik.IKStatus.IN_COLLISION, mik.Proof.CLOSED_FORM)
    assert result.why.startswith("every solution collides")
    assert result.evaluations < 500


def test_behind_a_wall_a_redundant_arm_is_looked_at_on_a_grid_which_is_said() -> None:
    chain, world = walled("panda")
    result = mik.solve_ik(chain, pin.SE3(pin.utils.rotate("y", np.pi / 2), np.array([0.6, 0.0, 0.45])), world=world)
    assert (result.status, result.proof, result.resolution) == (mik.IKStatus.IN_COLLISION, None, 0.1)
    assert "0.1 rad" in result.why


def test_a_target_inside_an_obstacle_is_in_contact_in_every_solution() -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, [Obstacle("block", Box((0.4, 0.4, 0.4)), (0.6, 0.0, 0.4))])
    result = mik.solve_ik(chain, pin.SE3(pin.utils.rotate("x", np.pi), np.array([0.6, 0.0, 0.4])), world=world)
    assert (result.status, result.proof) == (mik.IKStatus.IN_COLLISION, mik.Proof.CONTACT)
