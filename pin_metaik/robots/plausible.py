"""Numbers that are probably in another unit, degrees or millimetres: they are taken unchanged, with a remark."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from math import degrees, hypot, inf, nan, pi

import pinocchio as pin

from pin_metaik.robots.dh import DHTable

TURN = 2.0 * pi
MANY_TURNS = 10 * TURN  # a multiple of a quarter turn up to here is a deliberate limit
PRACTICALLY_NONE = (10.0, 1000.0)  # rad; how people write that there is no limit: this one, or from the other on
FAR = 100.0  # m; no arm gets that far
ENDLESS = 1e5  # m; a slide as long as this is a moving base


def range_in_degrees(name: str, lower: float, upper: float) -> str:
    """A remark on the limits (rad) of a joint that turns, if they are probably in degrees; else nothing."""
    if not any(_is_limit_in_degrees(abs(limit)) for limit in (lower, upper)):
        return ""
    return f"joint {name!r} has limits [{lower:g}, {upper:g}] rad: probably degrees"


def numbers(robot: ET.Element) -> list[str]:
    """Remarks on the limits, origins and shapes of a URDF."""
    remarks = [*_reach(robot)]
    for joint in robot.iterfind("joint"):
        name = f"joint {joint.get('name', '')!r}"
        remarks += [_limits(joint, name), _turned(joint, name)]
    for link in robot.iterfind("link"):
        for shape in (*link.iterfind("visual"), *link.iterfind("collision")):
            place = f"a {shape.tag} of link {link.get('name', '')!r}"
            remarks += [_turned(shape, place), *_large(shape, place)]
    return [remark for remark in remarks if remark]


def meshes(geometry: pin.GeometryModel) -> list[str]:
    """Remarks on meshes that are probably in millimetres."""
    remarks = []
    for shape in geometry.geometryObjects:
        if hasattr(shape.geometry, "num_vertices"):
            shape.geometry.computeLocalAABB()
            if FAR < 2.0 * shape.geometry.aabb_radius < inf:
                size = 2.0 * shape.geometry.aabb_radius
                remarks.append(f"the mesh {shape.name!r} is {size:.0f} m across: probably millimetres")
    return remarks


def angles_in_radians(table: DHTable) -> list[str]:
    """Remarks on angles of a DH table that are read as degrees and were probably radians: 1.5708, 3.1416."""
    return [
        f"joint {name!r} has {key} = {degrees(value):.6g} degrees: probably radians"
        for name, row in zip(table.joint_names, table.rows, strict=True)
        for key in ("alpha", "theta", "lower", "upper")
        if not (row.type == "prismatic" and key in ("lower", "upper"))
        and 1e-3 < abs(value := getattr(row, key)) < TURN / 50
        and _is_near_a_multiple(degrees(value), pi / 2, 2e-3)
    ]


def _is_limit_in_degrees(size: float) -> bool:
    """Whether a limit of so many radians is one that people write in degrees: 90, 170; not 4 pi, 6.98, 10 or 1e6."""
    idle, none = PRACTICALLY_NONE
    if not 1.05 * TURN < size < none or size == idle or _is_quarter_turns(size):
        return False
    return size > 3 * TURN or _is_near_a_multiple(size, 5.0, 1e-9)


def _is_quarter_turns(size: float) -> bool:
    return size < MANY_TURNS and _is_near_a_multiple(size, pi / 2, 5e-3)


def _is_near_a_multiple(value: float, unit: float, room: float) -> bool:
    return abs(value - unit * round(value / unit)) < room


def _limits(joint: ET.Element, place: str) -> str:
    limit, kind = joint.find("limit"), joint.get("type")
    if limit is None or kind not in ("revolute", "prismatic"):
        return ""
    lower, upper = (_floats(limit.get(key, "0"))[0] for key in ("lower", "upper"))
    if kind == "revolute":
        return range_in_degrees(joint.get("name", ""), lower, upper)
    if max(abs(lower), abs(upper)) > FAR and upper - lower < ENDLESS:
        return f"{place} has limits [{lower:g}, {upper:g}] m: probably millimetres"
    return ""


def _turned(element: ET.Element, place: str) -> str:
    origin = element.find("origin")
    rpy = "0 0 0" if origin is None else origin.get("rpy", "0 0 0")
    if any(abs(angle) > 1.05 * TURN and not _is_quarter_turns(abs(angle)) for angle in _floats(rpy)):
        return f"{place} has rpy = {rpy} rad: probably degrees"
    return ""


def _reach(robot: ET.Element) -> Iterable[str]:
    """A remark on the limb that reaches farther than any arm, naming its longest step."""
    steps: dict[str, tuple[float, str, str]] = {}  # by the child link: length, name of the joint, parent link
    for joint in robot.iterfind("joint"):
        ends = {end.tag: end.get("link", "") for end in joint if end.tag in ("parent", "child")}
        origin = joint.find("origin")
        length = 0.0 if origin is None else hypot(*_floats(origin.get("xyz", "0 0 0")))
        steps[ends.get("child", "")] = length, joint.get("name", ""), ends.get("parent", "")
    reach: dict[str, tuple[float, tuple[float, str]]] = {}
    for link in steps:
        total, longest, way = 0.0, (0.0, ""), set()
        while link in steps and link not in way:
            way.add(link)
            length, name, link = steps[link]
            total, longest = total + length, max(longest, (length, name))
        reach[longest[1]] = total, longest
    total, (length, name) = max(reach.values(), default=(0.0, (0.0, "")))
    if total > FAR:
        yield f"the links reach {total:.0f} m, {length:.0f} m of it by joint {name!r}: probably millimetres"


def _large(shape: ET.Element, place: str) -> Iterable[str]:
    for part in shape.iter():
        for key in ("size", "radius", "length", "xyz"):
            if any(FAR < abs(value) < inf for value in _floats(part.get(key, "0"))):
                yield f"{place} has {key} = {part.get(key)} m: probably millimetres"


def _floats(text: str) -> list[float]:
    try:
        return [float(value) for value in text.split()] or [nan]
    except ValueError:
        return [nan]  # for the parser to name
