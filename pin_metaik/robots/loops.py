"""Closed loops of an MJCF: its ``<connect>`` and ``<weld>`` as Pinocchio's constraints."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any, TypeAlias

import pinocchio as pin

from pin_metaik.robots.text import mjcf_tree

Loops: TypeAlias = tuple[Any, ...]
"""Of ``pin.PointAnchorConstraintModel`` and ``pin.FrameAnchorConstraintModel``."""
CLOSED_BY = ("connect", "weld")


def read_loops(path: str, text: str) -> Loops:
    """The loops of an MJCF file, those that are active, each under its own name.

    Args:
        path: The file.
        text: Its text: Pinocchio has neither the names of loops nor whether they are active.
    """
    _, points, frames = pin.buildModelAndConstraintsFromMJCF(path)
    loops = []
    for tag, found in zip(CLOSED_BY, (points, frames), strict=True):
        for element, loop in zip(_equalities(text, tag), found, strict=True):
            if element.get("active", "true") == "true":
                loop.name = element.get("name", "")
                loops.append(loop)
    return tuple(loops)


def equalities_not_read(text: str) -> list[str]:
    """Kinds of ``<equality>`` in an MJCF that close no loop, such as ``joint``: Pinocchio leaves them out."""
    return sorted({element.tag for element in _equalities(text, "*")} - {*CLOSED_BY})


def _equalities(text: str, tag: str) -> list[ET.Element]:
    return mjcf_tree(text).findall(f"./equality/{tag}")
