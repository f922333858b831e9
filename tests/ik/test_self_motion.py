"""Self-motions: curves of solutions, from limit to limit or closed, and the best points on them."""

from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from pin_metaik.errors import InvalidBudget, InvalidConfiguration, InvalidSetting, UnknownName
from pin_metaik.ik.self_motion import EndReason
from pin_metaik.kinematics.self_motion.near import mark_crossed
from tests.robots_under_test import chain_of


@cache
def motions_of(name: str, seed: int) -> tuple[np.ndarray, mik.SelfMotions]:
    """A pose that is drawn, and the self-motions for it."""
    chain = chain_of(name)
    pose = chain.poses(chain.box.sample(np.random.default_rng(seed), 1))[0, 0]
    return pose, mik.self_motions(chain, pose)


@pytest.mark.parametrize(("name", "seed"), [("panda", 7), ("xarm7", 7)])
def test_all_points_are_solutions_and_every_solution_is_on_a_curve(name: str, seed: int) -> None:
    chain = chain_of(name)
    pose, motions = motions_of(name, seed)
    assert motions.complete is mik.Proof.BOXES
    for curve in motions:
        for q in curve.sample(0.2):
            error = pin.SE3(pose).actInv(chain.placements(q)[0])
            assert np.linalg.norm(error.translation) < 1e-9
            assert np.linalg.norm(pin.log3(error.rotation)) < 1e-9
            assert chain.limits.contains(chain.x(q))
    for start in chain.box.sample(np.random.default_rng(seed), 25):
        result = mik.solve_ik(chain, pose, chain.q(start))
        assert result.success
        assert motions.nearest(result.q).value < 1e-3


@pytest.mark.parametrize("bend", [0.0, 1e-4, 1e-2])
def test_curves_through_a_shoulder_that_is_nearly_straight_are_found(bend: float) -> None:
    """There its first and third joint turn against each other while the others hardly move."""
    chain, proved = chain_of("panda"), 0
    for x in chain.box.sample(np.random.default_rng(5), 6):
        x[1] = bend
        motions = mik.self_motions(chain, chain.poses(x)[0, 0])
        assert motions.nearest(chain.q(x)).value < 1e-3
        proved += motions.complete is mik.Proof.BOXES
    assert proved >= 5


@pytest.mark.parametrize("bend", [3e-2, 1e-2, 1e-3, 3.5e-4, 1e-4])
def test_two_curves_that_are_very_near_to_each_other_are_told_apart(bend: float) -> None:
    """An elbow that is nearly stretched may bend to either side, and the other joints hardly tell."""
    chain = mik.Chain(arm_with_an_elbow(), "tip")
    for x in chain.box.sample(np.random.default_rng(1), 4):
        x[3] = bend
        pose = chain.poses(x)[0, 0]
        motions = mik.self_motions(chain, pose)
        for side in (1.0, -1.0):
            bent = x.copy()
            bent[3] = side * bend
            for _ in range(20):  # Newton's method; the elbow stays on its side
                error, J = mik.IKProblem.of(chain, pose).exact.linearize(bent)
                bent -= np.linalg.pinv(J.T, rcond=1e-9) @ error
            assert side * bent[3] > 0.5 * bend
            assert np.linalg.norm(error) < 1e-12
            assert all((np.diff(curve.t) > 0.0).all() for curve in motions)
            if chain.limits.contains(bent):
                assert motions.nearest(chain.q(bent)).value < 1e-4


