"""Joints that a chain does not move are where q0 has them: in searches, bounds, batches, paths and worlds alike."""

import pickle
from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pin_metaik as mik
from pin_metaik.errors import InvalidConfiguration

FOLLOWED = """
<robot name="followed"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/><link name="f"/>
<joint name="lift" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
<joint name="turn" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.2 0 0"/><axis xyz="0 0.6 0.8"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="follow" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0.3 0 0"/><axis xyz="1 0 0"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/><mimic joint="lift" multiplier="-2" offset="0.3"/></joint>
<joint name="bend" type="revolute"><parent link="d"/><child link="e"/><origin xyz="0.3 0 0.1"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="roll" type="revolute"><parent link="e"/><child link="f"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>
"""


@cache
def held(name: str) -> mik.Chain:
    """Chains with joints on the way that are held: a torso, a base, one in the middle, a leader with its follower."""
    match name:
        case "torso":
            return mik.Chain(mik.load_robot("tiago").model, "hand_tool_link", locked=["torso_lift_joint"])
        case "base":  # before a closed form
            model = mik.load_robot("ur5", free_flyer=True).model
            return mik.Chain(model, "tool0", locked=["root_joint"])
        case "middle":
            return mik.Chain(mik.load_robot("panda").model, "panda_hand_tcp", locked=["panda_joint3"])
        case "leader":
            return mik.Chain(pin.buildModelFromXML(FOLLOWED, True), "f", locked=["lift"])
        case _:
            hands = ["gripper_left_base_link", "gripper_right_base_link"]
            return mik.Chain(mik.load_robot("talos").model, hands, locked=["torso_1_joint", "torso_2_joint"])


CHAINS = ["torso", "base", "middle", "leader", "hands"]
SINGLE = CHAINS[:-1]


def starts(chain: mik.Chain, count: int, seed: int = 0) -> np.ndarray:
    """Configurations (count, nq), the held joints anywhere inside their limits, a floating base anywhere at all."""
    rng = np.random.default_rng(seed)
    q = np.repeat(chain.reference[None], count, axis=0)
    lower, upper = chain.model.lowerPositionLimit, chain.model.upperPositionLimit
    for e in chain.held:
        bounded = max(-lower[e], upper[e]) < 10.0
        q[:, e] = rng.uniform(lower[e], upper[e], count) if bounded else rng.uniform(-1.0, 1.0, count)
    return chain.q(chain.box.sample(rng, count), np.array([pin.normalize(chain.model, one) for one in q]))


def goals(chain: mik.Chain, bases: np.ndarray, seed: int = 1) -> list[list[pin.SE3]]:
    X = chain.box.sample(np.random.default_rng(seed), len(bases))
    return [chain.placements(chain.q(x, q0)) for x, q0 in zip(X, bases, strict=True)]


def one(goal: list[pin.SE3]) -> pin.SE3 | list[pin.SE3]:
    return goal[0] if len(goal) == 1 else goal


def holds(chain: mik.Chain, q: np.ndarray, q0: np.ndarray) -> bool:
    """Whether all joints that the chain does not move are as they were."""
    return bool((chain.q(chain.x(q), q0) == q).all())


@pytest.mark.parametrize("name", CHAINS)
def test_what_is_reachable_from_where_q0_holds_the_others_is_solved(name: str) -> None:
    chain = held(name)
    bases = starts(chain, 40)
    for q0, goal in zip(bases, goals(chain, bases), strict=True):
        result = mik.solve_ik(chain, one(goal), q0)
        assert result.success
        assert result.verify()
        assert holds(chain, result.q, q0)


@pytest.mark.parametrize("name", CHAINS)
def test_all_that_a_result_tells_is_told_of_that_configuration(name: str) -> None:
    chain = held(name)
    bases = starts(chain, 5)
    for q0, goal in zip(bases, goals(chain, bases), strict=True):
        result = mik.solve_ik(chain, one(goal), q0)
        homogeneous = [pose.homogeneous for pose in goal]
        assert_allclose(result.chain.poses(result.x)[0], homogeneous, atol=2e-5)
        assert result.problem.costs(result.x[None])[0] < 2e-5 * len(goal)
        assert_allclose(result.problem.linearize(result.x)[0], 0.0, atol=2e-5)
        problem = mik.IKProblem.of(chain, one(goal)).at(q0)
        assert problem.gap == 0.0
        assert problem.accepts(result.q)
        again = pickle.loads(pickle.dumps(result.chain))
        assert_array_equal(again.poses(result.x), result.chain.poses(result.x))


