"""Meshes in PLY (Turk, 1994), text or binary. coal's reader trusts the numbers of corners, and so ends the process.

A header names elements and their properties; a row an element follows, in text a line. A property is a number, or a
list: its length and so many numbers. What this reader would understand in another way than coal's is refused:
characters that only one of them takes for the end of a line, spellings that only one of them takes for a number.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, repeat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pin_metaik.files import Error, read_bytes

NAMES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
NAMES |= {"float": "f4", "double": "f8"}
SIZES = {"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"}
TYPES = NAMES | SIZES | {"float32": "f4", "float64": "f8"}
FORMS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
SUFFIX = ".ply"
MAGIC = b"ply"
CORNERS = ("vertex_indices", "vertex_index")
HEADER = re.compile(rb"ply[\t -~\x80-\xff\r\n]*?[\r\n]end_header\r?\n")
ROWS = re.compile(rb"[0-9.eE+\-naifNAIF\t\r\n ]*")
WHOLE = re.compile(rb"-?[0-9]+")

Numbers = NDArray[np.float64]
Take = Callable[[str, int], Numbers]
"""The next so many numbers of a type, of the same row."""


@dataclass(frozen=True)
class Property:
    """A property of an element: its name, its type, and of a list also the type of its length."""

    name: str
    kind: str
    length: str = ""


@dataclass(frozen=True)
class Element:
    """A kind of element, how many there are, and what each of them has."""

    name: str
    count: int
    properties: tuple[Property, ...]

    def rows(self, takes: Iterator[Take]) -> list[dict[str, Numbers]]:
        """The values of each of them, by property."""
        return [{p.name: take(p.kind, int(take(p.length, 1)[0]) if p.length else 1) for p in self.properties}
                for take in islice(takes, self.count)]  # fmt: skip


def read_ply(path: Path, error: Error) -> tuple[Numbers, NDArray[np.int64]]:
    """Vertices (k, 3) and triangles (m, 3) of a file; polygons are split from their first corner.

    Args:
        path: The file.
        error: What to raise if it is no such file, ends early, or has a corner that is none of its vertices.
    """
    try:
        content = read_bytes(path, error)
        form, elements, start = _header(content)
        takes = _binary(content[start:], FORMS[form]) if FORMS[form] else _text(content[start:])
        if sum(element.count for element in elements) > len(content):
            raise ValueError("it has not as many bytes as rows")
        rows = {element.name: element.rows(takes) for element in elements}
        next(takes, None)  # the last line, too, has no more numbers than it should
        if any(len(rows[element.name]) < element.count for element in elements):
            raise ValueError("it ends early")
        vertices = np.array([[row[axis][0] for axis in "xyz"] for row in rows["vertex"]]).reshape(-1, 3)
        faces = [next(row[name] for name in CORNERS if name in row) for row in rows["face"]]
    except (KeyError, StopIteration):
        raise error(f"{path} is not a PLY mesh: it lacks x, y, z or triangles, or has an unknown type") from None
    except (ValueError, OverflowError) as reason:  # the latter of a length that is infinite
        raise error(f"{path} is no mesh in PLY: {reason}") from None
    if any(len(face) < 3 for face in faces):  # coal's reader looks at the third corner of each
        raise error(f"{path} has faces of fewer than three corners")
    parts = [(face[0], b, c) for face in faces for b, c in zip(face[1:-1], face[2:], strict=True)]
    corners = np.array(parts, dtype=float).reshape(-1, 3)
    if not ((corners >= 0.0) & (corners < len(vertices)) & (corners == np.floor(corners))).all():
        raise error(f"{path} has triangles with indices outside its {len(vertices)} vertices")
    return vertices, corners.astype(np.int64)


def _header(content: bytes) -> tuple[str, list[Element], int]:
    """The form, the elements, and where their rows begin."""
    header = HEADER.match(content)
    if header is None:
        raise ValueError("its header is not whole")
    form, elements = "", list[Element]()
    for line in header[0].splitlines():
        match line.decode("latin-1").split():
            case ["format", one, _]:
                form = one
            case ["element", name, count]:
                elements.append(Element(name, int(count), ()))
            case ["property", "list", length, kind, name] if elements:
                _add(elements, Property(name, TYPES[kind], TYPES[length]))
            case ["property", kind, name] if elements:
                _add(elements, Property(name, TYPES[kind]))
            case [("ply" | "comment" | "obj_info" | "end_header"), *_] | []:
                pass
            case words:
                raise ValueError(f"its header has a line {' '.join(words)!r}")
    if any(element.count < 0 or (element.count and not element.properties) for element in elements):
        raise ValueError("an element has no properties, or a negative number of rows")
    return form, elements, header.end()


def _add(elements: list[Element], one: Property) -> None:
    """Add a property to the last element."""
    last = elements[-1]
    elements[-1] = Element(last.name, last.count, (*last.properties, one))


def _text(content: bytes) -> Iterator[Take]:
    """What takes numbers from each line of a text."""
    if not ROWS.fullmatch(content):
        raise ValueError("its rows have something else than numbers")
    for line in content.splitlines():
        words, at = line.split(), 0
        numbers = np.array(words, dtype=float)

        def take(kind: str, count: int, words: list[bytes] = words, numbers: Numbers = numbers) -> Numbers:
            nonlocal at
            at += _fits(count, len(words) - at)
            if kind[0] in "iu" and not all(map(WHOLE.fullmatch, words[at - count : at])):
                raise ValueError("a whole number is not written as one")
            return np.asarray(numbers[at - count : at])

        yield take
        if at != len(words):
            raise ValueError("a line has more numbers than its element")


def _binary(content: bytes, order: str) -> Iterator[Take]:
    """What takes numbers from bytes, which rows follow each other in."""
    at = 0

    def take(kind: str, count: int) -> Numbers:
        nonlocal at
        size = np.dtype(kind).itemsize
        at += size * _fits(count, (len(content) - at) // size)
        return np.frombuffer(content, order + kind, count, at - size * count).astype(float)

    return repeat(take)


def _fits(count: int, room: int) -> int:
    """How many numbers to take, where so many are left."""
    if not 0 <= count <= room:
        raise ValueError("it ends early, or a line does")
    return count
