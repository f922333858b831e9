"""Goals compose: one of your own is a class with a residual and a test, and everything else follows."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.errors import FrameNotFound, InvalidTarget
from pin_metaik.ik.goals import Placed
from tests.collision.worlds import world_of
from tests.robots_under_test import chain_of

STEP = 1e-6


@dataclass(frozen=True)
class Height:
    """A frame is between two heights: a goal of one's own in one place, without registration."""

    frame: str
    least: float
    most: float

    def residual(self, at: Placed) -> np.ndarray:
        z = at.pose(self.frame).translation[2]
        return np.array([max(z - self.most, 0.0) + min(z - self.least, 0.0)])

    def met(self, at: Placed) -> bool:
        return self.least - 1e-6 <= at.pose(self.frame).translation[2] <= self.most + 1e-6


@dataclass(frozen=True)
class Steered(Height):
    """The same with its derivative, which wrong answers in ``calls`` would show."""

    def jacobian(self, at: Placed) -> np.ndarray:
        h = STEP * np.eye(at.chain.n)
        rows = [self.residual(Placed(at.chain, at.chain.q(at.x + d))) for d in h]
        return (np.array(rows) - self.residual(at)).T / STEP


def elbow_and_tip(seed: int) -> tuple[float, pin.SE3]:
    chain = chain_of("panda")
    q = chain.q(chain.box.sample(np.random.default_rng(seed), 1)[0])
    at = Placed(chain, q)
    return float(at.pose("panda_link4").translation[2]), chain.placements(q)[0]


@pytest.mark.parametrize("kind", [Height, Steered])
def test_a_pose_with_a_goal_of_ones_own_is_solved_and_judged_by_pinocchio(kind) -> None:
    chain, solved = chain_of("panda"), 0
    for seed in range(12):
        height, pose = elbow_and_tip(seed)
        goal = kind("panda_link4", height - 0.01, height + 0.01)
        result = mik.solve_ik(chain, [pose, goal])
        solved += result.success
        assert result.verify() == result.success
        if result.success:
            at = Placed(chain, result.q)
            assert height - 0.011 <= at.pose("panda_link4").translation[2] <= height + 0.011
            assert np.linalg.norm(pin.log6(pose.actInv(chain.placements(result.q)[0])).vector) < 1e-4
    assert solved == 12


def test_a_goal_may_be_all_that_is_asked() -> None:
    chain = chain_of("ur5")
    goal = Height("wrist_1_link", 0.5, 0.51)
    for solver in (mik.IKSolver(), mik.IKSolver(refiner="qp"), mik.IKSolver(refiner="sdls"), mik.IKSolver("gwo")):
        result = mik.solve_ik(chain, goal, solver=solver)
        assert result.success
        assert 0.5 - 1e-6 <= Placed(chain, result.q).pose("wrist_1_link").translation[2] <= 0.51 + 1e-6


def test_goals_go_wherever_targets_go() -> None:
    chain, world = chain_of("panda"), world_of("panda", "shelf")
    height, pose = elbow_and_tip(3)
    asked = [pose, Height("panda_link4", height - 0.02, height + 0.02)]
    problem = mik.IKProblem.of(chain, asked)
    assert mik.solve_ik_batch(chain, [asked, asked]).success.all()
    everything = mik.solve_ik_all(chain, asked, limit=5)
    assert len(everything) >= 1
    assert everything.complete is None
    assert all(problem.accepts(q) for q in everything.q)
    chosen = mik.solve_ik(chain, asked, solver=mik.IKSolver(select="limits"))
    assert chosen.success
    result = mik.solve_ik(chain, asked, world=world)
    assert result.success == (not world.in_collision(result.q) and problem.accepts(result.q))
    path = mik.solve_ik_path(chain, [asked, asked])
    assert path.success.all()