@pytest.mark.parametrize("name", SINGLE)
def test_a_batch_may_hold_them_elsewhere_in_every_row(name: str) -> None:
    chain = held(name)
    bases = starts(chain, 60)
    bases[::2, list(chain.held)] = bases[0, list(chain.held)]
    poses = np.array([goal[0].homogeneous for goal in goals(chain, bases)])
    batch = mik.solve_ik_batch(chain, poses, bases, workers=2)
    assert batch.success.all()
    for i, (q0, result) in enumerate(zip(bases, batch, strict=True)):
        assert result.verify()
        assert holds(chain, result.q, q0)
        assert_allclose(result.chain.poses(result.x)[0, 0], poses[i], atol=2e-5)
        assert_array_equal(mik.solve_ik(chain, poses[i], q0).q, result.q)
    positions = mik.solve_ik_batch(chain, poses[:, :3, 3], bases)
    assert positions.success.all()
    assert all(result.verify() for result in positions)


@pytest.mark.parametrize("name", SINGLE)
@pytest.mark.parametrize(
    "solver",
    [
        mik.IKSolver(select="nearest"),
        mik.IKSolver(select="limits"),
        mik.IKSolver(None, "lm_chan"),
        mik.IKSolver("mtde", "dls"),
        mik.IKSolver("de", None, mik.Budget(evaluations=4000)),
    ],
)
def test_every_solver_searches_there(name: str, solver: mik.IKSolver) -> None:
    chain = held(name)
    bases = starts(chain, 3)
    for q0, goal in zip(bases, goals(chain, bases), strict=True):
        for result in (
            mik.solve_ik(chain, goal[0], q0, solver=solver),
            solver.solve(mik.IKProblem.of(chain, goal[0]), q0),
        ):
            assert result.status is not mik.IKStatus.UNREACHABLE
            assert holds(chain, result.q, q0)
            assert result.success or solver.refiner is None
            judged = result.problem.verdict(result.q)
            assert_allclose([judged.position_error, judged.orientation_error],
                            [result.position_error, result.orientation_error], atol=1e-12)  # fmt: skip


@pytest.mark.parametrize("name", SINGLE)
def test_all_solutions_and_branches_are_those_of_there(name: str) -> None:
    chain = held(name)
    bases = starts(chain, 5)
    X = chain.box.sample(np.random.default_rng(1), 5)
    for q0, x, goal in zip(bases, X, goals(chain, bases), strict=True):
        found = mik.solve_ik_all(chain, goal[0], q0)
        assert len(found)
        for q in found:
            assert found.problem.accepts(q)
            assert holds(chain, q, q0)
        if name == "base":
            branches = chain.at(q0).branches(goal[0].homogeneous, x)
            assert np.abs(branches - x).max(axis=1).min() < 1e-6


@pytest.mark.parametrize("name", SINGLE)
def test_a_path_stays_there(name: str) -> None:
    chain = held(name)
    q0 = starts(chain, 1)[0]
    x = 0.5 * (chain.box.lower + chain.box.upper)
    line = [chain.placements(chain.q(x + step, q0))[0] for step in np.linspace(0.0, 0.3, 12)]
    path = mik.solve_ik_path(chain, line, q0)
    assert path.success.all()
    for q, pose in zip(path.q, line, strict=True):
        assert holds(chain, q, q0)
        assert_allclose(chain.placements(q)[0].homogeneous, pose.homogeneous, atol=3e-5)


def test_in_a_world_too() -> None:
    robot = mik.load_robot("panda")
    chain = held("middle")
    world = mik.CollisionWorld(robot)
    for q0, goal in zip(starts(chain, 8), goals(chain, starts(chain, 8)), strict=True):
        result = mik.solve_ik(chain, goal[0], q0, world=world)
        assert result.status in (mik.IKStatus.SOLVED, mik.IKStatus.IN_COLLISION)
        assert result.position_error <= 1e-5
        assert holds(chain, result.q, q0)


