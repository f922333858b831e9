"""Solving: what is reachable is solved, Pinocchio says so, and what is not is said plainly."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.compare.cases.boundary import farthest
from pin_metaik.errors import (
    FrameNotFound,
    InvalidBudget,
    InvalidConfiguration,
    InvalidSetting,
    InvalidTarget,
    UnknownName,
)
from tests.robots_under_test import chain_of

RV7FL_CASES = [(0.035, -0.905, 0.400), (0.63925, -0.64594, 0.40079), (-0.050, -0.905, 0.315)]


def pinocchio_error(chain: mik.Chain, q: np.ndarray, goal: pin.SE3) -> tuple[float, float]:
    """Distance and angle with a model's own data, sharing no code with the library."""
    data = chain.model.createData()
    pin.framesForwardKinematics(chain.model, data, q)
    error = goal.actInv(data.oMf[chain.frame_ids[0]])
    return float(np.linalg.norm(error.translation)), float(np.linalg.norm(pin.log3(error.rotation)))


NARROW = {"panda_joint1": (-0.1, 0.1), "panda_joint3": (-0.1, 0.1)}


def behind_its_back() -> tuple[mik.Chain, pin.SE3]:
    """A target that its limits keep a Panda from, which no bound on its reach can prove."""
    chain = mik.Chain(mik.load_robot("panda").model, "panda_hand_tcp", limits=NARROW)
    return chain, pin.SE3(pin.rpy.rpyToMatrix(np.pi, 0.0, 0.0), np.array([-0.1, 0.45, 0.3]))


@pytest.mark.parametrize("name", ["panda", "ur5", "kinova", "tiago"])
def test_a_thousand_random_reachable_poses_are_all_solved(name: str) -> None:
    chain = chain_of(name)
    rng = np.random.default_rng(7)
    lower, upper = chain.model.lowerPositionLimit, chain.model.upperPositionLimit
    entries = chain.coordinates.plain_q
    for x in chain.box.sample(rng, 1000):
        goal = chain.placements(chain.q(x))[0]
        result = mik.solve_ik(chain, goal)
        assert result.status is mik.IKStatus.SOLVED
        position, orientation = pinocchio_error(chain, result.q, goal)
        assert position <= 1e-5
        assert orientation <= 1e-5
        assert (result.q[entries] >= lower[entries]).all()
        assert (result.q[entries] <= upper[entries]).all()


@pytest.mark.parametrize("seeder", [None, "auto", *mik.ALGORITHMS])
def test_every_seeder_with_dls_solves_the_rv7fl_paper_case(seeder: str | None) -> None:
    chain = chain_of("rv7fl_paper")
    solver = mik.IKSolver(seeder, "dls", mik.Budget(evaluations=20_000))
    result = mik.solve_ik(chain, RV7FL_CASES[1], solver=solver, rng=0)
    assert result.status is mik.IKStatus.SOLVED
    assert result.position_error < 1e-9


@pytest.mark.parametrize("case", RV7FL_CASES)
def test_grey_wolves_alone_come_within_the_papers_two_hundredths_of_a_millimetre(case: tuple[float, ...]) -> None:
    chain = chain_of("rv7fl_paper")
    from pin_metaik.optimize.gwo import GWO

    budget = mik.Budget(evaluations=300_000)
    solver = mik.IKSolver(GWO(agents=300), None, budget)
    best = min(mik.solve_ik(chain, case, solver=solver, rng=seed).position_error for seed in range(3))
    assert best <= 2e-5


def test_a_pure_metaheuristic_spends_its_budget_and_no_more() -> None:
    chain = chain_of("ur5")
    goal = chain.placements(chain.q([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]))[0]
    solver = mik.IKSolver("gwo", None, mik.Budget(evaluations=1234))
    result = mik.solve_ik(chain, goal, solver=solver)
    assert result.evaluations == 1234
    assert result.status is mik.IKStatus.OUT_OF_TOLERANCE


@pytest.mark.parametrize("evaluations", [1, 2, 50, 777])
@pytest.mark.parametrize("seeder", [None, "auto", "gwo", "mtde"])
def test_no_solver_overspends(seeder: str | None, evaluations: int) -> None:
    chain, far = behind_its_back()
    result = mik.solve_ik(chain, far, solver=mik.IKSolver(seeder, "dls", mik.Budget(evaluations=evaluations)))
    assert result.evaluations <= evaluations
    assert chain.limits.contains(result.x)


