"""How the coordinates of legs are shown to people."""

from __future__ import annotations

from typing import NamedTuple


class Coordinate(NamedTuple):
    """How the coordinates of legs are shown to people: what they are called, in which unit, and how much that is."""

    word: str
    unit: str
    one: float