def test_out_of_reach_is_judged_by_where_they_are_now() -> None:
    chain = held("base")
    far = chain.reference.copy()
    far[0] = 10.0
    goal = chain.placements(chain.q(np.full(6, 0.5), far))[0]
    assert mik.solve_ik(chain, goal, far).success
    result = mik.solve_ik(chain, goal)
    assert result.status is mik.IKStatus.UNREACHABLE
    assert mik.solve_ik_batch(chain, goal.homogeneous[None], far).success[0]


def test_a_chain_that_holds_nothing_is_itself_everywhere_and_one_that_does_is_kept() -> None:
    model = mik.load_robot("panda").model
    plain = mik.Chain(model, "panda_hand_tcp")
    assert plain.at(np.ones(model.nq)) is plain
    chain = held("middle")
    there, elsewhere = starts(chain, 2)
    assert chain.at(there) is chain.at(there)
    assert chain.at(elsewhere).at(chain.reference) is chain
    assert chain.at(there).at(elsewhere) is chain.at(elsewhere)
    assert mik.solve_ik(plain, [0.4, 0.0, 0.4]).chain is plain


@pytest.mark.parametrize("name", CHAINS)
def test_a_chain_elsewhere_is_the_chain_made_there(name: str) -> None:
    chain = held(name)
    for q0 in starts(chain, 3):
        made = mik.Chain(chain.model, chain.frames, locked=chain._made_from[2], reference=q0)
        X = chain.box.sample(np.random.default_rng(0), 20)
        assert_allclose(chain.at(q0).poses(X), made.poses(X), atol=1e-13)
        for oriented in (True, False):
            a, b = chain.at(q0).reach(0, oriented), made.reach(0, oriented)
            assert_allclose([a.least, a.most], [b.least, b.most], atol=1e-9)
            assert_allclose(a.anchor, b.anchor, atol=1e-9)
        at, there = chain.at(q0).sample_table, made.sample_table
        assert at.scale == pytest.approx(there.scale)
        assert_allclose(np.sort(at.x[:, 0]), np.sort(there.x[:, 0]))


def test_joints_that_are_held_keep_what_q0_says_within_limits_or_not() -> None:
    chain = held("torso")
    q0 = chain.reference.copy()
    q0[chain.held[0]] = 0.6  # above its limit of 0.35 m
    goal = chain.placements(chain.q(np.zeros(chain.n) + chain.box.lower, q0))[0]
    result = mik.solve_ik(chain, goal, q0)
    assert result.success
    assert result.q[chain.held[0]] == 0.6


def test_a_quaternion_that_turns_nothing_is_refused_by_name() -> None:
    chain = held("base")
    with pytest.raises(InvalidConfiguration, match=r"'root_joint'.*length 1.*pin\.normalize"):
        mik.solve_ik(chain, pin.SE3.Identity(), np.zeros(chain.model.nq))


def test_locking_a_joint_that_follows_locks_the_one_it_follows() -> None:
    model = pin.buildModelFromXML(FOLLOWED, True)
    chain = mik.Chain(model, "f", locked=["follow"])
    assert "lift" not in chain.names
    x = chain.box.sample(np.random.default_rng(0), 1)[0]
    assert_allclose(chain.poses(x)[0, 0], chain.placements(chain.q(x))[0].homogeneous, atol=1e-13)


def test_the_reference_is_inside_limits_that_replace_the_models() -> None:
    model = mik.load_robot("ur5").model
    chain = mik.Chain(model, "tool0", limits={"elbow_joint": (0.5, 1.0)})
    assert chain.limits.contains(chain.x(chain.reference))
    with pytest.warns(UserWarning, match="beyond"):
        wide = mik.Chain(model, "tool0", limits={"elbow_joint": (-9.0, 9.0)}, reference=np.array([0, 0, 8.0, 0, 0, 0]))
    assert wide.reference[2] == 8.0
