"""DH table -> URDF text with the forward kinematics of the DH product.

Between two joint axes a table of either convention has one fixed step Rz(theta) Tz(d) Tx(a) Rx(alpha), in which theta
and d are constants of the row before, a and alpha of the same row (standard) or of the next (modified). What a joint
varies commutes to the front of that step, so the step is the origin of the next URDF joint: its translation is
(a cos theta, a sin theta, d) and its roll, pitch, yaw are (alpha, 0, theta). No rotation is ever turned into angles.

Links are ``base_link``, ``link_1`` ... ``link_n``, ``flange`` (the frame of the last row) and ``tool0`` (the tool).
A table has no masses and no shapes, so these are assumed. A link follows its step, along z and then along x, with a
radius of 4 % of the arm's length at the base and 2 % at the tip; it weighs 1 kg. Collision shapes are capsules: URDF
has none before 1.2, but Pinocchio turns the cylinders named in ``<collision_checking>`` into them, caps added. For the
eye there are the cylinders, and a hub about each axis that turns.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from math import atan2, cos, dist, hypot, sin
from pathlib import Path

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidTable
from pin_metaik.output import writable
from pin_metaik.robots.dh import DHRow, DHTable, Placement
from pin_metaik.robots.library import catalogue
from pin_metaik.robots.table import read_table

Point = tuple[float, float, float]
Segment = tuple[Point, Point]

_ORIGIN: Point = (0.0, 0.0, 0.0)
_MASS = 1.0  # kg
_OWN = ("universe", "root_joint", "world", "base_joint", "base_link", "flange_joint", "flange", "tool0_joint", "tool0")
_COLOURS = {"grey": "0.35 0.36 0.38 1", "blue": "0.2 0.45 0.75 1", "orange": "0.9 0.5 0.15 1"}


@checked
def to_urdf(table: DHTable) -> str:
    """URDF text of a table: the same table gives the same bytes.

    Raises:
        InvalidTable: If a joint has the name of one of the URDF's own links or joints.
    """
    links = [f"link_{i}" for i in range(1, len(table.rows) + 1)]
    for i, name in enumerate(table.joint_names, start=1):
        if name in (*_OWN, *links):
            raise InvalidTable(f"{table.name}: joint {i} cannot be named {name!r}: its URDF has a part of that name")

    robot = ET.Element("robot", name=table.name)
    robot.append(ET.Comment(" Written from a DH table by pin_metaik; change the table instead. "))
    for colour, rgba in _COLOURS.items():
        ET.SubElement(ET.SubElement(robot, "material", name=colour), "color", rgba=rgba)

    steps = _steps(table)
    radii = _radii(table)
    if table.base != Placement():
        ET.SubElement(robot, "link", name="world")
        _joint(robot, "base_joint", "fixed", "world", "base_link", table.base)
    _link(robot, "base_link", _body(steps[0].xyz), radii[0])
    parents = ["base_link", *links]
    for i, (row, name) in enumerate(zip(table.rows, table.joint_names, strict=True)):
        _joint(robot, name, row.type, parents[i], links[i], steps[i], row)
        _link(robot, links[i], _body(steps[i + 1].xyz, row), radii[i], row)
    _joint(robot, "flange_joint", "fixed", links[-1], "flange", steps[-1])
    _link(robot, "flange", [(_ORIGIN, table.tool.xyz)], radii[-1])
    _joint(robot, "tool0_joint", "fixed", "flange", "tool0", table.tool)
    ET.SubElement(robot, "link", name="tool0")

    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


@checked
def write_urdfs(folder: str | Path) -> list[Path]:
    """Write the URDF of every table in the catalogue into a folder, which is made if need be; returns the files.

    Raises:
        CannotWrite: It cannot be made or written into.
    """
    folder = writable(folder, folder=True)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, path in catalogue().items():
        file = folder / f"{name}.urdf"
        file.write_text(to_urdf(read_table(path)), encoding="utf-8", newline="\n")
        written.append(file)
    return written


def _steps(table: DHTable) -> list[Placement]:
    """The n + 1 fixed steps: from frame 0 to the first axis, between axes, and from the last axis to the flange."""
    still = DHRow()
    before, after = [still, *table.rows], [*table.rows, still]  # the rows on both sides of each step
    xs = before if table.convention == "standard" else after
    return [
        Placement((_tidy(x.a * cos(z.theta)), _tidy(x.a * sin(z.theta)), z.d), (x.alpha, 0.0, z.theta))
        for z, x in zip(before, xs, strict=True)
    ]


def _tidy(value: float) -> float:
    """Without the last bits, in which cos(pi/2) is not 0 and machines differ."""
    return round(value, 15) + 0.0


def _radii(table: DHTable) -> list[float]:
    """Radius of each link (m): 4 % of the arm's length at the base, tapering to 2 % at the tip."""
    travel = [max(abs(row.lower), abs(row.upper)) for row in table.rows if row.type == "prismatic"]
    reach = sum(abs(row.a) + abs(row.d) for row in table.rows) + sum(travel) or 1.0
    n = len(table.rows)
    return [reach * (0.04 - 0.02 * i / max(n - 1, 1)) for i in range(n)]


