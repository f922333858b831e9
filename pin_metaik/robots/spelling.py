"""Misspelt elements and attributes of a URDF, which the parser would ignore."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from difflib import get_close_matches

_PARTS = {
    "robot": ("link", "joint", "material", "transmission", "gazebo"),
    "link": ("inertial", "visual", "collision", "collision_checking"),
    "joint": ("origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration", "safety_controller"),
    "visual": ("origin", "geometry", "material"),
    "collision": ("origin", "geometry", "material"),
}
_ATTRIBUTES = {
    "joint": ("name", "type"),
    "origin": ("xyz", "rpy", "quat_xyzw"),
    "parent": ("link",),
    "child": ("link",),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"),
    "mimic": ("joint", "multiplier", "offset"),
}
_MEANT = {
    "min": "lower",
    "max": "upper",
    "pos": "xyz",
    "position": "xyz",
    "orientation": "rpy",
    "rotation": "rpy",
    "quat": "quat_xyzw",
    "ratio": "multiplier",
    "scale": "multiplier",
}
_LOOPS = ("loop", "loop_joint")
ALIKE = 0.75  # by difflib, 1 for equal


def misspelt(robot: ET.Element) -> list[str]:
    """Ignored elements and attributes in links and joints of a URDF: a remark for each, with the likely spelling."""
    remarks = [*_parts(robot, "the robot")]
    remarks += [
        f"<{e.tag}> {e.get('name', '')!r}: a URDF has no loops, this one stays open" for e in robot if e.tag in _LOOPS
    ]
    for element in robot:
        if element.tag in ("link", "joint"):
            place = f"{element.tag} {element.get('name', '')!r}"
            remarks += _parts(element, place)
            for inner in element.iter():
                remarks += _attributes(inner, place)
            for shape in (*element.iterfind("visual"), *element.iterfind("collision")):
                remarks += _parts(shape, place)
    return remarks


def _parts(element: ET.Element, place: str) -> Iterable[str]:
    known = _PARTS[element.tag]
    for part in element:
        if part.tag not in known and (near := get_close_matches(part.tag.lower(), known, 1, ALIKE)):
            yield f"{place} has an element <{part.tag}>, which is not read; did you mean <{near[0]}>?"


def _attributes(element: ET.Element, place: str) -> Iterable[str]:
    known = _ATTRIBUTES.get(element.tag, ())
    for key in sorted(set(element.attrib) - set(known)) if known else ():
        near = [_MEANT[key]] if _MEANT.get(key) in known else get_close_matches(key.lower(), known, 1, ALIKE)
        if near and near[0] not in element.attrib:
            yield (
                f"{place} has {key}={element.get(key)!r} in its <{element.tag}>, which is not read; "
                f"did you mean {near[0]}?"
            )
