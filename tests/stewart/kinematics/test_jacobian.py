import numpy as np
import pinocchio as pin
from numpy.testing import assert_allclose

from pin_metaik.stewart import Dexterity, homogenised, jacobian, leg_lengths, pose_at, standard_geometry
from tests.stewart.cases import cube, reference, some_poses


def moved(pose, twist):
    """A pose moved by v and turned by omega, both in the base frame."""
    new = pose.copy()
    new[:3, 3] += twist[:3]
    new[:3, :3] = pin.exp3(np.array(twist[3:])) @ pose[:3, :3]
    return new


def test_the_jacobian_is_the_derivative_of_the_leg_lengths():  # A4
    h = 1e-6
    poses = some_poses(100, (0, 0, 0.35), (0.1, 0.1, 0.1), 0.5)
    ahead = [[moved(pose, step) for pose in poses] for step in h * np.eye(6)]
    behind = [[moved(pose, -step) for pose in poses] for step in h * np.eye(6)]
    for geometry in (
        reference().geometry,
        standard_geometry("5x4", 0.2, 0.1),
        standard_geometry("3x3", 0.2, 0.1, legs=4),
    ):
        J = jacobian(geometry, poses)
        for k in range(6):
            difference = (leg_lengths(geometry, ahead[k]) - leg_lengths(geometry, behind[k])) / (2 * h)
            assert_allclose(difference, J[:, :, k], rtol=0, atol=1e-6 * np.abs(J).max())


def test_the_translations_of_a_cube_are_isotropic():  # A5
    a = 0.1
    J = jacobian(cube(a), pose_at((0, 0, a / np.sqrt(3))))
    assert_allclose(J[:, :3].T @ J[:, :3], 2 * np.eye(3), atol=1e-14)


def test_the_homogenised_form_divides_the_rotations_by_the_characteristic_length():
    geometry, pose = reference().geometry, pose_at((0, 0, 0.4))
    J = jacobian(geometry, pose)
    for length, value in (("rm", 0.12), (0.05, 0.05)):
        J_h = homogenised(geometry, pose, Dexterity(length=length))
        assert_allclose(J_h, np.hstack((J[:, :3], J[:, 3:] / value)), rtol=1e-15)


def test_a_leg_of_no_length_has_a_row_of_zeros():
    geometry = cube(0.1)
    J = jacobian(geometry, pose_at(geometry.b[0] - geometry.m[0]))
    assert_allclose(J[0], 0.0)
    assert np.isfinite(J).all()
