import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidConfiguration
from pin_metaik.stewart import (
    LegLimits,
    Mechanism,
    closed_model,
    forward,
    jacobian,
    leg_lengths,
    pose_at,
    save_urdf,
    standard_geometry,
    to_urdf,
)
from tests.stewart.cases import home_poses, reference

HOME = pose_at((0, 0, 0.37))


@pytest.fixture(scope="module")
def closed():
    return closed_model(reference())


def test_the_tree_has_a_free_flyer_and_three_joints_a_leg(closed):
    assert (closed.model.nq, closed.model.nv) == (25, 24)
    _, J = closed.residual(closed.configuration(HOME))
    assert J.shape == (18, 24)
    assert np.linalg.matrix_rank(J) == 18


def test_the_loops_of_the_closed_form_are_closed(closed):
    for pose in home_poses(50):
        error, _ = closed.residual(closed.configuration(pose))
        assert np.abs(error).max() < 1e-14


def test_the_residual_and_its_jacobian_belong_together_off_closure(closed):
    q = pin.integrate(closed.model, closed.configuration(HOME), 0.1 * np.random.default_rng(0).standard_normal(24))
    error, J = closed.residual(q)
    h = 1e-7
    for k in range(24):
        moved, _ = closed.residual(pin.integrate(closed.model, q, h * np.eye(24)[k]))
        assert_allclose((moved - error) / h, J[:, k], atol=1e-5)


def test_forward_kinematics_by_pinocchio_agrees(closed):  # A9
    geometry = reference().geometry
    poses = home_poses(50)
    for pose, ours in zip(poses, forward(geometry, leg_lengths(geometry, poses), HOME).poses, strict=True):
        assert_allclose(closed.forward(leg_lengths(geometry, pose), HOME), ours, rtol=0, atol=1e-9)


def test_rates_by_pinocchio_are_the_jacobian(closed):  # A10
    geometry = reference().geometry
    for pose in home_poses(50):
        assert_allclose(closed.rates(pose), jacobian(geometry, pose), rtol=0, atol=1e-10)


def test_lengths_that_fit_nowhere_are_not_found(closed):
    assert closed.forward([0.2, 0.9, 0.2, 0.9, 0.2, 0.9], HOME) is None
    with pytest.raises(InvalidConfiguration, match=r"lengths: expected shape \(6,\)"):
        closed.forward([0.4] * 5, HOME)
    with pytest.raises(InvalidConfiguration, match=r"expected shape \(25,\)"):
        closed.residual(np.zeros(24))


@pytest.mark.parametrize(("type", "legs"), [("3x3", 3), ("4x3", 4), ("5x5", 5), ("3x3", 6), ("6x5", 6)])
def test_every_type_has_a_model_with_the_same_rates(type, legs):
    geometry = standard_geometry(type, 0.25, 0.12, legs=legs)
    other = closed_model(Mechanism("other", geometry, LegLimits(0.3, 0.5)))
    assert other.model.nv == 6 + 3 * legs
    pose = home_poses(1)[0]
    assert_allclose(other.rates(pose), jacobian(geometry, pose), rtol=0, atol=1e-10)


def test_the_reference_point_is_the_platforms_frame():
    geometry = type(reference().geometry)(**{**vars_of(reference().geometry), "reference": (0.01, -0.02, 0.05)})
    closed = closed_model(Mechanism("tool", geometry, LegLimits(0.3, 0.5)))
    error, _ = closed.residual(closed.configuration(HOME))
    assert np.abs(error).max() < 1e-14


def vars_of(geometry):
    names = ("base_radius", "platform_radius", "base_angles", "platform_angles", "legs")
    return {name: getattr(geometry, name) for name in names}


def test_the_urdf_is_the_same_bytes_every_time_and_holds_the_limits(tmp_path):
    mechanism = reference()
    text = to_urdf(mechanism)
    assert save_urdf(mechanism, tmp_path / "m.urdf").read_text() == text == to_urdf(reference())
    slides = [joint for joint in ET.fromstring(text).iter("joint") if joint.get("type") == "prismatic"]
    assert len(slides) == 6
    assert {(j.find("limit").get("lower"), j.find("limit").get("upper")) for j in slides} == {("0.35", "0.47")}
    model = pin.buildModelFromUrdf(str(tmp_path / "m.urdf"))
    assert all(model.existFrame(name) for name in ("leg_1_end", "platform_end_6"))
    assert all(inertia.mass > 0 for inertia in list(model.inertias)[1:])
