"""The free space of a scene: where a robot's centre may be, and the test whether a path stays in it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.errors import Blocked
from pin_metaik.mobile.world.growth import Join, grow
from pin_metaik.mobile.world.scene import Point, Scene
from pin_metaik.optimize.space import Array

TOUCH = 1e-10  # of the workspace's width: contact is free, and this is how deep contact may seem by rounding
GRID = 0.1  # of that: corners are rounded to a grid so fine, which closes seams


@dataclass(frozen=True, eq=False)
class FreeSpace:
    """The workspace without the obstacles grown by a clearance. Its border belongs to it: touching is free.

    Obstacles are joined first, among themselves and with the walls: there is no way along a seam, nor along one that
    was exact on paper and is a hair wide since the obstacles were turned.

    Attributes:
        scene: The world; its start and goal do not matter here.
        clearance: Distance from obstacles and walls, in the scene's unit.
        region: The free polygons.
    """

    scene: Scene
    clearance: float
    region: shapely.Geometry

    @staticmethod
    @checked
    def of(scene: Scene, clearance: float = 0.0, join: Join = "mitre") -> FreeSpace:
        """The free space of a scene.

        Args:
            scene: The world.
            clearance: Distance to keep from obstacles and walls: the robot's radius and a margin.
            join: How grown obstacles end at their corners: ``mitre`` or ``round``.

        Raises:
            InvalidSetting: A clearance below zero, or no such join.
        """
        x_min, y_min, x_max, y_max = scene.box
        grown = grow(scene.obstacles, clearance, join)
        if x_max - x_min <= 2 * clearance or y_max - y_min <= 2 * clearance:
            return FreeSpace(scene, clearance, shapely.Polygon())
        inside = shapely.box(x_min + clearance, y_min + clearance, x_max - clearance, y_max - clearance)
        grid = 10.0 ** math.floor(math.log10(GRID * TOUCH * _extent(scene.box)))
        region = shapely.difference(inside, shapely.union_all(grown, grid_size=grid), grid_size=grid)
        parts = shapely.get_parts(shapely.set_precision(region, 0).simplify(grid))
        thin = 2 * shapely.area(parts) < TOUCH * _extent(scene.box) * shapely.length(parts)
        return FreeSpace(scene, clearance, shapely.multipolygons(parts[~thin]))

    @property
    def extent(self) -> float:
        """Width of the workspace, the larger of the two."""
        return _extent(self.scene.box)

    @property
    def touch(self) -> float:
        """How deep inside an obstacle still counts as touching it."""
        return TOUCH * self.extent

    @property
    def box(self) -> tuple[float, float, float, float]:
        """The workspace inside its walls (x_min, y_min, x_max, y_max), smaller by the clearance."""
        x_min, y_min, x_max, y_max = self.scene.box
        r = self.clearance
        return x_min + r, y_min + r, x_max - r, y_max - r

    @cached_property
    def blocked(self) -> shapely.Geometry:
        """Obstacles and walls as one region."""
        x_min, y_min, x_max, y_max = self.scene.box
        beyond = self.extent
        return shapely.box(x_min - beyond, y_min - beyond, x_max + beyond, y_max + beyond).difference(self.region)

    @cached_property
    def core(self) -> shapely.Geometry:
        """What no path may meet: obstacles and walls without the skin that may be touched."""
        core = self.blocked.buffer(-self.touch, join_style="mitre")
        shapely.prepare(core)
        return core

    @cached_property
    def solid(self) -> shapely.Geometry:
        """The obstacles as they are given, joined."""
        return shapely.union_all(self.scene.obstacles)

    def holds(self, path: Array) -> bool:
        """Whether a path (n, 2) is free of collisions: the exact test, on the whole of it and not on samples."""
        line = _line(path)
        return bool(np.isfinite(path).all()) and not self.core.intersects(line)

    def distance(self, path: Array) -> float:
        """Distance of a path (n, 2) from the nearest obstacle as given, not grown; inf without obstacles."""
        line = _line(path)
        return float(line.distance(self.solid)) if self.scene.obstacles else float("inf")

    @checked
    def check(self, role: str, point: Point) -> None:
        """Make sure that the robot may be somewhere.

        Raises:
            Blocked: It may not; the error names the nearest place that is free.
        """
        place = shapely.Point(point)
        if self.region.distance(place) <= self.touch:
            return
        nearest = None
        if not self.region.is_empty:
            free = shapely.get_coordinates(shapely.shortest_line(self.region, place))[0]
            nearest = (float(free[0]), float(free[1]))
        raise Blocked(role, point, self.clearance, nearest)


def _line(path: Array) -> shapely.LineString:
    """A path (n, 2) that somebody gave, n >= 2.

    Raises:
        InvalidGeometry: It is none.
    """
    points = array("path", path, "n", 2, error=InvalidGeometry, finite=False)
    if len(points) < 2:
        raise InvalidGeometry(f"a path has at least two points, got {len(points)}")
    return shapely.LineString(points)


def _extent(box: tuple[float, float, float, float]) -> float:
    return max(box[2] - box[0], box[3] - box[1])