def test_a_curve_goes_through_boxes_around_it_and_not_through_those_beside_it() -> None:
    chain = chain_of("panda")
    motions = mik.self_motions(chain, chain.poses(chain.box.sample(np.random.default_rng(2), 1)[0])[0, 0])
    curve = max(motions, key=lambda one: one.length)
    x = chain.x(curve.sample(0.013))
    tangents = np.gradient(x, axis=0)
    across = np.cross(tangents[:, :3], [0.3, -0.5, 0.8])
    across /= np.abs(across).max(axis=1, keepdims=True)
    width = np.full_like(x, 1e-9)
    beside = x.copy()
    beside[:, :3] += 1e-3 * across
    for centre, expected in (x, 1), (beside, 0):
        crossed = np.zeros(len(x), np.int64)
        boxes = np.concatenate([centre, width], axis=1)
        mark_crossed(boxes, curve.x, curve._tangents, np.zeros(7, np.int64), 1e-4, crossed)
        assert (crossed[3:-3] == expected).all()


def arm_with_an_elbow() -> pin.Model:
    """Three joints that meet, an elbow, and three that meet: seven in all, as of a KUKA LBR iiwa."""
    model, parent = pin.Model(), 0
    for i, (height, limit) in enumerate(zip((0.34, 0, 0.4, 0, 0.4, 0, 0), (2.9, 2.0) * 3 + (3.0,), strict=True)):
        joint, up = (pin.JointModelRY() if i % 2 else pin.JointModelRZ()), pin.SE3(np.eye(3), np.array([0, 0, height]))
        effort, speed = np.ones(1), np.ones(1)
        parent = model.addJoint(parent, joint, up, f"j{i + 1}", effort, speed, -np.full(1, limit), np.full(1, limit))
    model.addFrame(pin.Frame("tip", parent, pin.SE3(np.eye(3), np.array([0, 0, 0.126])), pin.FrameType.OP_FRAME))
    return model


def test_a_curve_ends_where_a_joint_meets_its_limit_or_where_it_began() -> None:
    chain = chain_of("xarm7")
    _, motions = motions_of("xarm7", 7)
    assert {curve.closed for curve in motions} == {True, False}
    for curve in motions:
        first, last = curve.q(0.0), curve.q(curve.length)
        if curve.closed:
            assert {end.reason for end in curve.ends} == {EndReason.CLOSED}
            placed = [chain.placements(q)[0].homogeneous for q in (first, last)]
            assert_allclose(placed[0], placed[1], atol=1e-9)
            assert_allclose(curve.q(curve.length + 0.3), curve.q(0.3), atol=1e-9)
            continue
        for end, q in zip(curve.ends, (first, last), strict=True):
            assert end.reason is EndReason.LIMIT
            c = chain.names.index(str(end.joint))
            limit = (chain.limits.upper if end.upper else chain.limits.lower)[c]
            assert_allclose(chain.x(q)[c], limit, atol=1e-9)
            assert str(end) == f"{end.joint} at its {'upper' if end.upper else 'lower'} limit"


def test_t_is_how_far_the_joints_move() -> None:
    chain = chain_of("panda")
    _, motions = motions_of("panda", 7)
    curve = motions.curves[0]
    x = chain.x(curve.q(np.linspace(0.0, curve.length, 4001)))
    assert_allclose(np.linalg.norm(np.diff(x, axis=0), axis=1).sum(), curve.length, rtol=1e-3)
    q = curve.sample(0.1)
    assert np.linalg.norm(np.diff(chain.x(q), axis=0), axis=1).max() < 0.1001
    assert curve.q([[0.1, 0.2]]).shape == (1, 2, chain.model.nq)


def test_the_best_point_is_better_than_any_that_is_sampled() -> None:
    chain = chain_of("panda")
    pose, motions = motions_of("panda", 7)
    rng = np.random.default_rng(0)
    q0 = chain.q(chain.box.sample(rng, 1)[0])
    motions = mik.self_motions(chain, pose, q0)
    every = np.concatenate([curve.sample(0.02) for curve in motions])
    away = np.linalg.norm(chain.x(every) - chain.x(q0), axis=1)
    assert motions.nearest(q0).value <= away.min() + 1e-4
    assert motions.best("nearest").value == motions.nearest(q0).value
    crowded = np.abs(
        (2 * chain.x(every) - chain.limits.lower - chain.limits.upper)
        / np.ptp([chain.limits.lower, chain.limits.upper], axis=0)
    ).max(axis=1)
    assert motions.best("limits").value <= crowded.min() + 1e-4

    def highest(q: np.ndarray) -> float:
        return -float(q[1])

    best = motions.best(highest)
    assert best.value == highest(best.q) <= min(map(highest, every)) + 1e-6
    torque = mik.gravity_torque(chain)
    assert motions.best("torque").value <= min(map(torque, every)) + 1e-4


