"""Platforms moved by servos as URDF and in Pinocchio."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pinocchio as pin
from numpy.testing import assert_allclose

from pin_metaik.stewart import Mechanism, ServoLimits, closed_model, inverse, load_mechanism, to_urdf
from pin_metaik.stewart.platform.servos import each
from tests.stewart.cases import general_servos, servo_poses

LIMITS = ServoLimits(-1.2, 1.1, speed=8.0)
MECHANISM = Mechanism("general", general_servos(), LIMITS)


def test_the_urdf_is_the_same_bytes_every_time_and_holds_the_limits_of_servos():
    assert to_urdf(MECHANISM) == to_urdf(MECHANISM)
    joints = ET.fromstring(to_urdf(MECHANISM)).iter("joint")
    servos = [joint.find("limit") for joint in joints if joint.get("name").endswith("servo")]
    assert len(servos) == 6
    assert {tuple(limit.get(key) for key in ("lower", "upper", "velocity")) for limit in servos} == {
        ("-1.2", "1.1", "8.0")
    }


def test_horns_and_rods_stand_where_inverse_kinematics_has_them():
    closed = closed_model(MECHANISM)
    pose = servo_poses(1, MECHANISM.geometry, 11)[0]
    links = inverse(MECHANISM.geometry, pose)
    data = closed.model.createData()
    pin.framesForwardKinematics(closed.model, data, closed.configuration(pose))
    for leg in range(6):
        places = [data.oMf[closed.model.getFrameId(f"leg_{leg + 1}_{name}")].translation for name in ("rod", "end")]
        assert_allclose(places[0], links.starts[0, leg], atol=1e-12)
        assert_allclose(places[1], links.starts[0, leg] + links.vectors[0, leg], atol=1e-12)
        assert_allclose(np.linalg.norm(places[1] - places[0]), each(MECHANISM.geometry.servos, "rod")[leg])


def test_the_actuators_are_the_columns_of_the_servos():
    closed = closed_model(replace(load_mechanism("servo_esp32")))
    names = [closed.model.names[closed.model.joints[joint].id] for joint in range(1, closed.model.njoints)]
    by_column = {closed.model.joints[closed.model.getJointId(name)].idx_v: name for name in names}
    assert [by_column[column] for column in closed.actuators] == [f"leg_{i}_servo" for i in range(1, 7)]