def test_a_second_target_of_a_frame_is_a_goal_more() -> None:
    chain = chain_of("panda")
    _, pose = elbow_and_tip(5)
    asked = [mik.Target.at(pose.translation), mik.Target.facing(pose.rotation, tolerance=0.05)]
    result = mik.solve_ik(chain, asked)
    assert result.success
    (tip,) = chain.placements(result.q)
    assert np.linalg.norm(tip.translation - pose.translation) < 1e-5
    assert np.linalg.norm(pin.log3(pose.rotation.T @ tip.rotation)) < 0.05
    assert mik.IKProblem.of(chain, result.target).asked == tuple(result.target)


@pytest.mark.parametrize("tolerances", [(1e-5, 1e-5), ((0.02, np.inf, 0.01), 0.1), (0.03, (0.1, 0.2, np.inf))])
def test_a_target_in_python_is_the_target_of_the_compiled_loops(tolerances) -> None:
    chain, rng = chain_of("panda"), np.random.default_rng(2)
    pose = chain.placements(chain.q(chain.box.sample(rng, 1)[0]))[0]
    target = mik.Target(pose, None, *tolerances, position_weight=2.0, orientation_weight=0.5)
    middle = mik.IKProblem.of(chain, target)
    problem = middle.whole if middle.loose else middle
    for x in chain.box.sample(rng, 20):
        at = Placed(chain, chain.q(x))
        rows = target.residual(at)[[axis for _, axis in problem.rows]]
        assert_allclose(rows, problem.linearize(x)[0], atol=1e-9)
        assert target.met(at) == problem.accepts(at.q)


def test_the_residual_of_goals_is_stacked_with_its_derivative() -> None:
    chain = chain_of("panda")
    _, pose = elbow_and_tip(1)
    asked = [pose, Height("panda_link4", 0.0, 0.01), Steered("panda_link6", 0.0, 0.01)]
    problem, x = mik.IKProblem.of(chain, asked), chain.box.sample(np.random.default_rng(0), 1)[0]
    r, J = problem.linearize(x)
    assert r.shape == (8,)
    assert J.shape == (7, 8)
    for c, h in enumerate(STEP * np.eye(7)):
        slope = (problem.linearize(x + h)[0] - problem.linearize(x - h)[0]) / (2.0 * STEP)
        assert_allclose(J[c, 6:], slope[6:], atol=1e-5)
    assert problem.costs(x[None])[0] == pytest.approx(np.linalg.norm(r[:3]) + np.linalg.norm(r[3:6]) + r[6:].sum())


class Odd:
    """A goal that gives something odd."""

    def __init__(self, residual: object) -> None:
        self.given = residual

    def residual(self, at: Placed) -> object:
        return self.given

    def met(self, at: Placed) -> bool:
        return False


@pytest.mark.parametrize("given", [[np.nan], 1.0, "far", None, [[1.0]]])
def test_a_goal_that_gives_no_numbers_is_named(given: object) -> None:
    with pytest.raises(InvalidTarget, match=r"residual of .* must be \(m,\) finite numbers"):
        mik.solve_ik(chain_of("ur5"), Odd(given))
    with pytest.raises(FrameNotFound):
        mik.solve_ik(chain_of("ur5"), Height("hat", 0.0, 1.0))


def test_a_goal_that_is_never_met_is_no_success_and_keeps_the_budget() -> None:
    solver = mik.IKSolver(budget=mik.Budget(evaluations=300))
    result = mik.solve_ik(chain_of("ur5"), Odd([1.0]), solver=solver)
    assert result.status is mik.IKStatus.OUT_OF_TOLERANCE
    assert result.evaluations <= 300


def test_each_goal_of_the_registry_has_a_file_of_its_own() -> None:
    folder = Path(mik.goals.__file__).parent
    for name, goal in mik.goals.GOALS.items():
        assert goal.__module__ == f"pin_metaik.ik.goals.{name}"
        assert (folder / f"{name}.py").exists()
        assert issubclass(goal, mik.goals.Goal)
