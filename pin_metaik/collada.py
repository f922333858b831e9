"""Meshes in COLLADA (.dae): what makes coal's reader run for ever, or ask for all memory, is found before it reads.

Its lists of numbers of corners are read until as many were found as were said, and a word that is no whole number is
never passed.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

from pin_metaik.files import DEEPEST, Error

SUFFIX = ".dae"
MAGIC = b"<COLLADA"
WHOLE = ("p", "h", "ph", "v", "vcount")  # elements whose words are whole numbers
COUNTS = ("count", "stride", "offset", "set")  # attributes that are whole numbers
NO_NUMBER = re.compile(r"(?!-?\d{1,18}(?!\S))\S+")


def check_collada(path: Path, error: Error) -> None:
    """Make sure that a file can be handed to coal's reader.

    Args:
        path: The file.
        error: What to raise if it is no XML, has a word where a number of a corner stands, or says that it has more
            values than bytes.
    """
    try:
        size = path.stat().st_size
        _check(path, size)
    except OSError as reason:
        raise error(f"cannot read {path}: {reason.strerror}") from None
    except (ET.ParseError, ValueError) as reason:
        raise error(f"{path} is no mesh in COLLADA: {reason}") from None


def _check(path: Path, size: int) -> None:
    depth = 0
    for event, element in ET.iterparse(path, ("start", "end")):
        name = element.tag.rpartition("}")[2]
        if event == "start":
            depth += 1
            if depth > DEEPEST:
                raise ValueError("its elements are nested too deeply")
            for key in COUNTS:
                value = element.get(key, "0").strip()
                if not value.isdecimal() or int(value) > size:
                    raise ValueError(f"{key} of <{name}> is {value!r}, and the file has {size} bytes")
            continue
        depth -= 1
        if name in WHOLE and (wrong := NO_NUMBER.search(element.text or "")):
            raise ValueError(f"<{name}> has {wrong.group()[:40]!r} where a whole number stands")
