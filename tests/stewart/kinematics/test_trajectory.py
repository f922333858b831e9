import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting, InvalidTarget
from pin_metaik.stewart import (
    LegLimits,
    PoseState,
    Trajectory,
    follow,
    jacobian,
    leg_lengths,
    pose_at,
    straight,
)
from tests.stewart.cases import reference


def test_rates_are_the_derivatives_of_the_lengths():
    geometry = reference().geometry
    way = straight(pose_at((-0.02, 0, 0.36)), pose_at((0.02, 0.01, 0.38), (0.1, -0.1, 0.2)), 2.0, 4001)
    motion = follow(geometry, way, LegLimits(0.35, 0.47))
    assert_allclose(motion.lengths, leg_lengths(geometry, way.poses))
    assert_allclose(motion.rates, np.gradient(motion.lengths, way.times, axis=0, edge_order=2), atol=1e-6)
    assert_allclose(motion.rates[[0, -1]], 0, atol=1e-15)  # from rest to rest
    assert motion.reached.all()
    assert (motion.nu > 0.5).all()
    assert_allclose(motion.stroke, np.ptp(motion.lengths, axis=0))


def test_differences_of_poses_are_the_twists_of_a_smooth_way():
    way = straight(pose_at((0, 0, 0.3)), pose_at((0.1, 0, 0.4), (0.3, 0.2, 0.1)), 1.0, 2001)
    again = Trajectory.through(way.times, way.poses)
    assert_allclose(again.twists[1:-1], way.twists[1:-1], atol=1e-5)


def test_a_straight_way_ends_where_it_should():
    first, last = pose_at((0, 0, 0.3)), pose_at((0.1, 0, 0.4), (0.3, 0.2, 0.1))
    way = straight(first, last, 3.0, 7)
    assert_allclose(way.poses[0], first, atol=1e-15)
    assert_allclose(way.poses[-1], last, atol=1e-15)
    assert way.times[-1] == 3.0
    assert_allclose(way.at([0.0, 3.0, 99.0]), [first, last, last], atol=1e-15)
    assert_allclose(way.at(way.times), way.poses, atol=1e-12)


def test_limits_along_a_way_are_named():
    motion = follow(
        reference().geometry, straight(pose_at((0, 0, 0.36)), pose_at((0, 0, 0.6)), 1.0), LegLimits(0.35, 0.47)
    )
    assert motion.states[-1] == PoseState.TOO_LONG
    assert not motion.reached[-1]
    assert motion.reached[0]
    assert np.isfinite(motion.nu).all()
    assert follow(reference().geometry, motion.trajectory).reached.all()  # without limits


def test_the_rates_of_a_turn_are_those_of_the_jacobian():
    geometry = reference().geometry
    way = straight(pose_at((0, 0, 0.4)), pose_at((0, 0, 0.4), (0, 0, 0.5)), 1.0)
    motion = follow(geometry, way)
    middle = len(way.times) // 2
    yawing = 0.5 * 30 / 16  # quintic time is fastest in the middle, at 30/16 of the mean
    assert_allclose(motion.rates[middle], jacobian(geometry, way.poses[middle])[:, 5] * yawing, rtol=1e-9)


@pytest.mark.parametrize(
    ("times", "poses"),
    [
        ([0.0], [np.eye(4)]),
        ([0.0, 0.0], [np.eye(4)] * 2),
        ([0.0, 1.0, 2.0], [np.eye(4)] * 2),
        ([0, np.nan], [np.eye(4)] * 2),
    ],
)
def test_trajectories_that_are_none_are_refused(times, poses):
    with pytest.raises(InvalidTarget, match="trajectory"):
        Trajectory.through(times, poses)


def test_a_way_takes_time():
    with pytest.raises(InvalidSetting, match="seconds"):
        straight(np.eye(4), np.eye(4), 0.0)
    with pytest.raises(InvalidTarget, match="twists"):
        Trajectory(np.array([0.0, 1.0]), np.stack([np.eye(4)] * 2), np.zeros((2, 5)))