def _body(end: Point, row: DHRow | None = None) -> list[Segment]:
    """Where a link is in its own frame: along z, then along x to the next axis; a slide also back along its travel."""
    low, high = min(end[2], 0.0), max(end[2], 0.0)
    if row is not None and row.type == "prismatic":
        low, high = min(low, -row.upper), max(high, -row.lower)
    return [((0.0, 0.0, low), (0.0, 0.0, high)), ((0.0, 0.0, end[2]), end)]


def _joint(
    robot: ET.Element, name: str, kind: str, parent: str, child: str, origin: Placement, row: DHRow | None = None
) -> None:
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    _origin(joint, origin)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    if row is not None:
        limits = {} if row.type == "continuous" else {"lower": row.lower, "upper": row.upper}
        ET.SubElement(joint, "axis", xyz="0 0 1")
        ET.SubElement(joint, "limit", _numbers(effort=row.effort, velocity=row.velocity, **limits))


def _link(robot: ET.Element, name: str, body: list[Segment], radius: float, row: DHRow | None = None) -> None:
    """A link with its shapes; with a row it moves, so it has a mass, and if it turns a hub about its axis."""
    link = ET.SubElement(robot, "link", name=name)
    segments = [segment for segment in body if dist(*segment) > radius / 100]
    hub = ((0.0, 0.0, -1.5 * radius), (0.0, 0.0, 1.5 * radius))
    if row is not None:
        _inertial(link, max(segments, key=lambda segment: dist(*segment), default=hub), radius)
        if row.type != "prismatic":
            _cylinder(link, "visual", f"{name}_hub", hub, 1.2 * radius, "grey")
    for i, segment in enumerate(segments, start=1):
        _cylinder(link, "visual", f"{name}_visual_{i}", segment, radius, "blue" if row else "orange")
    for i, segment in enumerate(segments, start=1):
        _cylinder(link, "collision", f"{name}_capsule_{i}", segment, radius)
    if segments:
        checking = ET.SubElement(link, "collision_checking")
        for i in range(1, len(segments) + 1):
            ET.SubElement(checking, "capsule", name=f"{name}_capsule_{i}")


def _cylinder(link: ET.Element, kind: str, name: str, segment: Segment, radius: float, colour: str = "") -> None:
    shape = ET.SubElement(link, kind, name=name)
    _origin(shape, _along(segment))
    size = _numbers(radius=_tidy(radius), length=_tidy(dist(*segment)))
    ET.SubElement(ET.SubElement(shape, "geometry"), "cylinder", size)
    if colour:
        ET.SubElement(shape, "material", name=colour)


def _inertial(link: ET.Element, segment: Segment, radius: float) -> None:
    """Solid cylinder of 1 kg about a segment."""
    inertial = ET.SubElement(link, "inertial")
    _origin(inertial, _along(segment))
    ET.SubElement(inertial, "mass", _numbers(value=_MASS))
    across = _tidy(_MASS * (3 * radius**2 + dist(*segment) ** 2) / 12)
    about = _tidy(_MASS * radius**2 / 2)
    ET.SubElement(inertial, "inertia", _numbers(ixx=across, iyy=across, izz=about, ixy=0, ixz=0, iyz=0))


def _along(segment: Segment) -> Placement:
    """Placement of a cylinder about a segment: its z along it, its origin in the middle."""
    start, end = segment
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    middle = (_tidy(start[0] + x / 2), _tidy(start[1] + y / 2), _tidy(start[2] + z / 2))
    return Placement(middle, (0.0, _tidy(atan2(hypot(x, y), z)), _tidy(atan2(y, x))))


def _origin(element: ET.Element, placement: Placement) -> None:
    triples = {"xyz": placement.xyz, "rpy": placement.rpy}
    ET.SubElement(
        element, "origin", {key: " ".join(_number(value) for value in triple) for key, triple in triples.items()}
    )


def _numbers(**values: float) -> dict[str, str]:
    return {key: _number(value) for key, value in values.items()}


def _number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(float(value) + 0.0)
