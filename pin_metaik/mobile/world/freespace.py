"""The free space of a scene: where a robot's centre may be, and the test whether a path stays in it."""

from __future__ import annotations

import math
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.errors import Blocked
from pin_metaik.mobile.world.gaps import Contacts, opened
from pin_metaik.mobile.world.growth import MITRE_LIMIT, WITHIN, Join, grow
from pin_metaik.mobile.world.scene import Point, Scene
from pin_metaik.notice import notice

Box = tuple[float, float, float, float]

TOUCH = 1e-10  # of the workspace's width: contact is free, and this is how deep contact may seem by rounding
ROUNDED = 1e-12  # of the largest coordinate: the same, where a workspace lies so far out that digits run short
GRID = 0.1  # of that: corners are rounded to a grid so fine, which closes seams
LARGE = 5_000  # vertices from which on work may take seconds, and says so
HAIR = 4.0  # of that: half the thickness of a line or point that nothing grows


@dataclass(frozen=True, eq=False)
class FreeSpace:
    """The workspace minus the obstacles grown by a clearance. Its border belongs to it: touching is allowed.

    What has no width follows one rule, however the scene is given, in the planners, in the exact test and in the exact
    fitness. A gap between obstacles, or between an obstacle and a wall, is passable only if it is wider than 2e-10 of
    the workspace (or than 2e-12 of its largest coordinate, if that is more, because of the rounding of doubles). Where
    two obstacles touch, in a line or in a point, there is no passage. A part of a polygon that is thinner than that is
    not an obstacle. Lines and points always are: no path crosses a line.

    Attributes:
        scene: The scene; its start and goal are not used.
        clearance: Distance from obstacles and walls, in the scene's unit.
        region: The free polygons.
        join: How corners of grown obstacles are joined.
    """

    scene: Scene
    clearance: float
    region: shapely.Geometry
    join: Join = "mitre"

    @staticmethod
    @checked
    def of(scene: Scene, clearance: float = 0.0, join: Join = "mitre") -> FreeSpace:
        """The free space of a scene.

        Args:
            scene: The world.
            clearance: Distance to keep from obstacles and walls: the robot's radius and a margin.
            join: How corners of grown obstacles are joined: ``mitre`` or ``round``.

        Raises:
            InvalidSetting: A clearance below zero, or no such join.
            InvalidGeometry: Obstacles whose coordinates are too fine for doubles to be joined.
        """
        vertices = int(shapely.get_num_coordinates(scene.obstacles).sum())
        with notice(f"free space among {vertices:,} vertices") if vertices > LARGE else nullcontext():
            try:
                region = _region(scene, clearance, join)
            except shapely.errors.GEOSException as error:
                raise InvalidGeometry(
                    f"the obstacles of {scene.name} cannot be joined ({error}); move them nearer to the origin, or "
                    "give their coordinates fewer digits"
                ) from None
        return FreeSpace(scene, clearance, region, join)

    @property
    def walls(self) -> Box:
        """The workspace (x_min, y_min, x_max, y_max); in an unbounded plane, a box around all shortest paths."""
        return _walls(self.scene, self.clearance)

    @property
    def extent(self) -> float:
        """The larger of the width and the height of the workspace."""
        return _extent(self.walls)

    @property
    def touch(self) -> float:
        """How deep inside an obstacle still counts as touching it."""
        return _touch(self.walls)

    @property
    def hair(self) -> float:
        """Least distance by which lines and points are grown."""
        return HAIR * self.touch

    @checked
    def clearance_of(self, obstacle: shapely.Geometry) -> float:
        """By how much an obstacle is grown, m; lines and points by at least ``hair``."""
        return self.clearance if obstacle.geom_type == "Polygon" else max(self.clearance, self.hair)

    @property
    def box(self) -> Box:
        """The workspace (x_min, y_min, x_max, y_max) reduced by the clearance."""
        x_min, y_min, x_max, y_max = self.walls
        r = self.clearance
        return x_min + r, y_min + r, x_max - r, y_max - r

    @cached_property
    def blocked(self) -> shapely.Geometry:
        """Obstacles and walls as one region."""
        return _beyond(self.walls).difference(self.region)

    @cached_property
    def core(self) -> shapely.Geometry:
        """Obstacles and walls without their border, which may be touched: what no path may enter."""
        core = self.blocked.buffer(-self.touch, join_style="mitre")
        shapely.prepare(core)
        return core

    @cached_property
    def solid(self) -> shapely.Geometry:
        """The union of the obstacles, not grown."""
        return shapely.union_all(self.scene.obstacles)

    def holds(self, path: Array) -> bool:
        """Whether a path (n, 2) is free of collisions, by an exact test of its whole length, not of samples."""
        line = _line(path)
        return bool(np.isfinite(path).all()) and not self.core.intersects(line)

    @checked
    def connects(self, start: Point, goal: Point) -> bool:
        """Whether there is a path between two free positions."""
        parts, ends = shapely.get_parts(self.region), shapely.points([start, goal])
        return bool((shapely.distance(parts[:, None], ends) <= self.touch).all(axis=1).any())

    def distance(self, path: Array) -> float:
        """Distance of a path (n, 2) from the nearest original (not grown) obstacle; inf without obstacles."""
        line = _line(path)
        return float(line.distance(self.solid)) if self.scene.obstacles else float("inf")

    @checked
    def check(self, role: str, point: Point) -> None:
        """Check that the robot may be at a position.

        Raises:
            Blocked: It may not; the error names the nearest free position.
        """
        place = shapely.Point(point)
        if self.region.distance(place) <= self.touch:
            return
        nearest = None
        if not self.region.is_empty:
            free = shapely.get_coordinates(shapely.shortest_line(self.region, place))[0]
            nearest = (float(free[0]), float(free[1]))
        raise Blocked(role, point, self.clearance, nearest, self.join if self._keeps(place) else None)

    def _keeps(self, place: shapely.Point) -> bool:
        """Whether a place keeps the clearance from obstacles and walls, whatever the corners of grown obstacles say."""
        if not self.clearance:
            return False
        x_min, y_min, x_max, y_max = self.box
        within = (
            x_min - self.touch <= place.x <= x_max + self.touch and y_min - self.touch <= place.y <= y_max + self.touch
        )
        return within and self.distance(shapely.get_coordinates([place, place])) >= self.clearance

    @checked
    def nearly_connects(self, start: Point, goal: Point) -> float | None:
        """A smaller clearance with which there is a path between two positions; None if there is none.

        It is smaller by half a percent, so that the obstacles grown by it lie within the exact clearance everywhere: if
        there is no path even among these, there is none at the full clearance.
        """
        if not self.clearance:
            return None
        smaller = WITHIN * self.clearance
        return smaller if FreeSpace.of(self.scene, smaller, "round").connects(start, goal) else None