@pytest.mark.parametrize("evaluations", [500, 5000, 10_000])
def test_all_solutions_and_the_best_of_them_keep_to_the_budget_at_the_edge_of_the_workspace(evaluations: int) -> None:
    robot = mik.load_robot("rv7fl")  # arms stretched out: nearly double roots, many evaluations to tell them apart
    chain, rng = mik.Chain(robot, robot.frame), np.random.default_rng(3)
    budget = mik.Budget(evaluations=evaluations)
    for _ in range(8):
        direction, x = rng.normal(size=3), chain.box.sample(rng, 1)[0]
        pose = chain.placements(chain.q(farthest(chain, x, direction / np.linalg.norm(direction))))[0]
        best = mik.solve_ik(chain, pose, solver=mik.IKSolver(select="nearest", budget=budget))
        every = mik.solve_ik_all(chain, pose, budget=budget)
        assert best.success and best.evaluations <= evaluations
        assert len(every) and every.evaluations <= evaluations


def test_the_same_seed_gives_the_same_answer_and_another_seed_may_not() -> None:
    chain = chain_of("panda")
    goals = [chain.placements(chain.q(x))[0] for x in chain.box.sample(np.random.default_rng(3), 20)]
    first = [mik.solve_ik(chain, goal).q for goal in goals]
    again = [mik.solve_ik(mik.Chain(chain.model, chain.frames[0]), goal, rng=None).q for goal in goals]
    assert_array_equal(first, again)
    random = mik.IKSolver(seeder=None)
    one, other = ([mik.solve_ik(chain, goal, solver=random, rng=seed).q for goal in goals] for seed in (0, 1))
    assert any((a != b).any() for a, b in zip(one, other, strict=True))
    generators = [mik.solve_ik(chain, goals[0], rng=np.random.default_rng(9)).q for _ in range(2)]
    assert_array_equal(*generators)


def test_out_of_reach_is_a_status_with_the_nearest_pose_found() -> None:
    chain = chain_of("panda")
    result = mik.solve_ik(chain, [2.0, 0.0, 0.5])
    assert result.status is mik.IKStatus.UNREACHABLE
    assert not result.success
    assert chain.limits.contains(result.x)
    assert "out of reach" in result.why
    tips = chain.poses(chain.box.sample(np.random.default_rng(0), 20_000))[:, 0, :3, 3]
    assert result.position_error <= np.linalg.norm(tips - [2.0, 0.0, 0.5], axis=1).min()


def test_joints_outside_the_chain_stay_where_q0_has_them() -> None:
    chain = chain_of("panda")
    q0 = chain.configuration(np.zeros(chain.model.nq))
    q0[7:] = 0.02  # the fingers
    goal = chain.placements(chain.q(chain.box.sample(np.random.default_rng(0), 1)[0]))[0]
    assert_allclose(mik.solve_ik(chain, goal, q0).q[7:], 0.02)


def test_a_start_outside_the_limits_is_brought_inside() -> None:
    chain = chain_of("panda")
    goal = chain.placements(chain.q(chain.box.sample(np.random.default_rng(0), 1)[0]))[0]
    result = mik.solve_ik(chain, goal, np.full(chain.model.nq, 50.0))
    assert result.success
    assert chain.limits.contains(result.x)


def test_near_its_solution_the_default_solver_goes_to_it() -> None:
    chain = chain_of("ur5")
    x = np.array([0.3, -1.2, 1.4, -0.9, -1.5, 0.6])
    result = mik.solve_ik(chain, chain.placements(chain.q(x))[0], chain.q(x + 0.05))
    assert_allclose(result.x, x, atol=1e-6)


def test_orientation_only_and_free_axes_and_loose_tolerances_are_kept() -> None:
    chain = chain_of("ur5")
    goal = chain.placements(chain.q([0.3, -1.2, 1.4, -0.9, -1.5, 0.6]))[0]
    facing = mik.solve_ik(chain, mik.Target.facing(goal.rotation))
    assert facing.success
    assert facing.position_error == 0.0
    assert pinocchio_error(chain, facing.q, goal)[1] <= 1e-5

    pointing = mik.solve_ik(chain, mik.Target(goal, orientation_tolerance=(1e-5, 1e-5, np.inf)), rng=1)
    assert pointing.success
    reached = chain.placements(pointing.q)[0]
    assert_allclose(reached.rotation[:, 2], goal.rotation[:, 2], atol=2e-5)

    loose = mik.solve_ik(chain, mik.Target(goal, position_tolerance=(0.01, 0.02, 0.03), orientation_tolerance=0.1))
    assert loose.success
    error = goal.actInv(chain.placements(loose.q)[0])
    assert (np.abs(error.translation) <= [0.01, 0.02, 0.03]).all()


