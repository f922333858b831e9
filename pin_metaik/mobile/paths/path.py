"""A path: a polyline with its length, written as CSV or JSON."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as File

import numpy as np
import shapely
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.optimize.settings import within
from pin_metaik.output import write_table


@dataclass(frozen=True, eq=False)
class Path:
    """Straight lines from point to point.

    Attributes:
        points: (n, 2) start, corners and goal, n >= 2; kept as a read-only array.

    Raises:
        InvalidGeometry: The points are not (n, 2) finite numbers.
    """

    points: Array

    def __post_init__(self) -> None:
        points = _points(self.points)
        points.flags.writeable = False
        object.__setattr__(self, "points", points)

    @cached_property
    def lengths(self) -> Array:
        """Length of each segment (n - 1,)."""
        along = np.diff(self.points, axis=0)
        return np.hypot(along[:, 0], along[:, 1])

    @property
    def length(self) -> float:
        """Length of the whole."""
        return float(self.lengths.sum())

    @property
    def corners(self) -> Array:
        """Where it bends: all points but start and goal (n - 2, 2)."""
        return self.points[1:-1]

    @checked
    def straightened(self, slack: float = 0.0) -> Path:
        """The same path without repeated points and points (nearly) on the line between their neighbours.

        Args:
            slack: Points nearer to that line than this are left out, in the path's unit.
        """
        kept = [self.points[0]]
        for point, following in zip(self.points[1:-1], self.points[2:], strict=True):
            across, ahead = _offset(kept[-1], following, point)
            repeated = np.hypot(*(point - kept[-1])) <= slack
            if not repeated and not (across <= slack and ahead):
                kept.append(point)
        return Path(np.array([*kept, self.points[-1]]))

    @checked
    def simplified(self, deviation: float) -> Path:
        """The path with fewer points, for paths of grids and samplers: start, goal and some of the points between.

        Every point left out is within ``deviation`` of the new path (Douglas and Peucker 1973), whose clearance is
        smaller by at most that. Few sharp turns are driven faster than many small ones.

        Args:
            deviation: In the path's unit, at least 0.

        Raises:
            InvalidSetting: A deviation below zero.
        """
        within("deviation", deviation, 0)
        fewer = shapely.simplify(shapely.LineString(self.points), deviation, preserve_topology=False)
        return Path(shapely.get_coordinates(fewer))

    @checked
    def write(self, file: str | File) -> None:
        """Write x and y of the points as CSV."""
        write_table(file, ("x", "y"), self.points)


def _offset(a: Array, b: Array, point: Array) -> tuple[float, bool]:
    """Distance of a point from the line a-b, and whether it lies between them."""
    along, to = b - a, point - a
    length = np.hypot(*along)
    if length == 0.0:
        return float(np.hypot(*to)), False
    return abs(float(along[0] * to[1] - along[1] * to[0])) / float(length), 0 <= float(to @ along) <= float(length) ** 2


def _points(values: ArrayLike) -> Array:
    points = array("a path is at least two points (x, y)", values, "n", 2, error=InvalidGeometry).copy()
    if len(points) < 2:
        raise InvalidGeometry(f"a path is at least two points (x, y), finite; got {shown(values)}")
    return points
