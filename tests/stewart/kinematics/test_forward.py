import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from pin_metaik.errors import InvalidConfiguration
from pin_metaik.stewart import ForwardStatus, all_forward, forward, leg_lengths, pose_at, standard_geometry
from tests.stewart.cases import home_poses, reference, similar_hexagons, stroke

HOME = pose_at((0, 0, 0.37))


def angle(A, B):
    return np.linalg.norm(pin.log3(A[:3, :3].T @ B[:3, :3]))


def test_five_hundred_poses_are_found_again_from_home():  # A9
    geometry, poses = reference().geometry, home_poses(500)
    found = forward(geometry, leg_lengths(geometry, poses), HOME)
    assert found.solved.all()
    assert found.iterations.max() <= 8
    assert_allclose(found.poses[:, :3, 3], poses[:, :3, 3], rtol=0, atol=1e-9)
    assert max(angle(A, B) for A, B in zip(found.poses, poses, strict=True)) <= 1e-8


def test_the_default_start_is_level_and_as_high_as_the_legs_say():
    geometry, poses = reference().geometry, home_poses(50)
    found = forward(geometry, leg_lengths(geometry, poses))
    assert found.solved.all()
    assert_allclose(found.poses, poses, rtol=0, atol=1e-9)


def test_one_start_each_is_used_for_each():
    geometry, poses = reference().geometry, home_poses(5)
    found = forward(geometry, leg_lengths(geometry, poses), poses)
    assert_array_equal(found.iterations, 0)


def test_a_single_pose_has_a_pose_and_a_status():
    geometry = stroke(100).geometry
    pose = pose_at((0.01, 0.02, 0.25), (0.1, 0.0, -0.1))
    found = forward(geometry, leg_lengths(geometry, pose))
    assert found.status is ForwardStatus.SOLVED
    assert_allclose(found.pose, pose, atol=1e-10)


def test_every_assembly_has_the_lengths_and_its_mirror_image():
    geometry = reference().geometry
    pose = pose_at((0.01, 0.02, 0.35), (0.1, -0.2, 0.1))
    lengths = leg_lengths(geometry, pose)
    found = all_forward(geometry, lengths)
    assert 2 <= len(found) <= 40
    assert_allclose(leg_lengths(geometry, found), np.tile(lengths, (len(found), 1)), atol=1e-12)
    assert min(np.abs(found - pose).max(axis=(1, 2))) < 1e-8
    mirror = np.diag([1, 1, -1, 1])
    for assembly in found:
        image = mirror @ assembly @ mirror  # the platform's plane is mirrored in the base's
        assert min(np.abs(found - image).max(axis=(1, 2))) < 1e-6
    assert_allclose(np.sort(found[:, 2, 3])[::-1], found[:, 2, 3], atol=1e-9)  # highest first
    assert_array_equal(all_forward(geometry, lengths, rng=3), all_forward(geometry, lengths, rng=3))


def test_lengths_that_fit_nowhere_are_not_solved():
    lengths = [0.2, 0.9, 0.2, 0.9, 0.2, 0.9]
    assert forward(reference().geometry, lengths).status is not ForwardStatus.SOLVED


@pytest.mark.parametrize("legs", [3, 4, 5])
def test_fewer_legs_find_a_pose_near_the_start(legs):
    geometry = standard_geometry("3x3", 0.25, 0.12, legs=legs)
    pose = pose_at((0.02, 0.01, 0.36), (0.1, 0.05, -0.1))
    found = forward(geometry, leg_lengths(geometry, pose), HOME)
    assert found.status is ForwardStatus.SOLVED
    assert_allclose(leg_lengths(geometry, found.pose), leg_lengths(geometry, pose), atol=1e-12)


def test_a_singular_mechanism_says_so():
    geometry = similar_hexagons()
    lengths = leg_lengths(geometry, HOME) * [1, 1.01, 1, 1.01, 1, 1.01]
    found = forward(geometry, lengths, HOME)
    assert found.status is not ForwardStatus.SOLVED
    assert np.isfinite(found.poses).all()


@pytest.mark.parametrize("lengths", [[0.4] * 5, [[0.4] * 5], [0.4] * 5 + [-0.4], [np.nan] * 6, "long", [[[0.4] * 6]]])
def test_lengths_that_are_none_are_refused(lengths):
    with pytest.raises(InvalidConfiguration, match="leg lengths"):
        forward(reference().geometry, lengths)


def test_starts_must_be_one_or_as_many_as_the_lengths():
    with pytest.raises(InvalidConfiguration, match="3 sets of leg lengths need one start or 3, got 2"):
        forward(reference().geometry, np.full((3, 6), 0.4), [HOME, HOME])
