"""The pairs of links that are not checked, read from and written to SRDF, the form every manipulation stack reads."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TypeAlias

from pin_metaik.errors import InvalidModel, UnknownName
from pin_metaik.files import read_text

Pair: TypeAlias = tuple[str, str]
"""Names of two links, the first by the alphabet first."""


def pair_of(first: str, second: str) -> Pair:
    """A pair whatever the order of its names."""
    return (first, second) if first <= second else (second, first)


def read_srdf(path: Path, links: Collection[str], *, strict: bool) -> dict[Pair, str]:
    """The pairs an SRDF disables, with its reasons.

    Args:
        path: The file.
        links: Names of the robot's links.
        strict: Whether a link that the robot lacks is an error, or its line left out.

    Raises:
        InvalidModel: If the file cannot be read, is not XML, or a line lacks a link.
        UnknownName: If a link does not exist.
    """
    try:
        root = ET.fromstring(read_text(path, InvalidModel, "an SRDF"))
    except ET.ParseError as error:
        raise InvalidModel(f"{path} is not an SRDF: {error}") from None
    pairs = {}
    for line in root.iter("disable_collisions"):
        first, second = line.get("link1"), line.get("link2")
        if first is None or second is None:
            raise InvalidModel(f"{path}: a disable_collisions names link1 and link2, got {line.attrib}")
        strangers = [name for name in (first, second) if name not in links]
        if strangers and strict:
            raise UnknownName("link", strangers[0], links)
        if not strangers:
            pairs[pair_of(first, second)] = line.get("reason") or "SRDF"
    return pairs


def write_srdf(path: Path, robot: str, pairs: Mapping[Pair, str]) -> None:
    """Write the pairs that are not checked, each with its reason, as an SRDF that ``read_srdf`` reads."""
    root = ET.Element("robot", name=robot)
    for (first, second), reason in sorted(pairs.items()):
        ET.SubElement(root, "disable_collisions", link1=first, link2=second, reason=reason)
    ET.indent(root)
    path.write_text(ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n", encoding="utf-8")