def test_two_hands_are_placed_at_once() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    for x in chain.box.sample(np.random.default_rng(0), 20):
        left, right = chain.placements(chain.q(x))
        result = mik.solve_ik(chain, [left, right])
        assert result.success
        named = [mik.Target(right, "gripper_right_base_link"), mik.Target(left, "gripper_left_base_link")]
        assert_array_equal(mik.solve_ik(chain, named).q, result.q)


def test_targets_and_frames_must_match() -> None:
    chain = mik.Chain(mik.load_robot("talos").model, ["gripper_left_base_link", "gripper_right_base_link"])
    pose = pin.SE3.Identity()
    with pytest.raises(InvalidTarget, match="one for each"):
        mik.solve_ik(chain, pose)
    with pytest.raises(InvalidTarget, match="give one target a frame"):
        mik.solve_ik(chain, [pose])
    with pytest.raises(FrameNotFound, match="gripper_left_base_link"):
        mik.solve_ik(chain, [mik.Target(pose, "gripper_left"), mik.Target(pose, "gripper_right_base_link")])
    with pytest.raises(FrameNotFound):
        mik.solve_ik(chain_of("ur5"), mik.Target(pose, "gripper"))


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(UnknownName, match="did you mean 'gwo'"):
        mik.IKSolver("gow")
    with pytest.raises(UnknownName, match="dls"):
        mik.IKSolver(refiner="dsl")
    with pytest.raises(InvalidSetting, match="name a seeder"):
        mik.IKSolver(None, None)
    with pytest.raises(InvalidSetting, match="starts"):
        mik.IKSolver(starts=0)
    with pytest.raises(InvalidBudget):
        mik.IKSolver(budget=mik.Budget(target=1e-3))
    with pytest.raises(InvalidConfiguration, match=r"\(6,\)"):
        mik.solve_ik(chain_of("ur5"), [0.3, 0.3, 0.3], np.zeros(7))


def test_time_ends_a_search_and_is_called_stopped() -> None:
    chain, far = behind_its_back()
    body = mik.Chain(mik.load_robot("talos").model, "gripper_left_base_link")  # nine joints: too many for a proof
    rng = np.random.default_rng(0)
    pose = body.placements(body.q(body.box.sample(rng, 40)[0]))[0]
    pose.rotation = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
    for seeder, arm, target in ((None, chain, far), ("gwo", chain, far), ("auto", body, pose)):
        result = mik.solve_ik(arm, target, solver=mik.IKSolver(seeder, "dls", mik.Budget(seconds=0.05)))
        assert result.status is mik.IKStatus.STOPPED
        assert result.seconds < 1.0


def test_the_trace_is_there_when_asked_for() -> None:
    chain = chain_of("ur5")
    goal = [0.3, 0.3, 0.4]
    assert mik.solve_ik(chain, goal).trace is None
    result = mik.solve_ik(chain, goal, solver=mik.IKSolver("gwo", None, mik.Budget(evaluations=3000), trace=True))
    assert result.trace is not None
    assert (np.diff(result.trace[:, 0]) > 0).all()
    assert (np.diff(result.trace[:, 1]) <= 0).all()


def test_a_result_can_verify_itself() -> None:
    chain = chain_of("ur5")
    result = mik.solve_ik(chain, [0.3, 0.3, 0.4])
    assert result.verify()
    assert "SOLVED" in str(result)


def test_a_pose_may_come_as_any_array_of_numbers() -> None:
    chain = chain_of("ur5")
    pose = chain.poses(chain.box.sample(np.random.default_rng(0), 1))[0, 0]
    frozen = pose.copy()
    frozen.flags.writeable = False
    for same in (
        pose.tolist(),
        np.asfortranarray(pose),
        frozen,
        pose.astype(object),
        np.stack([pose, pose], -1)[..., 0],
    ):
        assert_array_equal(mik.solve_ik(chain, same).q, mik.solve_ik(chain, pose).q)
    changed = pose.copy()
    result = mik.solve_ik(chain, changed)
    changed[0, 3] += 1.0
    assert_allclose(result.target.homogeneous, pose, atol=1e-15)
    assert result.verify()
    assert mik.solve_ik(chain, pose.astype(np.float32)).success
    with pytest.raises(InvalidConfiguration, match=r"numbers of shape \(6,\), got 'home'"):
        mik.solve_ik(chain, pose, "home")
