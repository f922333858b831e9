"""All solutions, and the choice among them."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.collision import Obstacle, Sphere
from pin_metaik.dexterity import manipulability, singular_values
from pin_metaik.errors import InvalidBudget, InvalidSetting, InvalidTarget, UnknownName
from tests.robots_under_test import chain_of


def wrapped(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi)


@pytest.mark.parametrize("name", ["ur5", "puma560", "rv7fl"])
def test_the_generating_configuration_is_among_the_solutions_and_all_are_distinct_and_true(name: str) -> None:
    chain = chain_of(name)
    for x in chain.box.sample(np.random.default_rng(0), 40):
        goal = chain.placements(chain.q(x))[0]
        solutions = mik.solve_ik_all(chain, goal)
        # 1e-5 of tolerance moves a joint by 1e-5 over the least singular value; at a singularity solutions have no end.
        slack = 1e-5 / singular_values(solutions.problem.linearize(x)[1])[-1]
        assert slack > 0.1 or min(wrapped(one, x).max() for one in solutions.x) < 1e-4 + slack
        for q in solutions:
            error = goal.actInv(chain.placements(q)[0])
            assert np.linalg.norm(error.translation) <= 1e-5
            assert np.linalg.norm(pin.log3(error.rotation)) <= 1e-5
            assert chain.limits.contains(chain.x(q))
        for i, one in enumerate(solutions.x):
            assert all(wrapped(one, other).max() > 5e-3 for other in solutions.x[:i])


def test_a_ur5_has_eight_solutions_nearest_to_the_start_first() -> None:
    chain = chain_of("ur5")
    x = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6])
    solutions = mik.solve_ik_all(chain, chain.placements(chain.q(x))[0], chain.q(x))
    assert len(solutions) == 8
    assert solutions.complete
    assert_allclose(solutions.x[0], x, atol=1e-6)
    distances = np.linalg.norm(solutions.x - x, axis=1)
    assert (np.diff(distances) >= 0.0).all()


def test_solutions_beyond_a_turn_come_as_the_copy_nearest_to_the_start() -> None:
    chain = chain_of("ur5")
    x = np.array([5.5, -1.2, 1.4, -5.0, -1.5, -5.8])
    result = mik.solve_ik(chain, chain.placements(chain.q(x))[0], chain.q(x + 0.01))
    assert_allclose(result.x, x, atol=1e-5)
    far = mik.solve_ik_all(chain, chain.placements(chain.q(x))[0], chain.q(np.zeros(6)))
    assert (np.abs(far.x) <= np.pi + 1e-9).all()


def test_a_redundant_chain_gives_a_sample_and_says_so() -> None:
    chain = chain_of("panda")
    goal = chain.placements(chain.q(chain.box.sample(np.random.default_rng(0), 1)[0]))[0]
    solutions = mik.solve_ik_all(chain, goal, limit=20)
    assert len(solutions) == 20
    assert not solutions.complete


def test_out_of_reach_has_no_solutions() -> None:
    solutions = mik.solve_ik_all(chain_of("ur5"), [5.0, 0.0, 0.0])
    assert len(solutions) == 0
    assert solutions.q.shape == (0, 6)


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_select_nearest_is_never_farther_than_the_nearest_of_all(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(1)
    nearest = mik.IKSolver(select="nearest")
    for x, x0 in zip(chain.box.sample(rng, 30), chain.box.sample(rng, 30), strict=True):
        goal, q0 = chain.placements(chain.q(x))[0], chain.q(x0)
        result = mik.solve_ik(chain, goal, q0, solver=nearest)
        assert result.success
        every = mik.solve_ik_all(chain, goal, q0)
        assert np.linalg.norm(result.x - x0) <= np.linalg.norm(every.x[0] - x0) + 1e-4


def test_select_manipulability_and_limits_choose_by_their_measures() -> None:
    for name in ("ur5", "panda"):
        chain = chain_of(name)
        for x in chain.box.sample(np.random.default_rng(2), 10):
            goal = chain.placements(chain.q(x))[0]
            first, best, safe = (
                mik.solve_ik(chain, goal, solver=mik.IKSolver(select=select))
                for select in ("first", "manipulability", "limits")
            )
            assert first.success
            assert best.success
            assert safe.success

            def nimble(q: np.ndarray, chain: mik.Chain = chain) -> float:
                J = pin.computeFrameJacobian(chain.model, chain.data, q, chain.frame_ids[0])
                return float(manipulability(J[:, [chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]]))

            def crowded(x: np.ndarray, chain: mik.Chain = chain) -> float:
                lower, upper = chain.limits.lower, chain.limits.upper
                return float(np.abs((2 * x - lower - upper) / (upper - lower)).max())

            assert nimble(best.q) >= nimble(first.q) - 1e-6
            assert crowded(safe.x) <= crowded(first.x) + 1e-6


def test_same_seed_same_solutions() -> None:
    chain = chain_of("puma560")
    goal = chain.placements(chain.q(chain.box.sample(np.random.default_rng(0), 1)[0]))[0]
    assert_array_equal(mik.solve_ik_all(chain, goal).q, mik.solve_ik_all(chain, goal).q)


def test_bad_settings_are_named() -> None:
    chain = chain_of("ur5")
    with pytest.raises(UnknownName, match="did you mean 'nearest'"):
        mik.IKSolver(select="nearst")
    with pytest.raises(InvalidSetting, match="limit"):
        mik.solve_ik_all(chain, [0.3, 0.3, 0.3], limit=0)
    with pytest.raises(InvalidBudget, match="evaluations"):
        mik.solve_ik_all(chain, [0.3, 0.3, 0.3], budget=mik.Budget(seconds=1.0))


@pytest.mark.parametrize("name", ["ur5", "puma560", "z1", "aerial_arm", "bravo7_no_ee"])
def test_the_quick_way_and_the_long_way_have_the_same_solutions(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    chain, rng = chain_of(name), np.random.default_rng(4)
    quick = 0
    for x, x0 in zip(chain.box.sample(rng, 25), chain.box.sample(rng, 25), strict=True):
        pose, q0 = chain.poses(x)[0, 0], chain.q(x0)
        with monkeypatch.context() as patch:
            patch.setattr("pin_metaik.ik.solutions.all_of_plain", lambda *asked: None)
            long = mik.solve_ik_all(chain, pose, q0, certify=False)
        every = mik.solve_ik_all(chain, pose, q0, certify=False)
        assert_array_equal(every.q, long.q)
        assert (every.complete, every.evaluations) == (long.complete, long.evaluations)
        assert_allclose(every.problem.targets[0].pose.homogeneous, pose, atol=1e-12)
        quick += not isinstance(every.given, mik.IKProblem)
    assert quick >= 20  # of 25; near singularities the long way is the only one


def test_solutions_of_many_targets_do_not_depend_on_the_workers() -> None:
    chain = chain_of("aerial_arm")
    poses = chain.poses(chain.box.sample(np.random.default_rng(5), 12))[:, 0]
    alone = [mik.solve_ik_all(chain, pose) for pose in poses]
    for workers in (1, 3):
        together = mik.solve_ik_all_batch(chain, poses, workers=workers)
        for one, other in zip(alone, together, strict=True):
            assert_array_equal(one.q, other.q)
            assert one.complete == other.complete
    with pytest.raises(InvalidTarget, match="target 1"):
        mik.solve_ik_all_batch(chain, [poses[0], "here"])
    ended = mik.solve_ik_all_batch(chain, poses, workers=1, watch=lambda done: done.done >= 3)
    assert [bool(len(one)) for one in ended] == [True] * 3 + [False] * 9
    assert ended[-1].interrupted and not ended[0].interrupted


def test_select_clearance_keeps_farther_from_obstacles_than_the_first_solution() -> None:
    chain = chain_of("ur5")
    robot = mik.load_robot("ur5")
    world = mik.CollisionWorld(robot, [Obstacle("ball", Sphere(0.1), (0.35, 0.45, 0.9))])
    x = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6])
    goal = chain.placements(chain.q(x))[0]
    first = mik.solve_ik(chain, goal, world=world)
    most = mik.solve_ik(chain, goal, solver=mik.IKSolver(select="clearance"), world=world)
    every = mik.solve_ik_all(chain, goal, world=world)
    assert most.success
    distances = [world.min_distance(q).distance for q in every]
    assert world.min_distance(most.q).distance >= max(distances) - 1e-6
    assert max(distances) >= world.min_distance(first.q).distance - 1e-6
    with pytest.raises(InvalidSetting, match="give one"):
        mik.solve_ik(chain, goal, solver=mik.IKSolver(select="clearance"))
