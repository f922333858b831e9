"""Cases: their tasks are what they say, for any arm, and can be done."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.collision import Obstacle, Sphere
from pin_metaik.compare import CASES, METHODS, Answer, Attempt, Case, Suite, Task, compare, replay, write_report
from pin_metaik.compare.cases.case import NoTask
from pin_metaik.compare.cases.jacobians import jacobians
from pin_metaik.compare.folder.store import read_rows
from pin_metaik.compare.methods.peers.peer import Peer
from pin_metaik.errors import InvalidTarget

ROBOTS = ["panda", "ur5", "rv7fl", "kinova", "pr2"]
COUNT = 5
OUT_BY = [  # m
    ("just_out_of_reach", 1e-3, 5e-2),
    ("out_by_0.1mm", 1e-4, 1e-4),
    ("out_by_1mm", 1e-3, 1e-3),
    ("out_by_1cm", 1e-2, 1e-2),
    ("out_by_10cm", 1e-1, 1e-1),
]


def tasks(case: Case, robot: str) -> list[Task]:
    loaded = mik.load_robot(robot)
    chain = case.chain(loaded, np.random.default_rng(7))
    world = None if case.world is None else case.world(loaded)
    return [case.task(chain, world, np.random.default_rng(i)) for i in range(COUNT)]


def attempt(task: Task, X: np.ndarray, status: str = "SOLVED") -> Attempt:
    """What it is to answer with coordinates X (K, n)."""
    start = X[0] if task.start is None else task.start
    answers = [Answer(x, status == "SOLVED", 1, status) for x in X]
    return Attempt(start, answers, [p.verdict(task.chain.q(x)) for p, x in zip(task.problems, X, strict=True)])


def least_singular_value(task: Task) -> float:
    assert task.planted is not None
    columns = [task.chain.model.joints[int(j)].idx_v for j in task.chain.coordinates.joints]
    q, data = task.chain.q(task.planted[0]), task.chain.model.createData()
    J = pin.computeFrameJacobian(task.chain.model, data, q, task.chain.frame_ids[0])[:, columns]
    return float(np.linalg.svd(J, compute_uv=False)[-1])


GOALS = {
    "look_at": ["panda", "ur5", "pr2"],
    "cup_upright": ["panda", "ur5", "pr2"],
    "two_hands": ["pr2", "talos"],
    "whole_body": ["talos", "solo12", "anymal"],
}
ANY_ARM = [
    (name, robot) for name, case in CASES.items() if case.world is None and name not in GOALS for robot in ROBOTS
]


@pytest.mark.parametrize(("name", "robot"), [*ANY_ARM, ("cluttered", "panda"), ("cluttered", "ur5")])
def test_a_task_is_the_same_whenever_it_is_drawn_and_its_own_answer_is_a_success(name: str, robot: str) -> None:
    case = CASES[name]
    for task, again in zip(tasks(case, robot), tasks(case, robot), strict=True):
        assert [pose.homogeneous.tolist() for pose in task.targets] == [p.homogeneous.tolist() for p in again.targets]
        if task.planted is not None:
            assert all(task.chain.limits.contains(x) for x in task.planted)
            assert case.judge(task, attempt(task, task.planted))


@pytest.mark.parametrize("robot", ROBOTS)
def test_half_of_the_joints_are_near_or_exactly_at_a_limit(robot: str) -> None:
    for name, depth in (("near_limit", 0.01), ("at_limits", 0.0)):
        for task in tasks(CASES[name], robot):
            assert task.planted is not None
            chain, x = task.chain, task.planted[0]
            low, high = chain.box.lower, chain.box.upper
            away = np.minimum(x - low, high - x) / (high - low)
            limited = ~chain.limits.periodic
            assert ((away <= depth) & limited).sum() >= min(chain.n // 2, limited.sum())


@pytest.mark.parametrize("robot", [*ROBOTS, "cobra600"])
def test_singular_poses_have_lost_a_direction(robot: str) -> None:
    assert all(least_singular_value(task) < 1e-3 for task in tasks(CASES["singular"], robot))


@pytest.mark.parametrize("robot", ROBOTS)
def test_jacobians_of_many_are_those_of_pinocchio(robot: str) -> None:
    loaded = mik.load_robot(robot)
    chain = mik.Chain(loaded.model, loaded.frame)
    X = chain.box.sample(np.random.default_rng(0), 5)
    columns = [chain.model.joints[int(j)].idx_v for j in chain.coordinates.joints]
    for x, J in zip(X, jacobians(chain, X), strict=True):
        args = (chain.model, chain.data, chain.q(x), chain.frame_ids[0], pin.LOCAL_WORLD_ALIGNED)
        assert_allclose(J, pin.computeFrameJacobian(*args)[:, columns], atol=1e-12)  # rounding of ten products


@pytest.mark.parametrize("robot", ROBOTS)
def test_from_the_boundary_no_joint_takes_the_tip_farther(robot: str) -> None:
    case = CASES["boundary"]
    chain = case.chain(mik.load_robot(robot), np.random.default_rng(7))
    for seed in range(COUNT):
        direction = np.random.default_rng(seed).normal(size=3)
        direction /= np.linalg.norm(direction)
        task = case.draw(chain, np.random.default_rng(seed))
        assert task.planted is not None
        x = task.planted[0]
        moved = [chain.limits.clip(x + step * unit) for unit in np.eye(chain.n) for step in (-0.01, 0.01)]
        far = [float(direction @ chain.placements(chain.q(y))[0].translation) for y in (x, *moved)]
        assert max(far[1:]) <= far[0] + 1e-9  # m; a step of 0.01 rad off the top loses 1e-5 or more


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize(("name", "least", "most"), OUT_BY)
def test_what_is_out_of_reach_is_by_the_length_of_its_case(name: str, least: float, most: float, robot: str) -> None:
    for task in tasks(CASES[name], robot):
        gap = task.chain.reach(0, oriented=True).gap(task.targets[0])
        assert least - 2e-9 < gap <= most  # m; a bound allows 1e-9 for rounding
        assert mik.solve_ik(task.chain, task.targets[0]).status is mik.IKStatus.UNREACHABLE


@pytest.mark.parametrize("robot", [*ROBOTS, "so100"])
def test_what_has_no_solution_is_not_seen_by_the_span_of_the_links_and_not_solved_by_a_long_search(robot: str) -> None:
    for task in tasks(CASES["no_solution"], robot):
        assert task.chain.reach(0, oriented=True).gap(task.targets[0]) == 0.0
        assert mik.solve_ik(task.chain, task.targets[0].translation).success
        long = mik.IKSolver(None, "lm", mik.Budget(evaluations=20_000))
        assert not mik.solve_ik(task.chain, task.targets[0], solver=long).success


def test_of_an_arm_that_meets_every_orientation_there_is_no_task_without_solution(monkeypatch) -> None:
    case = CASES["no_solution"]
    chain = case.chain(mik.load_robot("human"), np.random.default_rng(0))
    monkeypatch.setattr("pin_metaik.compare.cases.no_solution.VAIN", 2)
    with pytest.raises(NoTask, match="proved to have no solution"):
        case.draw(chain, np.random.default_rng(0))


@pytest.mark.parametrize("name", ["no_solution", *(name for name, *_ in OUT_BY)])
def test_where_nothing_meets_the_target_only_a_no_is_a_success(name: str) -> None:
    case = CASES[name]
    for task in tasks(case, "ur5"):
        anywhere = task.chain.box.sample(np.random.default_rng(0), 1)
        assert case.judge(task, attempt(task, anywhere, "UNREACHABLE"))
        assert not case.judge(task, attempt(task, anywhere, "OUT_OF_TOLERANCE"))
        assert not case.judge(task, attempt(task, anywhere, "SOLVED"))


def test_a_solution_farther_than_the_planted_one_is_no_minimal_displacement() -> None:
    case = CASES["minimal_displacement"]
    task = tasks(case, "ur5")[0]
    assert task.planted is not None and task.start is not None
    assert np.abs(task.planted[0] - task.start).max() <= 0.6
    elsewhere = mik.solve_ik_all(task.chain, task.targets[0]).q
    far = max(task.chain.x(elsewhere), key=lambda x: float(np.linalg.norm(x - task.start)))
    assert attempt(task, far[None]).reached
    assert not case.judge(task, attempt(task, far[None]))


def test_five_joints_are_left_of_any_arm() -> None:
    assert [tasks(CASES["five_dof"], robot)[0].chain.n for robot in ROBOTS] == [5] * len(ROBOTS)


def test_a_calibrated_arm_is_off_by_a_millimetre_and_the_robot_is_left_alone() -> None:
    robot = mik.load_robot("ur5")
    before = [placement.homogeneous.copy() for placement in robot.model.jointPlacements]
    chain = CASES["calibrated"].chain(robot, np.random.default_rng(0))
    for placement, was in zip(robot.model.jointPlacements, before, strict=True):
        assert_array_equal(placement.homogeneous, was)
    nominal = mik.Chain(robot.model, robot.frame)
    q = nominal.q(nominal.box.sample(np.random.default_rng(1), 1)[0])
    off = np.linalg.norm(chain.placements(q)[0].translation - nominal.placements(q)[0].translation)
    assert 1e-4 < off < 2e-2  # six joints, up to a metre of arm behind each


def test_a_jump_on_a_path_is_a_failure_and_a_whole_turn_of_a_continuous_joint_is_not() -> None:
    case = CASES["path"]
    task = tasks(case, "kinova")[0]
    assert task.planted is not None
    turned, jumped = task.planted.copy(), task.planted.copy()
    turning = int(np.flatnonzero(task.chain.limits.periodic)[0])
    turned[10:, turning] -= 2.0 * np.pi
    jumped[10] += 0.2
    assert case.judge(task, attempt(task, turned))
    assert not case.judge(task, attempt(task, jumped))
    assert np.abs(task.chain.limits.way(task.planted[:-1], task.planted[1:])).max() <= 0.0501


def test_in_the_shelf_an_answer_that_collides_is_none() -> None:
    task = tasks(CASES["cluttered"], "ur5")[0]
    world = task.world
    assert task.planted is not None and world is not None
    assert not world.checker.collides(task.chain.q(task.planted[0]))
    low, high = np.array([0.5, -0.4, 0.16]), np.array([0.8, 0.4, 0.74])
    assert ((task.targets[0].translation > low) & (task.targets[0].translation < high)).all()
    every = task.chain.x(mik.solve_ik_all(task.chain, task.targets[0]).q)
    judged = [CASES["cluttered"].judge(task, attempt(task, x[None])) for x in every]
    assert judged == [not world.checker.collides(task.chain.q(x)) for x in every]
    assert any(judged) and not all(judged)


def test_a_world_without_room_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = mik.load_robot("ur5")
    walled = mik.CollisionWorld(robot, [Obstacle("all", Sphere(5.0), pin.SE3.Identity())])
    case = replace(CASES["cluttered"], draw=CASES["random"].draw, world=lambda robot: walled)
    monkeypatch.setattr("pin_metaik.compare.cases.case.DRAWS", 20)
    with pytest.raises(NoTask, match="none of 20 tasks is free"):
        case.task(case.chain(robot, np.random.default_rng(0)), walled, np.random.default_rng(0))


@pytest.mark.parametrize(("name", "robot"), [(name, robot) for name, some in GOALS.items() for robot in some])
def test_goals_of_a_case_are_met_by_what_they_were_made_of_and_solved(name: str, robot: str) -> None:
    case = CASES[name]
    for task, again in zip(tasks(case, robot), tasks(case, robot), strict=True):
        assert task.planted is not None and again.planted is not None
        assert_array_equal(task.planted, again.planted)
        assert task.chain.limits.contains(task.planted[0])
        assert case.judge(task, attempt(task, task.planted))
        anywhere = task.chain.box.sample(np.random.default_rng(99), 1)
        assert not case.judge(task, attempt(task, anywhere))
        assert mik.solve_ik(task.chain, task.targets[0]).success


@pytest.mark.parametrize(
    ("name", "robot", "says"),
    [
        ("two_hands", "panda", "no counterpart of 'panda_hand_tcp'"),
        ("whole_body", "ur5", "no two links that are called feet or soles"),
    ],
)
def test_a_robot_without_a_second_hand_or_feet_is_told_so(name: str, robot: str, says: str) -> None:
    assert says in CASES[name].lacks(mik.load_robot(robot), np.random.default_rng(0))


def test_cases_of_goals_are_run_by_metaheuristics_and_by_the_default(tmp_path: Path) -> None:
    methods = ("default", "gwo+dls", "gwo")
    outcome = compare(Suite(("panda", "talos"), tuple(GOALS), methods, tasks=1, budget=1000), tmp_path)
    assert outcome.errors == 0
    done = read_rows(tmp_path)
    pairs = {("panda", "look_at"), ("panda", "cup_upright"), *(("talos", name) for name in GOALS)}
    assert {(row.robot, row.case) for row in done} == pairs
    assert all(row.solved for row in done if row.method == "default")
    assert sum(row.solved for row in done if row.method == "gwo+dls") >= 4  # of 6
    assert "LookAt" in "".join(replay(tmp_path, "panda/look_at/0/gwo/0").lines())
    assert any("look_at" in page.read_text(encoding="utf-8") for page in write_report(tmp_path) if page.suffix == ".md")


def test_a_solver_that_takes_poses_says_so_of_goals() -> None:
    task = tasks(CASES["look_at"], "ur5")[0]
    peer = next(method for method in METHODS.values() if isinstance(method, Peer))
    with pytest.raises(InvalidTarget, match="takes one pose, and no goals of other kinds"):
        peer.solve(task.problems[0], task.chain.x(task.chain.reference), 100, np.random.default_rng(0))
