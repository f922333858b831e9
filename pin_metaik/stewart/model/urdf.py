"""A mechanism as URDF text: the base, the platform, and each leg as two revolute joints and a slide, or after a servo.

URDF knows trees only: the platform floats, and the loops are left open. Leg i closes where the frames ``leg_i_end`` (on
its rod) and ``platform_end_i`` coincide; ``closed_model`` does that in Pinocchio, other tools can by these names.
The coordinates of a slide are its two angles, about x and then y of the base frame, and its length. Those of a servo
are its angle, and then those of its rod, about x (the horn) and y (the way it moves) of its horn.

A mechanism has no masses: every moving part is assumed a solid cylinder of 1 kg. Legs are as thick as the distance they
keep allows; without one, 4 % of the longest leg.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from math import pi
from pathlib import Path

import pinocchio as pin

from pin_metaik.arguments import checked
from pin_metaik.output import writable
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import LegLimits, ServoLimits, lengths
from pin_metaik.stewart.platform.servos import each

MASS = 1.0  # kg
EFFORT, VELOCITY = 1000.0, 1.0  # N or N m, m/s or rad/s: URDF demands them, a mechanism does not say
COLOURS = {"grey": "0.35 0.36 0.38 1", "blue": "0.2 0.45 0.75 1", "orange": "0.9 0.5 0.15 1"}


@checked
def to_urdf(mechanism: Mechanism) -> str:
    """URDF text of a mechanism: the same mechanism gives the same bytes."""
    geometry, limits = mechanism.geometry, mechanism.limits
    _, longest = lengths(limits, geometry)
    thickness = limits.distance or 0.04 * longest
    robot = ET.Element("robot", name=mechanism.name)
    robot.append(ET.Comment(" Written by pin_metaik. Loops are open: leg_i_end belongs on platform_end_i. "))
    for colour, rgba in COLOURS.items():
        ET.SubElement(ET.SubElement(robot, "material", name=colour), "color", rgba=rgba)

    base = ET.SubElement(robot, "link", name="base_link")
    _cylinder(
        base, geometry.base_radius, thickness / 2, (geometry.base_centre - [0.0, 0.0, thickness / 4]).tolist(), "grey"
    )
    platform = ET.SubElement(robot, "link", name="platform")
    centre = geometry.platform_centre.tolist()
    _inertial(platform, geometry.platform_radius, thickness / 2, centre)
    _cylinder(platform, geometry.platform_radius, thickness / 2, centre, "orange")
    _joint(robot, "platform_joint", "floating", "base_link", "platform")

    for i in range(1, geometry.n + 1):
        if isinstance(limits, LegLimits):
            _slide(robot, i, geometry, limits, thickness)
        else:
            _servo(robot, i, geometry, limits, thickness)
        m = geometry.m[i - 1].tolist()
        along = None if geometry.servos is None else (0.0, 0.0, float(each(geometry.servos, "rod")[i - 1]))
        for end, parent, place in ((f"leg_{i}_end", f"leg_{i}_rod", along), (f"platform_end_{i}", "platform", m)):
            ET.SubElement(robot, "link", name=end)
            _joint(robot, f"{end}_joint", "fixed", parent, end, place)

    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


def _slide(robot: ET.Element, i: int, geometry: Geometry, limits: LegLimits, thickness: float) -> None:
    """Leg i as two revolute joints and a slide; its end is the origin of the rod."""
    half = limits.shortest / 2
    knuckle = ET.SubElement(robot, "link", name=f"leg_{i}_knuckle")
    _inertial(knuckle, thickness / 2, thickness / 2)
    b = geometry.b[i - 1].tolist()
    _joint(robot, f"leg_{i}_about_x", "revolute", "base_link", f"leg_{i}_knuckle", b, "1 0 0", (-pi, pi))
    cylinder = ET.SubElement(robot, "link", name=f"leg_{i}_cylinder")
    _inertial(cylinder, thickness / 2, limits.shortest, (0.0, 0.0, half))
    _cylinder(cylinder, thickness / 2, limits.shortest, (0.0, 0.0, half), "grey")
    _joint(robot, f"leg_{i}_about_y", "revolute", f"leg_{i}_knuckle", f"leg_{i}_cylinder", None, "0 1 0", (-pi, pi))
    rod = ET.SubElement(robot, "link", name=f"leg_{i}_rod")
    _inertial(rod, thickness / 3, limits.shortest, (0.0, 0.0, -half))
    _cylinder(rod, thickness / 3, limits.shortest, (0.0, 0.0, -half), "blue")
    _joint(robot, f"leg_{i}_length", "prismatic", f"leg_{i}_cylinder", f"leg_{i}_rod", None, "0 0 1", limits.span)


def _servo(robot: ET.Element, i: int, geometry: Geometry, limits: ServoLimits, thickness: float) -> None:
    """Leg i as the joint of a servo and two of a rod; its end is the far end of the rod."""
    servos = geometry.servos
    assert servos is not None
    horn, rod = (float(each(servos, name)[i - 1]) for name in ("horn", "rod"))
    arm = ET.SubElement(robot, "link", name=f"leg_{i}_horn")
    middle, along_x = (horn / 2, 0.0, 0.0), (0.0, pi / 2, 0.0)
    _inertial(arm, thickness / 2, horn, middle, along_x)
    _cylinder(arm, thickness / 2, horn, middle, "grey", along_x)
    b, turn = geometry.b[i - 1].tolist(), pin.rpy.matrixToRpy(servos.frames[i - 1].T).tolist()
    speed = limits.speed or VELOCITY
    _joint(
        robot,
        f"leg_{i}_servo",
        "revolute",
        "base_link",
        f"leg_{i}_horn",
        b,
        "0 0 1",
        limits.span,
        turn=turn,
        speed=speed,
    )
    knuckle = ET.SubElement(robot, "link", name=f"leg_{i}_knuckle")
    _inertial(knuckle, thickness / 2, thickness / 2)
    tip = (horn, 0.0, 0.0)
    _joint(robot, f"leg_{i}_about_x", "revolute", f"leg_{i}_horn", f"leg_{i}_knuckle", tip, "1 0 0", (-pi, pi))
    link = ET.SubElement(robot, "link", name=f"leg_{i}_rod")
    _inertial(link, thickness / 3, rod, (0.0, 0.0, rod / 2))
    _cylinder(link, thickness / 3, rod, (0.0, 0.0, rod / 2), "blue")
    _joint(robot, f"leg_{i}_about_y", "revolute", f"leg_{i}_knuckle", f"leg_{i}_rod", None, "0 1 0", (-pi, pi))


@checked
def save_urdf(mechanism: Mechanism, path: str | Path) -> Path:
    """Write the URDF of a mechanism to a file.

    Raises:
        CannotWrite: It cannot be written.
    """
    path = writable(path)
    path.write_text(to_urdf(mechanism), encoding="utf-8", newline="\n")
    return path


def _joint(
    robot: ET.Element,
    name: str,
    kind: str,
    parent: str,
    child: str,
    origin: Sequence[float] | None = None,
    axis: str = "",
    ends: tuple[float, float] = (0.0, 0.0),
    *,
    turn: Sequence[float] = (),
    speed: float = VELOCITY,
) -> None:
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    if origin is not None:
        ET.SubElement(joint, "origin", xyz=_numbers(origin), rpy=_numbers(turn) or "0 0 0")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    if axis:
        ET.SubElement(joint, "axis", xyz=axis)
        lower, upper = (_number(end) for end in ends)
        ET.SubElement(joint, "limit", lower=lower, upper=upper, effort=_number(EFFORT), velocity=_number(speed))


def _cylinder(
    link: ET.Element,
    radius: float,
    length: float,
    centre: Sequence[float],
    colour: str,
    turn: Sequence[float] = (),
) -> None:
    for kind in ("visual", "collision"):
        shape = ET.SubElement(link, kind)
        ET.SubElement(shape, "origin", xyz=_numbers(centre), rpy=_numbers(turn) or "0 0 0")
        ET.SubElement(ET.SubElement(shape, "geometry"), "cylinder", radius=_number(radius), length=_number(length))
        if kind == "visual":
            ET.SubElement(shape, "material", name=colour)


def _inertial(
    link: ET.Element,
    radius: float,
    length: float,
    centre: Sequence[float] = (0.0, 0.0, 0.0),
    turn: Sequence[float] = (),
) -> None:
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_numbers(centre), rpy=_numbers(turn) or "0 0 0")
    ET.SubElement(inertial, "mass", value=_number(MASS))
    across, along = _number(MASS * (3 * radius**2 + length**2) / 12), _number(MASS * radius**2 / 2)
    ET.SubElement(inertial, "inertia", ixx=across, iyy=across, izz=along, ixy="0", ixz="0", iyz="0")


def _numbers(values: Iterable[float]) -> str:
    return " ".join(_number(value) for value in values)


def _number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(float(value) + 0.0)
