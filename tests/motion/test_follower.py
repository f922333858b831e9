"""Followers: limits that hold for every target, targets that are followed, and what is said where they are not."""

from __future__ import annotations

import itertools

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.motion.stops import Stopping

RATE = 500.0
ROUNDING = 1e-9  # rad/s and the like
HOME = {"panda": [0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7, 0.0], "ur5": [0.3, -1.4, 1.7, -1.9, 0.6, 0.4]}


def chain_of(name: str) -> mik.Chain:
    robot = mik.load_robot(name)
    return mik.Chain(robot, robot.frame)


@pytest.fixture(scope="module")
def panda() -> mik.Chain:
    return chain_of("panda")


@pytest.fixture(scope="module")
def ur5() -> mik.Chain:
    return mik.Chain(mik.load_robot("ur5"), "tool0")


def home(chain: mik.Chain) -> NDArray[np.float64]:
    return np.array(HOME["panda" if chain.n == 7 else "ur5"])


def moved(pose: pin.SE3, *by: float) -> pin.SE3:
    return pin.SE3(pose.rotation, pose.translation + np.array(by))


class Watched:
    """A follower, each of whose ticks is held against the limits by differences of configurations."""

    def __init__(self, chain: mik.Chain, limits: mik.MotionLimits, q: NDArray[np.float64], **settings: object) -> None:
        self.follower = mik.Follower(chain, RATE, limits, **settings)  # type: ignore[arg-type]
        self.chain, self.limits, self.q, self.v = chain, limits, q, np.zeros(chain.n)

    def keep(self, step: mik.FollowerStep) -> mik.FollowerStep:
        x, now = self.chain.x(self.q), self.chain.x(step.q)
        v = self.chain.limits.way(x, now) * RATE
        assert (np.abs(v) <= self.limits.velocity + ROUNDING).all()
        assert (np.abs(v - self.v) <= self.limits.acceleration / RATE + ROUNDING).all()
        assert (now >= self.chain.limits.lower).all() and (now <= self.chain.limits.upper).all()
        assert_allclose(v, step.v, atol=ROUNDING)
        self.q, self.v = step.q, step.v
        return step

    def step(self, target: object) -> mik.FollowerStep:
        return self.keep(self.follower.step(target, self.q))  # type: ignore[arg-type]


def limits_for(chain: mik.Chain) -> mik.MotionLimits:
    known = np.isfinite(chain.limits.velocity) & (chain.limits.velocity > 0.0)
    return mik.MotionLimits.of(chain, velocity=np.where(known, chain.limits.velocity, 2.0))


def odd_targets(chain: mik.Chain, rng: np.random.Generator) -> list[object]:
    """Reachable, at the limits, out of reach, positions alone, free axes, slack."""
    box = chain.limits.box()
    at_limits = np.where(rng.random(chain.n) < 0.5, box.lower, box.upper)
    poses = [chain.placements(chain.q(x))[0] for x in (*box.sample(rng, 4), at_limits)]
    far = pin.SE3(poses[0].rotation, 3.0 * poses[0].translation + 1.0)
    free = mik.Target(poses[1], orientation_tolerance=(1e-5, 1e-5, np.inf))
    return [*poses, far, poses[2].translation, free, mik.Target(poses[3], position_tolerance=0.05)]


@pytest.mark.parametrize("name", ["panda", "ur5", "kinova", "cobra600"])
def test_no_limit_is_ever_exceeded_whatever_the_targets(name: str) -> None:
    chain, rng = chain_of(name), np.random.default_rng(0)
    watched = Watched(chain, limits_for(chain), chain.q(chain.limits.box().sample(rng, 1)[0]))
    for held in (1, 3, 150, 1, 40, 200):  # ticks between two jumps
        for target in odd_targets(chain, rng):
            for _ in range(held):
                watched.step(target)
            watched.keep(watched.follower.stop(watched.q))
        for x in chain.limits.box().sample(rng, 2):
            for _ in range(held):
                watched.keep(watched.follower.move(chain.q(x), watched.q))


def test_it_can_stop_before_every_limit_at_any_moment(panda: mik.Chain) -> None:
    rng = np.random.default_rng(1)
    watched = Watched(panda, mik.MotionLimits.of(panda, acceleration=4.0), panda.q(panda.limits.clip(np.zeros(7))))
    beyond = [panda.q(np.where(rng.random(7) < 0.5, panda.limits.lower, panda.limits.upper)) for _ in range(6)]
    for q in beyond:
        for _ in range(int(rng.integers(50, 600))):
            watched.keep(watched.follower.move(q, watched.q))
        while watched.v.any():
            watched.keep(watched.follower.stop(watched.q))