def test_the_nearest_point_is_found_where_limits_exclude_copies_by_whole_turns() -> None:
    """Limits of 2 pi either way: along a curve an angle jumps from one copy to another, and with it the distance."""
    chain, rng, jumps = chain_of("xarm7"), np.random.default_rng(8), 0
    for x in chain.box.sample(rng, 6):
        q0 = chain.q(chain.box.sample(rng, 1)[0])
        motions = mik.self_motions(chain, chain.poses(x)[0, 0], q0)
        for curve in motions:
            every = chain.x(curve.sample(0.002))
            jumps += int((np.abs(np.diff(every, axis=0)) > 6.0).any(axis=1).sum())
            away = np.linalg.norm(every - chain.x(q0), axis=1)
            assert curve.nearest(q0).value <= away.min() + 1e-4
            crowded = np.abs(2 * every - chain.limits.lower - chain.limits.upper) / np.ptp(
                [chain.limits.lower, chain.limits.upper], axis=0
            )
            assert curve.best("limits").value <= crowded.max(axis=1).min() + 1e-4
    assert jumps > 10


@pytest.mark.parametrize("room", [1e-6, 0.0])
def test_the_best_point_is_found_in_a_second_where_a_joint_has_hardly_any_room(room: float) -> None:
    """The elbow's value is that of all points, so that nothing can be ruled out by how much it might change."""
    whole, best = arm_with_an_elbow(), []
    x = mik.Chain(whole, "tip").box.sample(np.random.default_rng(1), 1)[0]
    x[3] = 0.8
    for more in 0.1, room:
        chain = mik.Chain(whole, "tip", limits={"j4": (0.8 - more, 0.8 + more)})
        best.append(mik.self_motions(chain, chain.poses(x)[0, 0]).best("limits"))
    assert best[1].value == pytest.approx(best[0].value, abs=1e-3)


def test_select_takes_the_best_of_all_solutions_of_a_redundant_arm() -> None:
    chain = chain_of("panda")
    rng = np.random.default_rng(3)
    for x, x0 in zip(chain.box.sample(rng, 4), chain.box.sample(rng, 4), strict=True):
        pose, q0 = chain.poses(x)[0, 0], chain.q(x0)
        result = mik.solve_ik(chain, pose, q0, solver=mik.IKSolver(select="nearest"))
        assert result.success
        assert_allclose(np.linalg.norm(result.x - x0), mik.self_motions(chain, pose, q0).nearest(q0).value, atol=1e-4)


def test_a_pose_with_a_free_turn_leaves_an_arm_of_six_joints_its_curves() -> None:
    chain = chain_of("ur5")
    pose = chain.poses(np.array([[0.3, -1.2, 1.4, -0.9, -1.5, 0.6]]))[0, 0]
    every = mik.solve_ik_all(chain, mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf)))
    assert len(every.curves) == 8  # the last joint turns the tip about the axis that is free
    for curve in every.curves:
        assert curve.closed
        assert_allclose(curve.length, 2.0 * np.pi, atol=1e-6)
    assert mik.solve_ik_all(chain, pose).curves == ()


