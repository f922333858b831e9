import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting
from pin_metaik.stewart import (
    Dexterity,
    best_length,
    characteristic_length,
    conditioning,
    homogenised,
    jacobian,
    pose_at,
    standard_geometry,
)
from pin_metaik.stewart.kinematics.conditioning import NORMS
from tests.stewart.cases import cube, reference, similar_hexagons, some_poses, stroke

PRINTED = 1e-5


@pytest.mark.parametrize(("norm", "level", "tilted"), [("frobenius", 0.888560, 0.873296), ("two", 0.496088, 0.453904)])
def test_dexterity_of_the_design_for_stroke_100(norm, level, tilted):  # A2
    poses = [pose_at((0, 0, 0.230)), pose_at((0.020, -0.015, 0.240), np.radians((5, -8, 12)))]
    assert_allclose(conditioning(stroke(100).geometry, poses, Dexterity(norm)), [level, tilted], rtol=0, atol=PRINTED)


@pytest.mark.parametrize(("norm", "level", "tilted"), [("frobenius", 0.644795, 0.614537), ("two", 0.278847, 0.250892)])
def test_dexterity_of_the_6x6_reference(norm, level, tilted):  # A3
    poses = [pose_at((0, 0, 0.4)), pose_at((0.030, -0.020, 0.420), np.radians((5, -8, 12)))]
    assert_allclose(conditioning(reference().geometry, poses, Dexterity(norm)), [level, tilted], rtol=0, atol=PRINTED)


def test_the_best_characteristic_lengths_of_a_cube():  # A5
    a = 0.1
    pose = pose_at((0, 0, a / np.sqrt(3)))
    flat = 1e-6  # a maximum is flat: rounding hides it within 1e-8 of its square root's
    assert_allclose(best_length(cube(a), pose, "frobenius"), 0.689746 * a, rtol=flat)
    assert_allclose(conditioning(cube(a), pose, Dexterity("frobenius", "best")), 0.834538, atol=1e-6)
    assert_allclose(best_length(cube(a), pose, "two"), 2 * np.sqrt(2) / 3 * a, rtol=flat)
    assert_allclose(conditioning(cube(a), pose, Dexterity("two", "best")), np.sqrt(2) / 3, rtol=flat)


def test_a_cube_about_its_centre_has_exact_dexterities():  # A5
    a = 0.1
    half = a / (2 * np.sqrt(3))
    geometry, pose = cube(a, reference=(0, 0, -half)), pose_at((0, 0, half))
    assert_allclose(conditioning(geometry, pose, Dexterity("two", a / np.sqrt(2))), 0.5, rtol=1e-14)
    assert_allclose(conditioning(geometry, pose, Dexterity("frobenius", a / np.sqrt(2))), 2 / np.sqrt(5), rtol=1e-14)


@pytest.mark.parametrize("legs", [3, 4, 5, 6])
def test_the_compiled_dexterity_is_that_of_numpy(legs):
    geometry = standard_geometry(f"{legs}x{min(legs, 4)}", 0.25, 0.12, legs=legs)
    poses = some_poses(200, (0, 0, 0.3), (0.1, 0.1, 0.1), 0.6)
    J = homogenised(geometry, poses)
    s = np.linalg.svd(J, compute_uv=False)
    JJ = np.einsum("kij,klj->kil", J, J)
    traces = np.trace(JJ, axis1=1, axis2=2) * np.trace(np.linalg.inv(JJ), axis1=1, axis2=2)
    assert_allclose(conditioning(geometry, poses, Dexterity("frobenius")), legs / np.sqrt(traces), rtol=1e-9)
    assert_allclose(conditioning(geometry, poses, Dexterity("two")), s[:, -1] / s[:, 0], rtol=1e-9)


def test_the_best_length_at_a_pose_is_that_of_the_closed_form():
    geometry = reference().geometry
    for pose in some_poses(10, (0, 0, 0.37), (0.05, 0.05, 0.04), 0.3):
        J = jacobian(geometry, pose)
        X = np.linalg.inv(J)
        a, c, p, q = (np.sum(part**2) for part in (J[:, :3], J[:, 3:], X[:3], X[3:]))
        assert_allclose(best_length(geometry, pose), (c * p / (a * q)) ** 0.25, rtol=1e-6)


def test_one_best_length_over_many_poses_is_better_than_its_neighbours():
    geometry, poses = stroke(200).geometry, some_poses(50, (0, 0, 0.6), (0.1, 0.1, 0.05), 0.0)
    best = characteristic_length(geometry, poses, Dexterity(length="best"))
    means = [conditioning(geometry, poses, Dexterity(length=best * k)).mean() for k in (0.99, 1.0, 1.01)]
    assert means[1] == max(means)


@pytest.mark.parametrize("norm", NORMS)
def test_singular_poses_have_no_dexterity_and_nothing_is_nan(norm):
    poses = [pose_at((0.02, 0.01, 0.4)), pose_at((0, 0, 0.3)), pose_at((0, 0, 0)), pose_at((1e-12, 0, 1e-200))]
    assert_allclose(conditioning(similar_hexagons(), poses[:2], Dexterity(norm)), 0.0)
    for geometry in (similar_hexagons(), cube(0.1), reference().geometry):
        at_a_joint = pose_at(geometry.b[0] - geometry.m[0])  # the first leg has no length
        for length in ("rm", "best", 1e-6, 1e6):
            nu = conditioning(geometry, [*poses, at_a_joint], Dexterity(norm, length))
            assert np.isfinite(nu).all()
            assert ((nu >= 0) & (nu <= 1)).all()
            assert nu[-1] == 0.0


def test_an_octahedron_turned_by_90_degrees_is_singular():
    assert conditioning(cube(0.1), pose_at((0, 0, 0.1), (0, 0, np.pi / 2))) == 0.0


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"norm": "three"}, "norm must be one of 'frobenius', 'two', not 'three'"),
        ({"length": "rb"}, "length is 'rm', 'best' or a length above zero in m, got 'rb'"),
        ({"length": 0.0}, "length is 'rm'"),
        ({"length": np.nan}, "length is 'rm'"),
        ({"length": True}, "length is 'rm'"),
    ],
)
def test_settings_that_are_none_are_refused(settings, message):
    with pytest.raises(InvalidSetting, match=message):
        Dexterity(**settings)
