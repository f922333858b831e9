"""Wishes: improved in the freedom that the goals leave, never at their cost, and reported."""

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik import goals
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.goals import Wish
from tests.collision.worlds import world_of
from tests.robots_under_test import chain_of


def poses(name: str, count: int) -> list[tuple[np.ndarray, mik.Target]]:
    chain, rng = chain_of(name), np.random.default_rng(7)
    qs = chain.q(chain.box.sample(rng, count))
    return [(q, mik.Target(chain.placements(q)[0])) for q in qs]


WISHES = {
    "centred": lambda chain: goals.MidRange(0),
    "a posture": lambda chain: goals.Posture(chain.reference),
    "manipulable": lambda chain: goals.Manipulability(chain.frames[0], 10.0),
    "an elbow up": lambda chain: goals.OnPlane("panda_link4", (0, 0, 2), "z"),
}


@pytest.mark.parametrize("wish", WISHES)
def test_a_wish_is_nearer_with_than_without_it_and_the_pose_is_met(wish: str) -> None:
    chain = chain_of("panda")
    goal, better = WISHES[wish](chain), []
    for _, pose in poses("panda", 4):
        without = mik.solve_ik(chain, pose)
        result = mik.solve_ik(chain, [pose, Wish(goal)])
        assert result.success
        assert result.verify()
        (outcome,) = result.wishes
        assert outcome.goal is goal
        (before,) = goal.off(goals.Placed(chain, without.q)).values()
        (after,) = outcome.off.values()
        assert after <= before + 1e-6
        better.append(after < before - 1e-3)
        assert result.as_dict()["wishes"] == [outcome.as_dict()]
    assert any(better)


def test_no_step_in_the_freedom_of_the_pose_comes_nearer_to_the_wish() -> None:
    chain = chain_of("panda")
    goal = goals.Posture(chain.reference)
    for _, pose in poses("panda", 4):
        result = mik.solve_ik(chain, [pose, Wish(goal)])
        problem, x = mik.IKProblem.of(chain, pose), result.x
        free = (x > chain.limits.lower + 1e-6) & (x < chain.limits.upper - 1e-6)
        J = problem.linearize(x)[1].T[:, free]
        null = np.linalg.svd(J)[2][6:]
        away = (x - chain.x(chain.reference))[free]
        assert np.abs(null @ away).max(initial=0.0) < 2e-2 * np.linalg.norm(away)


def test_of_the_eight_branches_of_an_arm_a_wish_has_the_nearest() -> None:
    chain = chain_of("ur5")
    for q, pose in poses("ur5", 5):
        result = mik.solve_ik(chain, [pose, Wish(goals.Posture(q))])
        assert result.success
        assert result.wishes[0].off["rad"] < 1e-4


def test_wishes_weigh_against_each_other() -> None:
    chain = chain_of("panda")
    (_, pose), one, other = poses("panda", 1)[0], goals.MidRange(0), goals.Posture(chain.reference)
    offs = []
    for weight in (0.01, 100.0):
        result = mik.solve_ik(chain, [pose, Wish(one), Wish(other, weight)])
        assert result.success
        offs.append(result.wishes[1].off["rad"])
    assert offs[1] < offs[0]


def test_a_wish_alone_and_one_beside_goals_in_python_and_one_that_is_met() -> None:
    chain = chain_of("panda")
    alone = mik.solve_ik(chain, Wish(goals.Posture({"panda_joint4": -1.0})))
    assert alone.success
    assert alone.wishes[0].met
    looking = goals.LookAt("panda_hand_tcp", (0.5, 0.2, 0.1))
    result = mik.solve_ik(chain, [looking, Wish(goals.FramePose.at("panda_hand_tcp", (0.3, 0.0, 0.6)))])
    assert result.success
    assert result.wishes[0].off["m"] < 0.05
    assert mik.IKProblem.of(chain, result.target).asked == tuple(result.target)


def test_in_a_world_a_wish_is_no_reason_to_collide() -> None:
    chain, world = chain_of("panda"), world_of("panda", "shelf")
    for _, pose in poses("panda", 4):
        asked = [mik.Target.at(pose.pose.translation), Wish(goals.MidRange(0))]
        result = mik.solve_ik(chain, asked, world=world)
        assert result.success == (not world.in_collision(result.q) and result.problem.accepts(result.q))
        assert not result.success or result.verify()


def test_a_wish_goes_through_batches_and_choices() -> None:
    chain = chain_of("panda")
    (_, first), (_, second) = poses("panda", 2)
    wish = Wish(goals.MidRange(0))
    batch = mik.solve_ik_batch(chain, [[first, wish], [second, wish]])
    assert batch.success.all()
    alone = [mik.solve_ik(chain, [pose, wish]) for pose in (first, second)]
    assert np.array_equal(batch.q, [one.q for one in alone])
    chosen = mik.solve_ik(chain, [first, wish], solver=mik.IKSolver(select="nearest"))
    assert chosen.success


def test_a_wish_takes_a_refiner() -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidSetting, match="wishes need a refiner"):
        mik.solve_ik(chain, Wish(goals.MidRange(0)), solver=mik.IKSolver("gwo", None))
