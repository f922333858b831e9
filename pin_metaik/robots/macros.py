"""Xacro, the macro language of URDF files: detected, and expanded by the package ``xacro``."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from xml.dom.minidom import Document

from pin_metaik.errors import InvalidModel
from pin_metaik.lookup import need
from pin_metaik.robots.prints import caught_prints
from pin_metaik.robots.text import outermost, parsed

_CARRY_NUMBERS = ("link", "joint", "origin", "axis", "limit", "parent", "child", "mimic")
_QUOTES_CLOSED = re.compile(r"""(?:'[^'\n]*'|"[^"\n]*"|[^'"])*+""")


def sign_of_xacro(tree: ET.Element) -> str:
    """The first thing in a URDF's tree that only xacro understands, as it is written there; empty if there is none."""
    for element in tree.iter():
        if element.tag.startswith("xacro:"):
            return f"<{element.tag}>"
        if element.tag in _CARRY_NUMBERS:
            for key, value in element.attrib.items():
                if "${" in value or "$(" in value:
                    return f'{key}="{value}"'
    return ""


def is_xacro(text: str, what: str) -> bool:
    """Whether a text is xacro that has to be expanded."""
    perhaps = "xacro:" in text or "${" in text or "$(" in text
    return perhaps and outermost(text) == "robot" and bool(sign_of_xacro(parsed(text, what)))


def expanded(text: str, source: Path | None, what: str, arguments: Mapping[str, object]) -> str:
    """The URDF that xacro makes of a text.

    Packages of ``$(find package)`` are looked for where ROS has them, and by the package ``xacrodoc``, where it is
    installed, in the folders above the file.

    Args:
        text: The xacro.
        source: Its file, beside which others are that it includes.
        what: The file, as messages call it.
        arguments: Values of its ``<xacro:arg>``.

    Raises:
        MissingExtra: If the package ``xacro`` is not installed.
        InvalidModel: If it cannot be expanded; the message has xacro's own reason.
    """
    need(f"{what} is xacro: to expand it", "xacro", "xacro")
    import xacro

    if source is not None and find_spec("xacrodoc"):
        from xacrodoc import packages

        packages.walk_up_from(source.absolute())
    path = None if source is None else str(source.absolute())
    try:
        with caught_prints():
            xacro.init_stacks(path)
            document = xacro.parse(text)
            _check_parameters(document)
            xacro.process_doc(document, mappings={name: _word(value) for name, value in arguments.items()})
    except Exception as error:  # the expressions of the file are evaluated, and may raise anything
        why = " ".join(str(error).split()) or type(error).__name__
        raise InvalidModel(f"{what} is xacro that cannot be expanded: {why}") from None
    return str(document.toxml())


def _check_parameters(document: Document) -> None:
    """Refuse what xacro would never come back from: its search for a default's end is exponential after an open quote.

    Raises:
        ValueError: The parameters of a macro have a quote that is not closed.
    """
    for macro in document.getElementsByTagName("xacro:macro"):
        if not _QUOTES_CLOSED.fullmatch(macro.getAttribute("params")):
            raise ValueError(f"the parameters of macro '{macro.getAttribute('name')}' have a quote that is not closed")


def _word(value: object) -> str:
    """A value as xacro has it on its command line."""
    return str(value).lower() if isinstance(value, bool) else str(value)
