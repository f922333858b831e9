"""How the coordinates of legs are shown to people."""

from __future__ import annotations

from typing import NamedTuple


class Coordinate(NamedTuple):
    """How coordinates of legs are shown: their name, their unit, and its factor."""

    word: str
    unit: str
    one: float
