import coal
import numpy as np
from numpy.testing import assert_allclose

from pin_metaik.stewart import leg_distances, leg_vectors, pose_at, standard_geometry
from tests.stewart.cases import reference, some_poses

RADIUS = 0.01


def capsule(start, vector):
    """A leg as coal has it, and where it is."""
    length = np.linalg.norm(vector)
    z = vector / length
    x = np.cross(z, [1.0, 0, 0] if abs(z[0]) < 0.9 else [0, 1.0, 0])
    x /= np.linalg.norm(x)
    R = np.column_stack((x, np.cross(z, x), z))
    return coal.Capsule(RADIUS, length), coal.Transform3s(R, start + vector / 2)


def by_coal(geometry, pose, i, j):
    (shape, at), (other, there) = (capsule(geometry.b[k], leg_vectors(geometry, pose)[0, k]) for k in (i, j))
    request = coal.DistanceRequest(True)
    return coal.distance(shape, at, other, there, request, coal.DistanceResult()) + 2 * RADIUS


def test_the_nearest_legs_of_the_6x6_reference():  # A11
    geometry = reference().geometry
    distances = leg_distances(geometry, pose_at((0, 0, 0.4)))
    assert_allclose(distances.min(), 0.0416756, rtol=0, atol=5e-8)
    assert geometry.pairs[distances.argmin()].tolist() == [0, 5]  # legs 1 and 6


def test_distances_are_those_of_coal_also_between_legs_that_cross():  # A11
    poses = some_poses(134, (0, 0, 0.3), (0.15, 0.15, 0.1), 1.5)
    geometry = reference().geometry
    distances = leg_distances(geometry, poses)
    assert distances.size > 2000
    assert (distances < 2 * RADIUS).sum() > 5  # some do touch
    for pose, row in zip(poses, distances, strict=True):
        expected = [by_coal(geometry, pose, i, j) for i, j in geometry.pairs]
        assert_allclose(row, expected, rtol=0, atol=1e-9)


def test_parallel_legs_are_as_far_apart_as_their_feet():
    angles = np.radians([0, 60, 120, 180, 240, 300])
    same = type(reference().geometry)(0.2, 0.2, angles, angles, tuple((i, i) for i in range(6)))
    for lean in (0.0, 0.05):  # upright, then all leaning alike
        distances = leg_distances(same, pose_at((0, 0, 0.5)) if lean == 0 else pose_at((lean, 0, 0.5)))
        feet = [np.linalg.norm(same.b[i] - same.b[j]) for i, j in same.pairs]
        assert (distances <= np.array(feet) + 1e-15).all()
        if lean == 0:
            assert_allclose(distances, feet, rtol=1e-12)


def test_legs_without_a_pair_have_no_distances():
    star = standard_geometry("3x3", 0.2, 0.1, legs=3)
    assert leg_distances(star, pose_at((0, 0, 0.3))).shape == (3,)
    assert leg_distances(star, [pose_at((0, 0, 0.3))] * 2).shape == (2, 3)


def test_a_leg_of_no_length_has_distances_too():
    geometry = reference().geometry
    pose = pose_at(geometry.b[0] - geometry.m[0])
    assert np.isfinite(leg_distances(geometry, pose)).all()
