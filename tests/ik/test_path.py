"""Paths: no joint jumps silently."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from benchmarks.collision_cases import gantry
from benchmarks.collision_truth import Truth
from benchmarks.path_cases import among_balls, without_self_motions
from pin_metaik.collision import Box, Obstacle, load_scene
from pin_metaik.errors import InvalidSetting, InvalidTarget
from pin_metaik.ik import BreakReason
from pin_metaik.planning import installed
from tests.collision.worlds import robot_of
from tests.robots_under_test import chain_of

DOWN = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2)
LINE = [pin.SE3(DOWN, np.array([0.35, y, 0.35])) for y in np.linspace(-0.3, 0.3, 200)]
CIRCLE = [
    pin.SE3(DOWN, np.array([0.45 + 0.12 * np.cos(a), 0.12 * np.sin(a), 0.4])) for a in np.linspace(0, 2 * np.pi, 200)
]


@pytest.mark.parametrize("poses", [LINE, CIRCLE], ids=["line", "circle"])
@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_a_line_and_a_circle_are_followed_without_a_step_above_the_bound(name: str, poses: list[pin.SE3]) -> None:
    chain = chain_of(name)
    path = mik.solve_ik_path(chain, poses, max_step=0.1)
    assert path.continuous
    assert np.abs(np.diff(path.x, axis=0)).max() <= 0.1
    assert path.longest_step == pytest.approx(np.abs(np.diff(path.x, axis=0)).max())
    for q, pose in zip(path.q, poses, strict=True):
        error = pose.actInv(chain.placements(q)[0])
        assert np.linalg.norm(error.translation) <= 1e-5
        assert np.linalg.norm(pin.log3(error.rotation)) <= 1e-5


def test_the_path_begins_near_the_start_when_one_is_given() -> None:
    chain = chain_of("ur5")
    every = mik.solve_ik_all(chain, LINE[0])
    for x in every.x[:4]:
        path = mik.solve_ik_path(chain, LINE[:20], chain.q(x + 0.01), max_step=0.1)
        assert np.abs(path.x[0] - x).max() < 0.1


def test_through_a_wrist_singularity_a_jump_is_reported_or_bridged() -> None:
    chain = chain_of("puma560")
    # The hand keeps its orientation while the forearm comes into line with it: joints 4 and 6 turn half round there.
    goal = chain.placements(chain.q([0.0, 0.5, -2.0, 0.0, 0.0, 0.0]))[0]
    side = np.linspace(-0.1, 0.1, 60)
    poses = [pin.SE3(goal.rotation, goal.translation + np.array([0.0, y, 0.0])) for y in side]
    path = mik.solve_ik_path(chain, poses, max_step=0.15)
    steps = np.abs(np.diff(path.x, axis=0)).max(axis=1)
    assert path.success.all()
    assert (steps <= 0.15).all() or [int(i) + 1 for i in np.flatnonzero(steps > 0.15)] == list(path.breaks)


def test_poses_without_a_solution_are_reported_and_the_rest_is_followed() -> None:
    chain = chain_of("ur5")
    poses = [*LINE[:10], pin.SE3(DOWN, np.array([3.0, 0.0, 0.3])), *LINE[10:20]]
    path = mik.solve_ik_path(chain, poses, max_step=0.1)
    assert not path.continuous
    assert path.success.tolist() == [i != 10 for i in range(21)]
    assert path.breaks == ()  # the joints wait where they were, and go on from there


def test_a_leap_between_poses_is_a_break() -> None:
    chain = chain_of("ur5")
    path = mik.solve_ik_path(chain, [*LINE[:5], *LINE[150:155]], max_step=0.1)
    assert path.breaks == (5,)
    assert path.success.all()
    assert path.longest_step <= 0.1


def test_the_same_path_again() -> None:
    chain = chain_of("panda")
    assert_array_equal(mik.solve_ik_path(chain, LINE[:20]).q, mik.solve_ik_path(chain, LINE[:20]).q)


def test_bad_input() -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidTarget, match="at least one"):
        mik.solve_ik_path(chain, [])
    with pytest.raises(InvalidSetting, match="max_step"):
        mik.solve_ik_path(chain, LINE[:2], max_step=0.0)


def gliding_ball(*obstacles: Obstacle) -> tuple[mik.Chain, mik.CollisionWorld]:
    """Three slides that carry a box of 10 x 10 x 20 cm, among obstacles."""
    robot = gantry("gantry, box")
    return mik.Chain(robot, "tool", locked=["to tool"]), mik.CollisionWorld(robot, obstacles)


def plate(middle: np.ndarray, along: np.ndarray, size: float = 0.12) -> Obstacle:
    """A plate 2 mm thick that stands across a direction."""
    turn = pin.Quaternion.FromTwoVectors(np.array([1.0, 0.0, 0.0]), along / np.linalg.norm(along)).matrix()
    return Obstacle("plate", Box((0.002, size, size)), pin.SE3(turn, middle))


def test_a_plate_between_two_poses_is_never_passed() -> None:
    chain, world = gliding_ball(Obstacle("plate", Box((0.002, 2.0, 2.0)), (0.0, 0.0, 0.0)))
    for y in np.linspace(-0.3, 0.3, 7):
        path = mik.solve_ik_path(chain, [[-0.076, y, 0.0], [0.076, y, 0.0]], world=world)
        assert path.success.all()  # both poses are free
        assert not path
        assert path.breaks == (1,)
        (reason,) = path.reasons
        assert reason.reason is BreakReason.MOVE
        assert reason.contact is not None
        assert {reason.contact.first, reason.contact.second} == {"tool", "plate"}
        assert reason.move is not None
        assert reason.move.q[0] == pytest.approx(-0.051, abs=2e-4)
        assert "to pose 1: the move touches" in path.why


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_no_path_that_is_continuous_collides_between_its_poses(name: str) -> None:
    chain, rng, passed = chain_of(name), np.random.default_rng(2), 0
    robot = robot_of(name)
    for _ in range(8):
        begin = np.array([0.4, 0.0, 0.35]) + rng.uniform(-0.12, 0.12, 3)
        along = rng.normal(size=3)
        along *= 0.05 / np.linalg.norm(along)
        poses = [pin.SE3(DOWN, begin + k * along) for k in range(4)]
        world = mik.CollisionWorld(robot, [plate(begin + 1.5 * along, along, size=rng.choice([0.02, 0.12]))])
        path = mik.solve_ik_path(chain, poses, max_step=0.4, world=world)
        if path:
            passed += 1
            truth = Truth.of(world)
            for q0, q1 in zip(path.q, path.q[1:], strict=False):
                move = world.first_contact(q0, q1)
                assert min(truth.least(move.at(t)) for t in np.linspace(0.0, 1.0, 60)) > 0.0
        else:
            assert all(reason.contact is not None or reason.step for reason in path.reasons)
    assert passed < 8


def test_breaks_say_why() -> None:
    chain = chain_of("ur5")
    far = pin.SE3(DOWN, np.array([3.0, 0.0, 0.3]))
    path = mik.solve_ik_path(chain, [*LINE[:3], far, *LINE[150:152]], max_step=0.1)
    assert [(one.index, one.reason) for one in path.reasons] == [(3, BreakReason.NO_SOLUTION), (4, BreakReason.STEP)]
    assert path.reasons[0].proof is mik.Proof.REACH
    assert path.reasons[1].joint in chain.names
    assert path.reasons[1].step > 0.1
    floor = Obstacle("floor", Box((2.0, 2.0, 0.1)), (0.9, 0.0, 0.3))
    path = mik.solve_ik_path(chain, LINE[:2], world=mik.CollisionWorld(robot_of("ur5"), [floor]))
    assert {one.reason for one in path.reasons} == {BreakReason.IN_COLLISION}
    assert path.reasons[0].contact is not None
    assert path.as_dict()["reasons"][0]["reason"] == "IN_COLLISION"


def test_a_reconfiguration_is_offered_where_the_path_breaks() -> None:
    chain = chain_of("ur5")
    poses = [*LINE[:5], *LINE[150:155]]
    assert not mik.solve_ik_path(chain, poses, max_step=0.1).passable
    path = mik.solve_ik_path(chain, poses, max_step=0.1, reconfigure=True)
    assert not path.continuous
    assert path.passable
    assert_array_equal(path.moves[5], path.q[4:6])
    post = Obstacle("post", Box((0.05, 0.05, 1.0)), (0.35, 0.0, 0.5))
    world = mik.CollisionWorld(robot_of("ur5"), [post])
    path = mik.solve_ik_path(chain, poses, max_step=0.1, world=world, reconfigure=True)
    assert path.success.all()
    assert path.breaks == (5,)
    if path.passable:
        move = path.moves[5]
        assert world.clear_between_batch(move[:-1], move[1:]).all()
        assert_array_equal(move[[0, -1]], path.q[4:6])
    assert path.passable or not installed()


def test_what_tolerances_allow_is_used_where_the_strict_path_breaks() -> None:
    rng, chain = np.random.default_rng(3), chain_of("ur5")
    begin = np.array([0.2, -1.2, 1.4, -1.5, -1.3, 0.4])
    X = begin + np.linspace(0.0, 1.0, 30)[:, None] * np.array([0.3, -0.2, 0.25, 0.1, 0.2, -0.3])
    window = dict(zip(chain.names, zip(X.min(axis=0), X.max(axis=0), strict=True), strict=True))
    narrow = mik.Chain(chain.model, chain.frames[0], limits=window)  # so that a path is there, but hardly another one
    tilts = [0.08 * axis / np.linalg.norm(axis) for axis in rng.normal(size=(30, 3))]
    poses = [
        narrow.placements(narrow.q(x))[0] * pin.SE3(pin.exp3(tilt), np.zeros(3))
        for x, tilt in zip(X, tilts, strict=True)
    ]
    assert not mik.solve_ik_path(narrow, poses, max_step=0.1)
    torch = [mik.Target(pose, orientation_tolerance=np.deg2rad(5.0)) for pose in poses]
    assert mik.solve_ik_path(narrow, torch, max_step=0.1)
    axes = [mik.Target(pose, orientation_tolerance=(np.deg2rad(5.0),) * 3) for pose in poses]
    assert mik.solve_ik_path(narrow, axes, max_step=0.1)


def test_a_path_without_breaks_stays_in_the_middle_of_its_tolerances() -> None:
    chain = chain_of("ur5")
    loose = [mik.Target(pose, orientation_tolerance=0.2, position_tolerance=0.01) for pose in LINE[:20]]
    assert_array_equal(mik.solve_ik_path(chain, loose).q, mik.solve_ik_path(chain, LINE[:20]).q)


@pytest.mark.parametrize("refiner", ["lm", mik.DLS(damping=0.05)])
def test_the_refiner_of_a_solver_finds_the_solutions(refiner: str | mik.DLS) -> None:
    chain = chain_of("ur5")
    path = mik.solve_ik_path(chain, LINE[:6], max_step=0.1, solver=mik.IKSolver(refiner=refiner))
    assert path
    assert path.longest_step <= 0.1


def test_a_solver_searches_where_descents_find_nothing() -> None:
    class Vain:
        """Descends nowhere."""

        def refine(self, problem: mik.IKProblem, starts: np.ndarray, evaluations: int) -> mik.Refinement:
            return mik.Refinement(starts[0], False, 1)

    chain = chain_of("ur5")
    solver = mik.IKSolver("mtde", Vain(), budget=mik.Budget(evaluations=3000))
    loose = [mik.Target(pose, position_tolerance=0.3, orientation_tolerance=1.5) for pose in LINE[:1]]
    path = mik.solve_ik_path(chain, loose, solver=solver)
    assert path.success.all()


def test_a_chain_with_joints_to_spare_uses_them_to_keep_clear() -> None:
    chain, robot = chain_of("panda"), robot_of("panda")
    world = mik.CollisionWorld(robot, load_scene("shelf"))
    forward = pin.rpy.rpyToMatrix(0.0, np.pi / 2, 0.0)
    poses = [pin.SE3(forward, np.array([x, 0.2, 0.5])) for x in np.linspace(0.4, 0.6, 60)]
    path = mik.solve_ik_path(chain, poses, max_step=0.1, world=world)
    assert path
    assert world.clear_between_batch(path.q[:-1], path.q[1:]).all()
    free = [mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf)) for pose in poses]
    assert mik.solve_ik_path(chain, free, max_step=0.1, world=world)


@pytest.mark.parametrize("seed", [1, 3])
def test_where_only_the_middle_of_a_self_motion_is_free_the_path_goes_there(seed: int) -> None:
    chain, robot = chain_of("panda"), robot_of("panda")
    world, poses, known = among_balls(robot, chain, seed)
    assert world.clear_between_batch(known[:-1], known[1:]).all()
    assert not without_self_motions(chain, poses, world, 0.1)
    path = mik.solve_ik_path(chain, poses, max_step=0.1, world=world)
    assert path
    assert world.clear_between_batch(path.q[:-1], path.q[1:]).all()
    ends: list[float] = []
    mik.solve_ik_path(chain, poses, max_step=0.1, world=world, watch=lambda at: ends.append(at.done / at.total))
    assert max(ends) <= 1.0