def test_a_measured_configuration_never_breaks_speed_or_acceleration(panda: mik.Chain) -> None:
    rng, limits = np.random.default_rng(2), mik.MotionLimits.of(panda)
    follower, v = mik.Follower(panda, RATE, limits), np.zeros(7)
    goal = panda.placements(home(panda))[0]
    for _ in range(300):
        x = rng.uniform(panda.limits.lower - 0.01, panda.limits.upper + 0.01)
        now = follower.step(goal, panda.q(x)).v
        assert (np.abs(now) <= limits.velocity + ROUNDING).all()
        assert (np.abs(now - v) <= limits.acceleration / RATE + ROUNDING).all()
        v = now


@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_a_circle_is_followed_to_a_micrometre(name: str, panda: mik.Chain, ur5: mik.Chain) -> None:
    chain = {"panda": panda, "ur5": ur5}[name]
    watched = Watched(chain, mik.MotionLimits.of(chain), home(chain))
    start = chain.placements(watched.q)[0]
    missed = []
    for i in range(1500):
        angle = 2.0 * np.pi * i / 1500.0
        target = moved(start, 0.0, 0.1 * np.sin(angle), 0.1 * np.cos(angle) - 0.1)
        step = watched.step(target)
        missed.append(np.linalg.norm(chain.placements(step.q)[0].translation - target.translation))
        assert_allclose(step.position_error, missed[-1], atol=1e-9)
    assert max(missed[200:]) < 1e-6  # once it has caught up with the circle's speed


@pytest.mark.parametrize(("quarter", "least"), [(1, 1e-6), (0, 0.03)], ids=["begun beside it", "begun in it"])
def test_a_circle_through_the_wrists_singularity(ur5: mik.Chain, quarter: int, least: float) -> None:
    """From beside it is crossed as if it were not there; begun in it, the wrist across the way has to turn first."""
    stretched = np.array([0.3, -1.4, 1.7, -1.9, 0.0, 0.4])
    top = ur5.placements(stretched)[0]  # it is singular, as is the lowest point of the circle

    def circle(t: float) -> pin.SE3:
        angle = 0.5 * np.pi * (quarter + 0.5 * t * t if t < 1.0 else quarter + t - 0.5)  # it speeds up for a second
        return moved(top, 0.0, 0.1 * np.sin(angle), -0.1 - 0.1 * np.cos(angle))

    begin = mik.solve_ik(ur5, circle(0.0), np.add(stretched, (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)))
    assert begin
    watched = Watched(ur5, mik.MotionLimits.of(ur5), begin.q)
    steps = [watched.step(circle(i / RATE)) for i in range(2500)]
    assert min(step.q[4] for step in steps) < -0.1 < 0.1 < max(step.q[4] for step in steps)
    missed = np.array([step.position_error for step in steps])
    assert missed.max() < least
    assert missed[1000:].max() < 1e-6
    if quarter == 0:
        assert mik.FollowerStatus.NO_DIRECTION in {step.status for step in steps}


def test_a_target_that_jumps_is_reached_without_overshooting_by_much(panda: mik.Chain) -> None:
    watched = Watched(panda, mik.MotionLimits.of(panda), home(panda))
    start = panda.placements(watched.q)[0]
    target = moved(start, 0.0, 0.4, 0.0)
    steps = list(itertools.islice(iter(lambda: watched.step(target), None), 600))
    assert steps[-1].status is mik.FollowerStatus.ON_TARGET
    assert not watched.v.round(6).any()
    sideways = [panda.placements(step.q)[0].translation[1] - start.translation[1] for step in steps]
    assert max(sideways) < 0.405


@pytest.mark.parametrize("beyond", [0.05, 0.1, 1.0])
def test_at_the_edge_of_the_workspace_it_settles(panda: mik.Chain, beyond: float) -> None:
    q = panda.q([0.0, 0.8, 0.0, -0.6, 0.0, 1.6, 0.7])
    pose = panda.placements(q)[0]
    watched = Watched(panda, mik.MotionLimits.of(panda), q)
    ray = pose.translation - [0.0, 0.0, 0.333]  # from the shoulder
    target = moved(pose, *(0.05 + beyond) * ray / np.linalg.norm(ray))  # the elbow has less than 5 cm to give
    steps = [watched.step(target) for _ in range(2000)]
    late = np.array([step.v for step in steps[-300:]])
    assert np.abs(np.diff(late, axis=0)).max() * RATE < 0.5  # rad/s^2
    assert steps[-1].status is mik.FollowerStatus.NO_DIRECTION and steps[-1].branch_ends


