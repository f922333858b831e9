"""Forward kinematics of a URDF by the textbook, without Pinocchio, urdfdom or anything of the package."""

import xml.etree.ElementTree as ET

import numpy as np
from scipy.spatial.transform import Rotation


def numbers(text: str) -> np.ndarray:
    return np.array([float(value) for value in text.split()])


def position(joints: dict[str, ET.Element], name: str, q: dict[str, float]) -> float:
    """A joint's coordinate: its own, or that of the joint it mimics, scaled; fixed joints stand at zero."""
    tag = joints[name].find("mimic")
    if joints[name].get("type") == "fixed":
        return 0.0
    if tag is None:
        return q[name]
    followed = position(joints, tag.get("joint", ""), q)
    return float(tag.get("multiplier", 1)) * followed + float(tag.get("offset", 0))


def link_placements(urdf: str, q: dict[str, float]) -> dict[str, np.ndarray]:
    """Each link's placement, (4, 4), with the joints that follow none at ``q`` (rad, m)."""
    robot = ET.fromstring(urdf)
    joints = {joint.get("name", ""): joint for joint in robot.iterfind("joint")}
    ends = {name: (joint.find("parent").get("link"), joint.find("child").get("link")) for name, joint in joints.items()}
    placements = {link.get("name", ""): np.eye(4) for link in robot.iterfind("link")}
    placements = {link: T for link, T in placements.items() if link not in {child for _, child in ends.values()}}
    while len(placements) <= len(joints):
        for name, (parent, child) in ends.items():
            if parent in placements and child not in placements:
                placements[child] = placements[parent] @ step(joints[name], position(joints, name, q))
    return placements


def step(joint: ET.Element, value: float) -> np.ndarray:
    origin, axis = joint.find("origin"), joint.find("axis")
    T, motion = np.eye(4), np.eye(4)
    if origin is not None:
        T[:3, 3] = numbers(origin.get("xyz", "0 0 0"))
        T[:3, :3] = Rotation.from_euler("xyz", numbers(origin.get("rpy", "0 0 0"))).as_matrix()
        if "quat_xyzw" in origin.attrib:
            T[:3, :3] = Rotation.from_quat(numbers(origin.get("quat_xyzw", ""))).as_matrix()
    along = np.array([1.0, 0, 0]) if axis is None else numbers(axis.get("xyz", "1 0 0"))
    along = along / (np.linalg.norm(along) or 1.0)
    if joint.get("type") in ("revolute", "continuous"):
        motion[:3, :3] = Rotation.from_rotvec(value * along).as_matrix()
    elif joint.get("type") == "prismatic":
        motion[:3, 3] = value * along
    return T @ motion
