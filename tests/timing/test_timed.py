"""Timed paths: limits held by a check of one's own, times as short as toppra's, and files that others read."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik import timing
from pin_metaik.timing.curve import JointCurve, roots

EXACT = 1e-9
HARD = (15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0)  # rad/s^2, of panda's data sheet
HOME = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7, 0.0])


@pytest.fixture(scope="module")
def panda() -> mik.Chain:
    robot = mik.load_robot("panda")
    return mik.Chain(robot, robot.frame)


@pytest.fixture(scope="module")
def line(panda: mik.Chain) -> mik.IKPath:
    """The hand on a straight line of 0.5 m, in 60 poses."""
    start = panda.placements(HOME)[0]
    poses = [moved(start, 0.0, y, 0.0) for y in np.linspace(0.0, 0.5, 60)]
    return mik.solve_ik_path(panda, poses, HOME)


def moved(pose: pin.SE3, *by: float) -> pin.SE3:
    return pin.SE3(pose.rotation, pose.translation + by)


def held(timed: mik.TimedPath, every: float = 1e-3) -> timing.TimedSamples:
    """Samples that keep all limits, as do differences of their positions alone; and begin and end at rest."""
    one, limits, chain = timed.sample(every), timed.limits, timed.chain
    assert (np.abs(one.v) <= limits.velocity + EXACT).all()
    assert (np.abs(one.a) <= limits.acceleration + EXACT).all()
    assert (one.x >= chain.limits.lower - EXACT).all() and (one.x <= chain.limits.upper + EXACT).all()
    rounding = 1e-15
    even = one.x[:-1]  # the last step is shorter
    for order, limit in ((1, limits.velocity), (2, limits.acceleration), (3, limits.jerk)):
        if limit is not None:
            differences = np.abs(np.diff(even, order, axis=0)) / every**order
            assert (differences <= limit + 2.0**order * rounding * 4.0 / every**order + EXACT).all()
    assert_allclose(one.v[[0, -1]], 0.0, atol=EXACT)
    assert_allclose(one.q, chain.q(one.x, timed.base), atol=0.0)
    assert one.t[-1] == timed.duration
    return one


def toppras(timed: mik.TimedPath) -> float:
    """The duration that toppra has for the same spline, left to itself."""
    from toppra import SplineInterpolator
    from toppra.algorithm import TOPPRA
    from toppra.constraint import JointAccelerationConstraint, JointVelocityConstraint

    knots, limits = timed.curve.knots, timed.limits
    constraints = [
        JointVelocityConstraint(np.column_stack([-limits.velocity, limits.velocity])),
        JointAccelerationConstraint(np.column_stack([-limits.acceleration, limits.acceleration])),
    ]
    spline = SplineInterpolator(knots, timed.curve(knots))
    return float(TOPPRA(constraints, spline, parametrizer="ParametrizeConstAccel").compute_trajectory(0, 0).duration)


def test_a_straight_line_keeps_its_limits_and_is_as_quick_as_toppras(line: mik.IKPath) -> None:
    timed = line.timed(acceleration=HARD)
    one = held(timed)
    assert_allclose(timed.duration, toppras(timed), rtol=0.01)
    shares = np.maximum(np.abs(one.v) / timed.limits.velocity, np.abs(one.a) / timed.limits.acceleration)
    assert np.median(shares.max(axis=1)) > 0.999  # some joint is at a limit
    straight = line.chain.poses(one.x)[:, 0, :3, 3]
    assert_allclose(one.tip_speed[:, 0], np.linalg.norm(np.gradient(straight, one.t, axis=0), axis=1), atol=5e-3)
    assert_allclose(one.tip_speed.mean() * timed.duration, 0.5, rtol=0.01)
    assert_allclose(straight[:, 2], straight[0, 2], atol=1e-4)  # between the poses, too


@pytest.mark.parametrize("seed", range(4))
def test_random_configurations_keep_their_limits(panda: mik.Chain, seed: int) -> None:
    rng = np.random.default_rng(seed)
    middle, half = 0.5 * (panda.limits.lower + panda.limits.upper), 0.5 * (panda.limits.upper - panda.limits.lower)
    q = panda.q(middle + half * rng.uniform(-0.4, 0.4, (6, 7)))
    timed = timing.time_path(panda, q, acceleration=HARD)
    one = held(timed)
    assert_allclose(timed.duration, toppras(timed), rtol=0.01)
    ways = np.abs(one.q[:, None, :7] - q[None, :, :7]).max(axis=2).min(axis=0)
    assert ways.max() < 2e-3  # it comes by all of them
    jerky = timing.time_path(panda, q, acceleration=HARD, jerk=3000.0)
    held(jerky)
    assert jerky.duration > timed.duration


def test_joints_at_their_limits_stay_inside_between_the_poses(panda: mik.Chain) -> None:
    low, high = panda.limits.lower, panda.limits.upper
    q = panda.q(np.array([low, low, high, 0.5 * (low + high), high]))
    timed = timing.time_path(panda, q)
    assert timed.curve.bent
    held(timed)
    with pytest.raises(mik.MetaIKError, match="leave its limits on a smooth curve"):
        timing.time_path(panda, q, jerk=100.0)


def test_a_limit_of_jerk_is_kept_and_used(line: mik.IKPath) -> None:
    timed = line.timed(acceleration=HARD, jerk=2000.0)
    one = held(timed)
    jerk = np.abs(np.diff(one.a[:-1], axis=0)) / 1e-3
    assert 1000.0 < jerk.max() <= 2000.0 + 1e-6
    assert timed.duration > line.timed(acceleration=HARD).duration
    assert line.timed(acceleration=HARD, jerk=1e6).duration < timed.duration


def test_continuous_joints_go_the_shorter_way_and_run_on() -> None:
    robot = mik.load_robot("kinova")
    chain = mik.Chain(robot, robot.frame)
    assert chain.limits.periodic.any()
    x = np.full((4, chain.n), 2.0)
    x[:, chain.limits.periodic] += np.array([0.0, 1.0, 2.0, 3.0])[:, None]  # beyond pi, where q has only the angle
    timed = timing.time_path(chain, chain.q(x), velocity=1.0)
    one = held(timed)
    assert_allclose(one.x[-1, chain.limits.periodic] - one.x[0, chain.limits.periodic], 3.0, atol=1e-9)


def test_before_its_begin_and_after_its_end_it_stands(line: mik.IKPath) -> None:
    timed = line.timed()
    one = timed.at([-1.0, 0.0, timed.duration, timed.duration + 1.0])
    assert_allclose(one.q[0], one.q[1], atol=0.0)
    assert_allclose(one.q[2], one.q[3], atol=0.0)
    assert not one.v[[0, 3]].any() and not one.a[[0, 3]].any() and not one.tip_speed[[0, 3]].any()


def test_files_hold_what_the_samples_do(line: mik.IKPath, tmp_path: Path) -> None:
    timed = line.timed()
    one = timed.sample(0.02)
    timed.write_csv(tmp_path / "motion.csv", 0.02)
    with (tmp_path / "motion.csv").open(newline="") as file:
        names, *rows = list(csv.reader(file))
    table = np.array(rows, dtype=float)
    assert names[:2] == ["t", "panda_joint1 rad"] and names[-1] == "panda_hand_tcp m/s"
    assert_allclose(table, np.column_stack([one.t, one.x, one.v, one.a, one.tip_speed]), atol=0.0)

    timed.write_joint_trajectory(tmp_path / "motion.json", 0.02, frame="panda_link0", stamp=12.5)
    message = json.loads((tmp_path / "motion.json").read_text())
    assert message["header"] == {"stamp": {"sec": 12, "nanosec": 500_000_000}, "frame_id": "panda_link0"}
    assert message["joint_names"] == list(line.chain.names)
    points = message["points"]
    assert set(points[0]) == {"positions", "velocities", "accelerations", "effort", "time_from_start"}
    times = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in points]
    assert_allclose(times, one.t, atol=1e-9)
    assert_allclose([p["positions"] for p in points], one.x, atol=0.0)
    timed.write_joint_trajectory(tmp_path / "motion.yaml", 0.1)
    assert "joint_names" in (tmp_path / "motion.yaml").read_text()
    assert json.loads(json.dumps(timed.as_dict(0.1)))["duration"] == timed.duration

    timed.plot(tmp_path / "motion.png")
    assert (tmp_path / "motion.png").stat().st_size > 10_000


def test_what_cannot_be_timed_is_told(panda: mik.Chain, line: mik.IKPath, tmp_path: Path) -> None:
    start = panda.placements(HOME)[0]
    far = moved(start, 5.0, 0.0, 0.0)
    with pytest.raises(mik.MetaIKError, match="does not meet pose 1"):
        mik.solve_ik_path(panda, [start, far], HOME).timed()
    near = moved(start, 0.0, 0.4, 0.0)
    with pytest.raises(mik.MetaIKError, match="jumps before pose 1"):
        mik.solve_ik_path(panda, [start, near], HOME, max_step=0.01).timed()
    with pytest.raises(mik.MetaIKError, match="all of these are the same"):
        timing.time_path(panda, [HOME, HOME])
    with pytest.raises(mik.MetaIKError, match="at least two configurations"):
        timing.time_path(panda, [HOME])
    with pytest.raises(mik.MetaIKError, match="acceleration is above 0"):
        line.timed(acceleration=0.0)
    with pytest.raises(mik.MetaIKError, match=r"as \.yaml or \.json"):
        line.timed().write_joint_trajectory(tmp_path / "motion.bag")


def polynomial(rng: np.random.Generator) -> NDArray[np.float64]:
    return rng.normal(size=3) * 10.0 ** rng.uniform(-6, 6, 3)


def test_roots_are_roots() -> None:
    rng = np.random.default_rng(0)
    for _ in range(200):
        a, b, c = polynomial(rng)
        for root in roots(np.array([a]), np.array([b]), np.array([c])).ravel():
            if b * b > 4.0 * a * c:
                size = max(abs(a * root * root), abs(b * root), abs(c))
                assert abs(a * root * root + b * root + c) <= 1e-12 * size


def test_the_largest_derivatives_of_a_curve_are_those_of_dense_samples(panda: mik.Chain) -> None:
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (7, 7)) + 0.5 * (panda.limits.lower + panda.limits.upper)
    curve = JointCurve.through(x, panda.limits, panda.limits.velocity)
    s = np.linspace(0.0, curve.length, 20_001)
    for order in (1, 2, 3):
        dense = np.abs(curve(s, order)).max(axis=0)
        assert (dense <= curve.largest(order) + 1e-9).all()
        assert_allclose(dense, curve.largest(order), rtol=1e-3)
    assert_allclose(
        np.gradient(curve(s), s, axis=0)[1:-1], curve(s, 1)[1:-1], atol=2e-3
    )  # across a point the second derivative bends
