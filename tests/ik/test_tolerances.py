"""Tolerances are sets: whatever a target accepts is aimed at, in the middle or not, and may be given in any form."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidTarget
from tests.robots_under_test import chain_of

SHARE = 0.95  # of a tolerance that the only known solution uses up
KINDS = {
    "position": {"position_tolerance": 0.035},
    "orientation": {"orientation_tolerance": 0.35},
    "both": {"position_tolerance": 0.035, "orientation_tolerance": 0.35},
    "weights": {"position_tolerance": 0.035, "position_weight": 3.0, "orientation_weight": 0.3},
    "fine": {"position_tolerance": 1e-4, "orientation_tolerance": 1e-2},
    "default": {},
    "a free axis": {"position_tolerance": 0.035, "orientation_tolerance": (1e-3, 1e-3, np.inf)},
    "boxes": {"position_tolerance": (0.035, 0.02, 0.01), "orientation_tolerance": [0.35, 0.2, 0.1]},
}


def aside(size: object, rng: np.random.Generator) -> np.ndarray:
    """An error (3,) that uses up SHARE of a tolerance: of a ball in any direction, of a box in a corner."""
    if np.ndim(size):
        corner = np.array(size) * rng.choice([-1.0, 1.0], 3)
        return SHARE * np.where(np.isinf(size), 0.5, corner)
    direction = rng.standard_normal(3)
    return SHARE * np.asarray(size) * direction / np.linalg.norm(direction)


def beside(pose: pin.SE3, kind: str, rng: np.random.Generator) -> mik.Target:
    """A target which this pose is only just a solution of."""
    asked = KINDS[kind]
    offset = aside(asked.get("position_tolerance", 1e-5 if kind == "default" else 0.0), rng)
    turn = aside(asked.get("orientation_tolerance", 1e-5 if kind == "default" else 0.0), rng)
    error = pin.SE3(pin.exp3(turn), offset)  # of the pose, as seen from the target
    return mik.Target(pose * error.inverse(), **asked)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["so101", "ur5", "panda"])
def test_a_target_that_a_pose_is_only_just_a_solution_of_is_solved(name: str, kind: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(0)
    for x in chain.box.sample(rng, 30):
        pose = chain.placements(chain.q(x))[0]
        target = beside(pose, kind, rng)
        assert target.judge(pose).met
        result = mik.solve_ik(chain, target)
        assert result.success
        assert result.verify()


def test_batches_paths_worlds_and_all_solvers_aim_at_the_same() -> None:
    robot = mik.load_robot("so101")
    chain = chain_of("so101")
    rng = np.random.default_rng(1)
    X = chain.box.sample(rng, 12)
    targets = [beside(chain.placements(chain.q(x))[0], "orientation", rng) for x in X]
    assert mik.solve_ik_batch(chain, targets).success.all()
    for solver in (
        mik.IKSolver(select="nearest"),
        mik.IKSolver(None, "lm_chan"),
        mik.IKSolver("mtde", "dls"),
        mik.IKSolver("mtde", None, mik.Budget(evaluations=50_000)),
    ):
        assert all(mik.solve_ik(chain, target, solver=solver).success for target in targets[:4])
    for target in targets[:4]:
        found = mik.solve_ik_all(chain, target)
        assert len(found)
        assert not found.complete
    world = mik.CollisionWorld(robot)
    for x, target in zip(X, targets, strict=True):
        if not world.in_collision(chain.q(x)):
            assert mik.solve_ik(chain, target, world=world).success
    line = [chain.placements(chain.q(0.3 * X[0] + step))[0] for step in np.linspace(0.0, 0.2, 6)]
    turned = [pose * pin.SE3(pin.exp3(np.array([0.33, 0.0, 0.0])), np.zeros(3)) for pose in line]
    path = mik.solve_ik_path(chain, [mik.Target(pose, orientation_tolerance=0.35) for pose in turned])
    assert path.success.all()


def test_two_hands_may_each_be_a_little_off() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    rng = np.random.default_rng(2)
    for x in chain.box.sample(rng, 5):
        targets = [beside(pose, "both", rng) for pose in chain.placements(chain.q(x))]
        result = mik.solve_ik(chain, targets)
        assert result.success
        assert result.verify()


def test_an_answer_away_from_the_edge_is_preferred() -> None:
    chain = chain_of("panda")
    poses = [chain.placements(chain.q(x))[0] for x in chain.box.sample(np.random.default_rng(3), 40)]
    results = [mik.solve_ik(chain, mik.Target(pose, None, 0.05, 0.5)) for pose in poses]
    assert np.median([result.position_error for result in results]) < 0.005
    assert np.median([result.orientation_error for result in results]) < 0.05


@pytest.mark.parametrize("name", ["panda", "so101"])
def test_the_cost_of_the_whole_is_the_distance_to_it_and_the_residual_its_derivative(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(4)
    X = chain.box.sample(rng, 20)
    goal = chain.placements(chain.q(X[0]))[0]
    target = mik.Target(goal, None, 0.1, 0.4, position_weight=2.0, orientation_weight=0.5)
    problem = mik.IKProblem.of(chain, target).whole
    for x, cost in zip(X, problem.costs(X), strict=True):
        judged = target.judge(chain.placements(chain.q(x))[0])
        beyond = max(judged.position_error - 0.099, 0.0), max(judged.orientation_error - 0.396, 0.0)
        assert cost == pytest.approx(2.0 * beyond[0] + 0.5 * beyond[1], abs=1e-9)
        r, J = problem.linearize(x)
        assert_allclose([np.linalg.norm(r[:3]), np.linalg.norm(r[3:])], [2.0 * beyond[0], 0.5 * beyond[1]], atol=1e-9)
        if judged.orientation_error < 3.0:
            steps = 1e-6 * np.eye(chain.n)
            ahead, behind = ([problem.linearize(one)[0] for one in x + sign * steps] for sign in (1.0, -1.0))
            assert_allclose(J, (np.array(ahead) - behind) / 2e-6, atol=1e-6)


@pytest.mark.parametrize("three", [[0.1, 0.2, 0.3], np.array([0.1, 0.2, 0.3]), (0.1, np.float32(0.2), 0.3)])
def test_lists_and_arrays_of_three_are_tolerances(three: object) -> None:
    target = mik.Target(np.eye(4), position_tolerance=three, orientation_tolerance=three)
    assert target.position_tolerance == pytest.approx((0.1, 0.2, 0.3))
    assert {type(each) for each in target.orientation_tolerance} == {float}
    assert isinstance(hash((target.position_tolerance, target.orientation_tolerance)), int)
    same = mik.Target(np.eye(4), position_tolerance=target.position_tolerance)
    assert_array_equal(same.record[12:15], target.record[12:15])


@pytest.mark.parametrize("tolerance", [[1e-3] * 2, [[1e-3] * 3], [1e-3, -1.0, 1e-3], ([1e-3], 1.0, 1.0), {}, None])
def test_other_lists_are_not(tolerance: object) -> None:
    with pytest.raises(InvalidTarget, match="orientation_tolerance is a number above 0, or three of them"):
        mik.Target(np.eye(4), orientation_tolerance=tolerance)
