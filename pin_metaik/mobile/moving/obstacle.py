"""An obstacle that moves without turning: an outline, and its position over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import known_keys, read_json
from pin_metaik.mobile.curves.footprint import Footprint

FACES = 64  # of the polygon round a disc: it is 0.12 percent of the radius larger at most


@checked
@dataclass(frozen=True, eq=False)
class MovingObstacle:
    """A convex outline that moves along straight lines, at constant speed from one time to the next, and does not turn.

    Before its first time it is at rest at its first position, and after its last time at its last one.

    Attributes:
        footprint: Its outline around its own origin: a convex polygon, or a disc (``Footprint.disc``). An outline that
            is not convex is given as several obstacles with the same ``way``.
        way: (k, 3) rows of time in s (increasing), x and y of its origin in m.
        name: What to call it.

    Raises:
        InvalidGeometry: ``way`` has no row, numbers that are not finite, or times that do not increase.
    """

    footprint: Footprint
    way: Array
    name: str = "moving obstacle"

    def __post_init__(self) -> None:
        way = array("way: rows of time, x and y", self.way, "k", 3, error=InvalidGeometry).copy()
        if not len(way) or not (np.diff(way[:, 0]) > 0).all():
            raise InvalidGeometry("way: at least one row of time, x and y; times rise from row to row")
        way.flags.writeable = False
        object.__setattr__(self, "way", way)

    @checked
    def at(self, t: Any) -> Array:
        """Places (n, 2) of its origin at times t (n,), s."""
        times = np.atleast_1d(array("t", t, "...")).ravel()
        return np.column_stack([np.interp(times, self.way[:, 0], self.way[:, i]) for i in (1, 2)])

    @checked
    def planes(self, clearance: float) -> Array:
        """Half-planes (m, 3), unit normal and offset, of the outline grown by a clearance and by what is around it."""
        corners = self.footprint.corners
        sides = np.roll(corners, -1, axis=0) - corners
        lengths = np.hypot(*sides.T)
        across = sides[lengths > 0] / lengths[lengths > 0, None]
        turns = np.linspace(0, 2 * np.pi, FACES, endpoint=False)
        directions = np.column_stack((np.cos(turns), np.sin(turns)))
        own = np.column_stack((across[:, 1], -across[:, 0]))
        normals = np.vstack((own, -own, directions))
        reach = (normals @ corners.T).max(axis=1) + clearance + self.footprint.around
        return np.column_stack((normals, reach))

    @checked
    def legs(self, number: int) -> Array:
        """Its legs (k + 1, 7) as the kernel takes them: number, begin, end, x, y at the beginning, velocity."""
        t, xy = self.way[:, 0], self.way[:, 1:]
        velocity = np.diff(xy, axis=0) / np.diff(t)[:, None]
        stands = np.zeros((1, 2))
        return np.column_stack(
            (
                np.full(len(t) + 1, float(number)),
                np.concatenate(([-np.inf], t)),
                np.concatenate((t, [np.inf])),
                np.vstack((xy[:1], xy)),
                np.vstack((stands, velocity, stands)),
            )
        )

    def as_dict(self) -> dict[str, Any]:
        """Plain values, as a file of moving obstacles has them."""
        outline = self.footprint
        return {
            "name": self.name,
            "outline": outline.corners.tolist(),
            "around": outline.around,
            "way": self.way.tolist(),
        }


@checked
def load_moving(source: str | Path) -> tuple[MovingObstacle, ...]:
    """Moving obstacles from a JSON file: a list of objects with ``way``, ``outline`` or ``radius``, perhaps ``name``.

    ``way`` has rows [time, x, y], ``outline`` the corners [x, y] of a convex polygon around the obstacle's origin, and
    ``around`` a distance round it; ``radius`` alone is a disc. In s and m.

    Raises:
        InvalidGeometry: The file is missing or malformed, or has an unknown key.
    """
    path = Path(source)
    given = read_json(path, InvalidGeometry)
    if not isinstance(given, list) or not all(isinstance(entry, dict) for entry in given):
        raise InvalidGeometry(f"{path}: expected a list of objects with way, and outline or radius")
    return tuple(_read(entry, f"{path}: obstacle {number}") for number, entry in enumerate(given, start=1))


def _read(entry: Mapping[str, Any], place: str) -> MovingObstacle:
    known_keys(entry, place, InvalidGeometry, ("way",), ("outline", "around", "radius", "name"))
    if ("outline" in entry) == ("radius" in entry):
        raise InvalidGeometry(f"{place}: give an outline or a radius, one of the two")
    if "radius" in entry and "around" in entry:
        raise InvalidGeometry(f"{place}: around is for an outline; a disc has a radius")
    try:
        if "radius" in entry:
            footprint = Footprint.disc(entry["radius"])
        else:
            footprint = Footprint(entry["outline"], entry.get("around", 0.0))
        return MovingObstacle(footprint, entry["way"], str(entry.get("name", place.rpartition(": ")[2])))
    except ValueError as error:  # one of ours
        raise InvalidGeometry(f"{place}: {error}") from None