def test_where_a_branch_ends_it_says_which_joints_and_leads_to_another(ur5: mik.Chain) -> None:
    chain = mik.Chain(ur5.model, "tool0", limits={"shoulder_pan_joint": (0.0, 6.0)})
    q = home(chain)
    goal = chain.placements(np.array([-0.4, -1.3, 1.6, -1.8, 0.6, 0.3]))[0]  # -0.4 is not allowed, 5.9 is the same
    watched = Watched(chain, mik.MotionLimits.of(chain), q)
    steps = (watched.step(goal) for _ in range(3000))
    step = next(step for step in steps if step.branch_ends)
    assert step.status is mik.FollowerStatus.AT_LIMITS and step.branch_ends and not step
    assert step.at_limits == ("shoulder_pan_joint",)
    while watched.v.any():
        watched.keep(watched.follower.stop(watched.q))
    other = watched.follower.switch(goal, watched.q)
    assert other is not None
    for _ in range(4000):
        if watched.keep(watched.follower.move(other, watched.q)):
            break
    assert_allclose(watched.q, other, atol=1e-8)
    assert watched.step(goal)


def test_there_is_no_other_branch_for_what_cannot_be_reached(ur5: mik.Chain) -> None:
    assert mik.Follower(ur5).switch([3.0, 0.0, 0.0], home(ur5)) is None


def test_a_posture_is_returned_to_while_the_target_is_held(panda: mik.Chain) -> None:
    begin = home(panda)
    target = panda.placements(begin)[0]
    posture = begin.copy()
    posture[0] += 0.6
    watched = Watched(panda, mik.MotionLimits.of(panda), begin, posture=posture)
    steps = [watched.step(target) for _ in range(2000)]
    assert max(step.position_error for step in steps) < 1e-5
    assert watched.q[0] > 0.1  # the elbow has swung towards it
    still = Watched(panda, mik.MotionLimits.of(panda), begin)
    for _ in range(100):
        still.step(target)
    assert_allclose(still.q, begin, atol=1e-9)


def test_chains_of_several_frames_and_held_joints_are_followed() -> None:
    robot = mik.load_robot("talos")
    chain = mik.Chain(robot, ["gripper_left_base_link", "gripper_right_base_link"], locked=["torso_2_joint"])
    box = chain.limits.box()
    q = chain.q(box.lower + 0.4 * (box.upper - box.lower))  # elbows bent
    q[chain.held[0]] = 0.2
    poses = chain.placements(q)
    watched = Watched(chain, limits_for(chain), q)
    for i in range(400):
        step = watched.step([moved(pose, 0.0, 0.0, 0.02 * np.sin(i / 60.0)) for pose in poses])
    assert step.position_error < 1e-4
    assert step.q[chain.held[0]] == 0.2


def test_the_same_calls_give_the_same_ticks(panda: mik.Chain) -> None:
    target = moved(panda.placements(home(panda))[0], 0.1, 0.2, -0.1)
    first, second = (Watched(panda, mik.MotionLimits.of(panda), home(panda)) for _ in range(2))
    for _ in range(50):
        assert_allclose(first.step(target).q, second.step(target).q, atol=0.0)
    assert first.step(target).as_dict()["status"] == "UNDER_WAY"
    first.follower.reset()
    assert not first.follower.v.any()


def test_braking_motions_are_what_they_are_said_to_be(panda: mik.Chain) -> None:
    rng = np.random.default_rng(3)
    dv, dt = np.full(7, 0.02), 1.0 / RATE
    v = rng.uniform(-2.0, 2.0, 7)
    stopping = Stopping(panda, home(panda), v, dv, dt)
    x, speed, tick = stopping.x.copy(), v.copy(), 0
    while speed.any():
        x = x + dt * speed
        tick += 1
        assert_allclose(stopping.at(tick), x, atol=1e-12)
        speed = np.sign(speed) * np.maximum(np.abs(speed) - dv, 0.0)
    assert stopping.ticks >= tick
    assert_allclose(stopping.at(np.inf), x, atol=1e-12)


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"rate": 0.0}, "rate"),
        ({"clearance": -1.0}, "clearance"),
        ({"limits": mik.MotionLimits(np.ones(2), np.ones(2))}, "2 joints, the chain has 7"),
        ({"posture": [0.0]}, "expected shape"),
    ],
)
def test_what_makes_no_sense_is_refused(panda: mik.Chain, settings: dict[str, object], says: str) -> None:
    with pytest.raises(mik.MetaIKError, match=says):
        mik.Follower(panda, **settings)  # type: ignore[arg-type]


def test_a_joint_without_a_speed_limit_is_named() -> None:
    model = mik.load_robot("panda").model.copy()
    model.upperVelocityLimit[2] = np.inf
    chain = mik.Chain(model, "panda_hand")
    with pytest.raises(mik.MetaIKError, match="'panda_joint3' has a velocity limit of inf"):
        mik.Follower(chain)
    assert mik.MotionLimits.of(chain, velocity=1.5).velocity.tolist() == [1.5] * 7
