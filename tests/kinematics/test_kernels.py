"""The compiled loops equal Pinocchio."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.kinematics.kernel import reference
from pin_metaik.kinematics.paths import turned_to_z
from tests.robots_under_test import ARMS, CATALOGUE, chain_of

EQUAL = 1e-12  # a dozen 3x3 products of entries of order one, and lengths of order a metre


@pytest.mark.parametrize("name", CATALOGUE + ARMS)
def test_population_poses_equal_pinocchio(name: str) -> None:
    chain = chain_of(name)
    X = chain.box.sample(np.random.default_rng(0), 50)
    scale = 1.0 if name != "puma_offset" else 60.0  # its lengths are tens of units
    for pose, x in zip(chain.poses(X)[:, 0], X, strict=True):
        assert_allclose(pose, chain.placements(chain.q(x))[0].homogeneous, atol=EQUAL * scale)


def axes(count: int) -> np.ndarray:
    """Unit axes (count, 3): any, and from 1e-12 to 1e-1 beside each way along each of x, y and z."""
    rng = np.random.default_rng(5)
    axes = rng.standard_normal((count, 3))
    beside = np.repeat(np.concatenate([np.eye(3), -np.eye(3)]), count // 12, axis=0)
    axes[: len(beside)] = beside + 10.0 ** rng.uniform(-12, -1, (len(beside), 1)) * axes[: len(beside)]
    axes[:6] = [*np.eye(3), *-np.eye(3)]
    return axes / np.linalg.norm(axes, axis=1, keepdims=True)


@pytest.mark.parametrize("kind", [pin.JointModelRevoluteUnaligned, pin.JointModelPrismaticUnaligned])
def test_poses_equal_pinocchio_whatever_the_axis(kind: type) -> None:
    rng = np.random.default_rng(6)
    for first, second in axes(1200).reshape(-1, 2, 3):
        model = pin.Model()
        one = model.addJoint(0, kind(first), pin.SE3.Random(), "one")
        two = model.addJoint(one, pin.JointModelRevoluteUnaligned(second), pin.SE3.Random(), "two")
        model.addFrame(pin.Frame("tip", two, 0, pin.SE3.Random(), pin.FrameType.OP_FRAME))
        chain = mik.Chain(model, "tip")
        for x in rng.uniform(-3.0, 3.0, (2, 2)):
            expected = chain.placements(chain.q(x))[0].homogeneous
            assert_allclose(chain.poses(x)[0, 0], expected, atol=2e-14)  # a dozen products of entries up to 4


def test_a_turn_to_an_axis_is_orthonormal_to_the_last_digit() -> None:
    for axis in axes(6000):
        turn = turned_to_z(axis).rotation
        assert_allclose(turn.T @ turn, np.eye(3), atol=1e-15)
        assert_allclose(turn[:, 2], axis, atol=1e-15)
        assert np.linalg.det(turn) > 0.0


@pytest.mark.parametrize("name", CATALOGUE + ARMS)
def test_population_costs_equal_pinocchio(name: str) -> None:
    chain = chain_of(name)
    X = chain.box.sample(np.random.default_rng(1), 50)
    goal = chain.placements(chain.q(X[0]))[0]
    problem = mik.IKProblem.of(chain, mik.Target(goal, position_weight=2.0, orientation_weight=0.5))
    costs = problem.costs(X)
    scale = 1.0 if name != "puma_offset" else 60.0
    for cost, x in zip(costs, X, strict=True):
        error = goal.actInv(chain.placements(chain.q(x))[0])
        expected = 2.0 * np.linalg.norm(error.translation) + 0.5 * np.linalg.norm(pin.log3(error.rotation))
        # log3 loses half the digits within 1e-4 of a half turn, which no sample here comes near.
        assert_allclose(cost, expected, atol=3 * EQUAL * scale)


def test_the_rotation_error_is_exact_near_zero_and_near_half_a_turn() -> None:
    model = pin.Model()
    model.addJoint(0, pin.JointModelRevoluteUnaligned(0.36, 0.48, 0.8), pin.SE3.Identity(), "hinge")
    model.addFrame(pin.Frame("tip", 1, 0, pin.SE3.Random(), pin.FrameType.OP_FRAME))
    chain = mik.Chain(model, "tip")
    problem = mik.IKProblem.of(chain, mik.Target.facing(chain.placements(chain.q([0.0]))[0].rotation))
    angles = np.array([1e-12, 1e-9, 1e-6, 1e-3, 1.0, 3.0, np.pi - 1e-3, np.pi - 1e-6, np.pi - 1e-9])
    assert_allclose(problem.costs(angles[:, None]), angles, atol=1e-14, rtol=1e-14)
    assert_allclose(problem.costs(-angles[:, None]), angles, atol=1e-14, rtol=1e-14)


def as_reference(problem: mik.IKProblem) -> reference.Problem:
    """The same problem as the readable solver takes it."""
    chain, limits = problem.chain, problem.chain.limits
    columns = [chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]
    goal = problem.targets[0].pose
    return reference.Problem(chain.model, chain.frame_ids[0], goal, chain.q, columns, limits.lower, limits.upper)


@pytest.mark.parametrize("name", [n for n in CATALOGUE + ARMS if n not in ("puma_offset", "rv7fl_paper", "cobra600")])
def test_the_descent_takes_the_steps_that_pinocchio_gives(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(2)
    X = chain.box.sample(rng, 10)
    for x_goal in X:
        problem = mik.IKProblem.of(chain, chain.placements(chain.q(x_goal))[0])
        start = chain.limits.clip(x_goal + 0.1 * rng.standard_normal(chain.n))
        for steps in (1, 2):  # so close, every step improves: the best is the last
            refined = mik.DLS().refine(problem, start[None], steps + 1)
            # Two steps through a matrix of condition up to 1e8 near singularities.
            expected, _, _ = reference.descend(as_reference(problem), start, steps + 1, 0.005, 0.49)
            assert_allclose(refined.x, expected, atol=1e-6)


@pytest.mark.parametrize("name", ["panda", "ur5", "pr2", "rv7fl"])
def test_the_readable_solver_goes_the_same_way(name: str) -> None:
    """Wherever rounding does not decide which way a start far from the target goes."""
    chain, rng, alike = chain_of(name), np.random.default_rng(3), 0
    for x_goal in chain.box.sample(rng, 20):
        problem = mik.IKProblem.of(chain, chain.placements(chain.q(x_goal))[0])
        starts = chain.box.sample(rng, 20)
        refined = mik.DLS().refine(problem, starts, 400)
        x, spent = reference.solve(as_reference(problem), starts, 400)
        assert x is None or problem.accepts(chain.q(x))
        alike += spent == refined.evaluations and (x is not None) == refined.met
    assert alike >= 18