def test_obstacles_leave_free_intervals() -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    pose = chain.poses(np.array([[0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3]]))[0, 0]
    curve = mik.self_motions(chain, pose).curves[0]
    world = mik.CollisionWorld(robot)
    elbow = chain.model.getJointId("panda_joint4")
    pin.forwardKinematics(chain.model, chain.data, curve.q(0.5 * curve.length))
    world.add(mik.collision.Obstacle("ball", mik.collision.Sphere(0.05), chain.data.oMi[elbow].translation))
    intervals = curve.free(world, 0.1)
    assert intervals
    assert sum(b - a for a, b in intervals) < curve.length
    assert not any(a <= 0.5 * curve.length <= b for a, b in intervals)
    for a, b in intervals:
        for t in np.linspace(a, b, 9):
            assert not world.checker.collides(curve.q(t))
        for outside in (a - 1e-3, b + 1e-3):
            assert not 0.0 < outside < curve.length or world.checker.collides(curve.q(outside))


def test_gravity_torque_is_what_the_potential_energy_changes_by() -> None:
    chain = chain_of("panda")
    q = chain.q(np.array([0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3]))
    mass, at = 2.0, np.array([0.02, -0.03, 0.1])

    def energy(x: np.ndarray) -> float:
        height = mass * chain.placements(chain.q(x))[0].act(at)[2]
        bodies = zip(chain.data.oMi, chain.model.inertias, strict=True)
        return 9.81 * float(height + sum(body.mass * place.act(body.lever)[2] for place, body in bodies))

    x = chain.x(q)
    slopes = [(energy(x + d) - energy(x - d)) / 2e-5 for d in 1e-5 * np.eye(7)]
    assert_allclose(mik.gravity_torque(chain, mass, at)(q), np.linalg.norm(slopes), rtol=1e-6)
    with pytest.raises(InvalidSetting, match="payload"):
        mik.gravity_torque(chain, -1.0)
    with pytest.raises(InvalidSetting, match="no mass"):
        mik.gravity_torque(weightless())


def weightless() -> mik.Chain:
    model = pin.Model()
    span = np.array([1.0])
    joint = model.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "hinge", span, span, -span, span)
    model.addFrame(pin.Frame("tip", joint, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    return mik.Chain(model, "tip")


def test_a_watch_ends_the_search_and_keeps_what_was_found() -> None:
    chain = chain_of("panda")
    pose, _ = motions_of("panda", 7)
    stopped = mik.self_motions(chain, pose, watch=lambda at: True)
    assert stopped.interrupted
    assert stopped.complete is None
    assert np.isfinite(stopped.nearest(chain.reference).value)


def test_a_pose_out_of_reach_has_no_curves_and_that_is_proved() -> None:
    chain = chain_of("panda")
    none = mik.self_motions(chain, pin.SE3(np.eye(3), np.array([2.0, 0.0, 0.0])))
    assert none.complete is mik.Proof.BOXES and not len(none)
    with pytest.raises(InvalidSetting, match="no self-motion"):
        none.nearest(chain.reference)


def test_what_has_no_curves_is_said_with_what_helps() -> None:
    ur5, panda = chain_of("ur5"), chain_of("panda")
    pose, motions = motions_of("panda", 7)
    with pytest.raises(InvalidSetting, match="solve_ik_all"):
        mik.self_motions(ur5, ur5.poses(np.zeros((1, 6)))[0, 0])
    with pytest.raises(InvalidSetting, match="4 are"):
        mik.self_motions(panda, pose[:3, 3])
    with pytest.raises(InvalidSetting, match="resolution"):
        mik.self_motions(panda, pose, resolution=0.0)
    with pytest.raises(InvalidBudget, match="evaluations"):
        mik.self_motions(panda, pose, budget=mik.Budget(seconds=1.0))
    curve = motions.curves[0]
    with pytest.raises(InvalidSetting, match="t"):
        curve.q(np.nan)
    with pytest.raises(InvalidSetting, match="step"):
        curve.sample(-1.0)
    with pytest.raises(InvalidConfiguration):
        curve.nearest([0.0])
    with pytest.raises(UnknownName, match="nearest"):
        curve.best("nearst")