def _region(scene: Scene, clearance: float, join: Join) -> shapely.Geometry:
    """The region of the robot: inside the walls, outside the grown obstacles, without contacts and slivers."""
    box = x_min, y_min, x_max, y_max = _walls(scene, clearance)
    touch = _touch(box)
    flat = [obstacle for obstacle in scene.obstacles if obstacle.geom_type != "Polygon"]
    solid = [obstacle for obstacle in scene.obstacles if obstacle.geom_type == "Polygon"]
    grown = [*grow(solid, clearance, join), *grow(flat, max(clearance, HAIR * touch), join)]
    if x_max - x_min <= 2 * clearance or y_max - y_min <= 2 * clearance:
        return shapely.Polygon()
    inside = shapely.box(x_min + clearance, y_min + clearance, x_max - clearance, y_max - clearance)
    region = _without(inside, shapely.union_all(grown), touch)
    contacts = Contacts.of(region, touch)
    if len(contacts.corners) or contacts.slivers:
        closed = shapely.union_all([_beyond(box).difference(region), *contacts.plugs(touch)])
        region = _without(inside, opened(closed, touch) if contacts.slivers else closed, touch)
    return region


def _without(inside: shapely.Geometry, solid: shapely.Geometry, touch: float) -> shapely.Geometry:
    """The free polygons inside the walls, on a grid, without those of no width."""
    grid = 10.0 ** math.floor(math.log10(GRID * touch))
    region = shapely.difference(inside, solid, grid_size=grid)
    parts = shapely.get_parts(shapely.set_precision(region, 0).simplify(grid))
    thin = 2 * shapely.area(parts) < touch * shapely.length(parts)
    return shapely.multipolygons(parts[~thin])


def _beyond(box: Box) -> shapely.Polygon:
    """The workspace and as much again on every side."""
    x_min, y_min, x_max, y_max = box
    room = _extent(box)
    return shapely.box(x_min - room, y_min - room, x_max + room, y_max + room)


def _line(path: Array) -> shapely.LineString:
    """A path (n, 2) of a caller, checked, n >= 2.

    Raises:
        InvalidGeometry: It is none.
    """
    points = array("path", path, "n", 2, error=InvalidGeometry, finite=False)
    if len(points) < 2:
        raise InvalidGeometry(f"a path has at least two points, got {len(points)}")
    with np.errstate(invalid="ignore"):
        return shapely.LineString(points)


def _walls(scene: Scene, clearance: float) -> Box:
    """The bounds; without any, room round everything for the tips of grown obstacles and a path round them."""
    if scene.bounds is not None:
        return scene.bounds
    x_min, y_min, x_max, y_max = scene.box
    room = (MITRE_LIMIT + 1) * clearance
    return x_min - room, y_min - room, x_max + room, y_max + room


def _extent(box: Box) -> float:
    return max(box[2] - box[0], box[3] - box[1])


def _touch(box: Box) -> float:
    return max(TOUCH * _extent(box), ROUNDED * max(map(abs, box)))
