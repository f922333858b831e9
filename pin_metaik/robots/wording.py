"""A URDF in words that urdfdom reads all of: the same robot, with nothing in it that makes urdfdom drop or refuse more.

urdfdom ignores capsules and quaternions unless the file says version 1.1 or later, drops every shape of a link of which
it cannot read one, its mass or a colour, and refuses a robot for a negative effort. What a model is made from and what
geometry is made from are therefore given to it apart, as version 1.1.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from copy import deepcopy
from math import inf, nan
from typing import Literal

from pin_metaik.errors import InvalidModel

Shapes = Literal["collision", "visual"]

VERSION = "1.1"  # the newest in which limits may be crossed, which matters only to a controller of the joint
NEWEST = "1.2"  # of URDF
NO_LIMIT = "1e308"  # Pinocchio's "no limit"
_MOTION = ("parent", "child", "origin", "axis", "limit", "dynamics", "mimic")  # what of a joint a model is made from
_NEVER_NEGATIVE = {"limit": ("effort", "velocity"), "dynamics": ("damping", "friction")}
_ON_AN_AXIS = ("revolute", "continuous", "prismatic")
_NO_SHAPE = ("origin", "geometry", "material", "color", "texture")


def motion_of(robot: ET.Element, what: str) -> tuple[ET.Element, list[str]]:
    """A tree of the links, masses and joints of a URDF's tree, and what has to be said about it.

    Raises:
        InvalidModel: If no parser reads its version.
    """
    version = robot.get("version", "1.0").strip()
    if not re.fullmatch(r"1(\.[0-2])?", version):
        raise InvalidModel(f"{what} is URDF of version {version!r}: up to {NEWEST} can be read")
    remarks: list[str] = []
    root = _robot(robot)
    for link in robot.iterfind("link"):
        ET.SubElement(root, "link", link.attrib).extend(link.findall("inertial"))
    for joint in robot.iterfind("joint"):
        copy = ET.SubElement(root, "joint", joint.attrib)
        copy.extend(deepcopy(child) for child in joint if child.tag in _MOTION)
        remarks += _mended(copy)
    return root, remarks


def shapes_of(robot: ET.Element, shapes: Shapes) -> tuple[ET.Element, dict[str, int]]:
    """A tree of the links and their shapes of one kind, and how many shapes each link has.

    Several shapes in one ``<geometry>`` come one by one: urdfdom would read the first.
    """
    root = _robot(robot)
    if shapes == "visual":
        colours = {material.get("name"): material for material in reversed(robot.findall("material"))}
        root.extend(reversed(colours.values()))
    counts = {}
    for link in robot.iterfind("link"):
        copy = ET.SubElement(root, "link", link.attrib)
        copy.extend(single for element in link.iterfind(shapes) for single in _singles(element))
        counts[link.get("name", "")] = len(copy)
        copy.extend(link.findall("collision_checking"))
    for joint in robot.iterfind("joint"):
        copy = ET.SubElement(root, "joint", {**joint.attrib, "type": "fixed"})
        copy.extend(child for child in joint if child.tag in ("parent", "child"))
    return root, counts


def _robot(robot: ET.Element) -> ET.Element:
    return ET.Element("robot", {key: robot.attrib[key] for key in ("name",) if key in robot.attrib}, version=VERSION)


def _mended(joint: ET.Element) -> Iterable[str]:
    """Take out of a joint what urdfdom refuses and kinematics does not need, and tell of it."""
    name, kind = joint.get("name", ""), joint.get("type", "")
    axis = joint.find("axis")
    if axis is not None and "xyz" not in axis.attrib:
        joint.remove(axis)  # then it is 1 0 0, as without the element
    elif axis is not None and kind in _ON_AN_AXIS and not any(_number(value) for value in axis.attrib["xyz"].split()):
        joint.set("type", "fixed")
        yield f"joint {name!r} has a zero axis and is taken as fixed"
    for part in joint:
        for key in _NEVER_NEGATIVE.get(part.tag, ()):
            if _number(value := part.get(key, "0")) < 0:
                part.set(key, value.strip().removeprefix("-"))
                yield f"joint {name!r} has {key} = {value}: taken as {part.get(key)}"
    for dynamics in joint.iterfind("dynamics"):
        dynamics.attrib.setdefault("damping", "0")
    for limit in joint.iterfind("limit"):
        limit.attrib = {"effort": NO_LIMIT, "velocity": NO_LIMIT, **limit.attrib}


def _singles(element: ET.Element) -> Iterable[ET.Element]:
    """A ``<collision>`` or ``<visual>`` for each shape in it; none if it is empty."""
    if all(part.tag in _NO_SHAPE for part in list(element.iter())[1:]):
        return
    for material in element.iterfind("material"):
        material.attrib.setdefault("name", "")
    geometry = element.find("geometry")
    if geometry is None or len(geometry) < 2:
        yield element
        return
    for shape in geometry:
        single = ET.Element(element.tag, element.attrib)
        single.extend(child for child in element if child.tag != "geometry")
        ET.SubElement(single, "geometry").append(shape)
        yield single


def negative_sizes(robot: ET.Element, shapes: Shapes) -> list[str]:
    """The shapes with a size below zero, or infinite, each as ``link 'a': <sphere radius="-1">``."""
    return [
        f'link {link.get("name", "")!r}: <{shape.tag} {key}="{shape.get(key)}">'
        for link in robot.iterfind("link")
        for shape in link.iterfind(f"{shapes}/geometry/*")
        for key in ("size", "radius", "length")
        if any(_number(value) < 0 or _number(value) == inf for value in shape.get(key, "").split())
    ]


def _number(text: str) -> float:
    """The number of a text; NaN for any other text, which the parser will name."""
    try:
        return float(text)
    except ValueError:
        return nan
