"""Closed forms: which arms have one, that every branch leads to the pose, and whose branch comes first."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import pin_metaik as mik
from tests.robots_under_test import chain_of

THREE_PARALLEL = ["ur3_gripper", "ur5", "ur10", "z1", "b1_z1", "puma_offset"]
SPHERICAL_WRIST = ["kinova", "puma560", "rv7fl"]
WITH_CLOSED_FORM = THREE_PARALLEL + SPHERICAL_WRIST


def sampled(chain: mik.Chain, count: int, seed: int = 0) -> NDArray[np.float64]:
    return chain.limits.one_turn().box().sample(np.random.default_rng(seed), count)


@pytest.mark.parametrize("name", WITH_CLOSED_FORM)
def test_the_branch_that_the_guess_is_on_comes_first_and_is_the_guess_where_that_is_a_solution(name: str) -> None:
    chain = chain_of(name)
    for x in sampled(chain, 200):
        branches = chain.branches(chain.poses(x)[0, 0], x)
        # A joint near its dead centre, where two branches meet, is known to the root of the rounding.
        assert_allclose(branches[0], x, atol=1e-6)
        assert 1 <= len(branches) <= 8


@pytest.mark.parametrize("name", WITH_CLOSED_FORM)
def test_every_branch_is_inside_the_limits_and_leads_to_the_pose(name: str) -> None:
    chain = chain_of(name)
    limits, exact, many = chain.limits, 0, 0
    for x, guess in zip(sampled(chain, 200), sampled(chain, 200, seed=1), strict=True):
        pose = chain.poses(x)[0, 0]
        branches = chain.branches(pose, guess)
        assert (branches >= limits.lower - 1e-9).all()
        assert (branches <= limits.upper + 1e-9).all()
        errors = np.abs(chain.poses(branches)[:, 0] - pose).max(axis=(1, 2))
        assert errors.max() < 1e-2  # an arm stretched a little too far is let pass, for a descent to say
        exact, many = exact + int((errors < 1e-9).sum()), many + len(errors)
    assert exact > 0.995 * many


@pytest.mark.parametrize("name", WITH_CLOSED_FORM)
def test_no_descent_from_anywhere_finds_a_branch_that_is_missing(name: str) -> None:
    """Exact solutions apart from singularities: descents that stop within a tolerance find more near these."""
    chain = chain_of(name)
    found = 0
    for x in sampled(chain, 25, seed=2):
        pose = chain.poses(x)[0, 0]
        branches = chain.branches(pose, x)
        for start in sampled(chain, 40, seed=3):
            result = mik.solve_ik(chain, pose, chain.q(start), solver=mik.IKSolver(seeder=None, starts=1))
            if result.position_error + result.orientation_error < 1e-8:
                away = chain.limits.separation(branches, result.x)
                assert away.max(axis=1).min() < 1e-3
                found += 1
    assert found > 100


@pytest.mark.parametrize("name", ["ur5", "ur10", "puma_offset", "kinova", "puma560", "rv7fl"])  # wrists that straighten
def test_a_joint_that_does_not_matter_stays_where_it_is(name: str) -> None:
    chain = chain_of(name)
    for x in sampled(chain, 20):
        straight = with_straight_wrist(chain, x)
        pose = chain.poses(straight)[0, 0]
        assert_allclose(chain.branches(pose, straight)[0], straight, atol=1e-6)
        for guess in sampled(chain, 5, seed=4):
            branches = chain.branches(pose, guess)
            errors = np.abs(chain.poses(branches)[:, 0] - pose).max(axis=(1, 2))
            if chain.form[15, 1] == 0.0 and len(branches):  # else the elbow may not reach from there
                assert errors.min() < 1e-6


def with_straight_wrist(chain: mik.Chain, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """The coordinates with joint 5 turned so that axis 6 is parallel to axis 4."""
    h4, h5, h6 = chain.form[3:6]
    sin, cos = h5 @ np.cross(h6, h4), h4 @ h6 - (h5 @ h4) * (h5 @ h6)
    straight = x.copy()
    straight[4] = np.arctan2(sin, cos)
    return straight


def arm_of(axes: NDArray[np.float64], points: NDArray[np.float64], tip: pin.SE3) -> mik.Chain:
    """An arm with these axes (6, 3) through these points (6, 3) of the world when all angles are 0."""
    model, parent, before = pin.Model(), 0, np.zeros(3)
    for i, (axis, point) in enumerate(zip(axes, points, strict=True)):
        joint = pin.JointModelRevoluteUnaligned(axis)
        ranges = np.array([-3.0]), np.array([3.0])
        placement = pin.SE3(np.eye(3), point - before)
        parent = model.addJoint(parent, joint, placement, f"joint_{i + 1}", np.ones(1), np.ones(1), *ranges)
        before = point
    model.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
    return mik.Chain(model, "tip")


@pytest.mark.parametrize("kind", ["three parallel axes", "spherical wrist"])
def test_any_arm_of_either_kind_is_solved_by_its_branches(kind: str) -> None:
    """Axes at any angle to each other and with any offsets, parallel ones either way round."""
    rng = np.random.default_rng(6)
    for _ in range(20):
        axes, points = rng.normal(size=(6, 3)), rng.uniform(-0.5, 0.5, (6, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        axes[2] = rng.choice([-1.0, 1.0]) * axes[1]
        points[5] = points[4] = points[4] + rng.normal() * axes[4]
        if kind == "three parallel axes":
            axes[3] = rng.choice([-1.0, 1.0]) * axes[1]
        else:
            points[3] = points[4] + rng.normal() * axes[3]
        chain = arm_of(axes, points, pin.SE3(pin.exp3(rng.normal(size=3)), rng.uniform(-0.3, 0.3, 3)))
        assert len(chain.form)
        evaluations = []
        for x, guess in zip(sampled(chain, 50), sampled(chain, 50, seed=1), strict=True):
            pose = chain.poses(x)[0, 0]
            assert_allclose(chain.branches(pose, x)[0], x, atol=1e-6)
            result = mik.solve_ik(chain, pose, chain.q(guess))
            assert result.success
            evaluations.append(result.evaluations)
        assert np.mean(evaluations) < 2.0


def test_limits_leave_branches_out() -> None:
    robot = mik.load_robot("ur5")
    elbow = robot.model.names[3]
    free, bent = mik.Chain(robot.model, robot.frame), mik.Chain(robot.model, robot.frame, limits={elbow: (0.0, 3.0)})
    for x in sampled(bent, 50):
        pose = free.poses(x)[0, 0]
        every, some = free.branches(pose, x), bent.branches(pose, x)
        inside = np.mod(every[:, 2], 2.0 * np.pi)
        assert len(some) == (inside <= 3.0).sum() < len(every)
        assert_allclose(some[0], x, atol=1e-6)


def test_whole_turns_are_those_nearest_to_the_guess() -> None:
    chain = chain_of("ur5")
    for x in sampled(chain, 20):
        turn = 2.0 * np.pi * np.where(chain.limits.multi_turn, np.where(x > 0.0, -1.0, 1.0), 0.0)
        wound = np.where(np.abs(x + turn) < chain.limits.upper, x + turn, x)
        assert_allclose(chain.branches(chain.poses(x)[0, 0], wound)[0], wound, atol=1e-6)


def test_other_arms_have_no_closed_form() -> None:
    ur5 = mik.load_robot("ur5")
    five = mik.Chain(ur5.model, ur5.frame, locked=[ur5.model.names[3]])
    two = mik.Chain(ur5.model, [ur5.frame, "forearm_link"])
    for chain in (chain_of("panda"), chain_of("talos_arm"), chain_of("so100"), five, two):
        assert chain.form.shape == (0, 3)
        assert len(chain.branches(np.eye(4), np.zeros(chain.n))) == 0


def test_an_axis_that_is_only_nearly_parallel_ends_the_closed_form() -> None:
    model = mik.load_robot("ur5").model.copy()
    for off, rows in ((1e-9, 16), (1e-4, 0)):
        bent = model.copy()
        bent.jointPlacements[3] = bent.jointPlacements[3] * pin.SE3(pin.exp3(np.array([off, 0.0, 0.0])), np.zeros(3))
        chain = mik.Chain(bent, "tool0")
        assert len(chain.form) == rows
        x = sampled(chain, 1)[0]
        assert mik.solve_ik(chain, chain.poses(x)[0, 0]).success


@pytest.mark.parametrize("name", WITH_CLOSED_FORM)
def test_solving_takes_one_evaluation_and_stays_on_the_branch_of_q0(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(5)
    evaluations = []
    for x in sampled(chain, 100):
        near = chain.limits.clip(x + rng.uniform(-1e-3, 1e-3, 6))
        result = mik.solve_ik(chain, chain.poses(x)[0, 0], chain.q(near))
        assert result.success
        evaluations.append(result.evaluations)
    assert np.mean(evaluations) < 1.2
