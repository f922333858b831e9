"""A path as the planner of speeds sees it: a chain of lengths and turns, each corner with the speed it allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile.motion.straight import straight_time
from pin_metaik.mobile.motion.turn import lead_time, turn_shape, turn_time
from pin_metaik.mobile.motion.vehicle import SynchroDrive
from pin_metaik.mobile.paths.path import Path

FLAT = 1e-9  # m; corners nearer to a straight line are none
TINY = 1e-12  # s; no tangent length per speed is shorter, so that it can be divided by
SLOW = 1e-3  # of the largest speed; a corner that allows no more is for stopping
SKIN = 1e-6  # m; how deep a point robot may touch an obstacle
HALVINGS = 34  # of the interval in which the largest free speed lies


@dataclass(frozen=True, eq=False)
class Route:
    """Straights s_0 ... s_n with turns theta_1 ... theta_n between them; at rest at both ends.

    Attributes:
        path: The polyline, without corners that are none.
        vehicle: The robot.
        turns: Angle at each corner (n,) in rad, to the left above zero.
        g: Tangent length per speed at each corner (n,), in s.
        caps: Largest speed at each corner (n,) in m/s; 0 where there is no room but to stop and turn.
    """

    path: Path
    vehicle: SynchroDrive
    turns: Array
    g: Array
    caps: Array

    @staticmethod
    @checked
    def along(
        path: Path, vehicle: SynchroDrive, obstacles: Sequence[shapely.Geometry] = (), radius: float | None = None
    ) -> Route:
        """The route along a path.

        A corner's cap is the smallest of: the robot's largest speed; what the straights beside it have room for; the
        speed below which everything between corner and curve keeps the radius from the obstacles.

        Args:
            path: A polyline that is free itself, with the robot's radius.
            vehicle: The robot.
            obstacles: Polygons, lines and points, not grown.
            radius: Distance of the robot's centre from obstacles, in m; default: the robot's radius.

        Raises:
            InvalidGeometry: The path turns back on itself.
        """
        path = path.straightened(FLAT)
        along = np.diff(path.points, axis=0)
        into, out = along[:-1], along[1:]
        turns = np.arctan2(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], (into * out).sum(axis=1))
        if (np.abs(turns) >= np.pi).any():
            x, y = path.corners[np.abs(turns).argmax()]
            raise InvalidGeometry(
                f"the path turns back by 180 degrees at ({x:.12g}, {y:.12g}): plan the two parts one by one"
            )
        g = lead_time(np.abs(turns), vehicle)
        s = path.lengths
        caps = np.minimum(vehicle.v_max, np.minimum(s[:-1], s[1:]) / np.maximum(g, TINY))
        route = Route(path, vehicle, turns, g, caps)
        clear = [route.clear_speed(i, obstacles, vehicle.radius if radius is None else radius) for i in range(len(g))]
        return Route(path, vehicle, turns, g, np.array(clear))

    @property
    def lengths(self) -> Array:
        """Length of each segment (n + 1,) in m."""
        return self.path.lengths

    @cached_property
    def turning(self) -> float:
        """Time of all turns in s, whatever the speeds."""
        return float(turn_time(self.turns, self.vehicle).sum())

    @property
    def stop_and_turn(self) -> float:
        """Time in s with a stop at every corner: always feasible."""
        return float(self.times(np.zeros((1, len(self.turns))))[0])

    def straights(self, V: Array, tangents: Array | None = None) -> Array:
        """Lengths (k, n + 1) left for the straights at speeds V (k, n); tangent lengths (k, n) default to ``v g``."""
        V = self._speeds(V)
        alpha = np.pad(
            V * self.g if tangents is None else array("tangents", tangents, *V.shape, finite=False), ((0, 0), (1, 1))
        )
        return np.asarray(self.lengths - alpha[:, :-1] - alpha[:, 1:])

    def times(self, V: Array, tangents: Array | None = None) -> Array:
        """Times (k,) in s at speeds V (k, n); inf where a straight is too short."""
        V = self._speeds(V)
        v = np.pad(V, ((0, 0), (1, 1)))
        straights = straight_time(self.straights(V, tangents), v[:, :-1], v[:, 1:], self.vehicle)
        return np.asarray(straights.sum(axis=1) + self.turning)

    def lack(self, V: Array, tangents: Array | None = None) -> Array:
        """By how much (k,) in m straights are too short at speeds V (k, n), in sum; 0 is feasible."""
        V = self._speeds(V)
        v = np.pad(V, ((0, 0), (1, 1)))
        needed = np.abs(v[:, 1:] ** 2 - v[:, :-1] ** 2) / (2 * self.vehicle.a_max)
        return np.asarray(np.maximum(needed - self.straights(V, tangents), 0).sum(axis=1))

    @checked
    def clear_speed(self, corner: int, obstacles: Sequence[shapely.Geometry], radius: float) -> float:
        """The largest speed up to the cap at which the curve, and all between it and the corner, keeps the radius.

        The curves of a corner are copies of each other in different sizes, so what is free at one speed is free at all
        below it, and halving the interval finds the largest.
        """
        if not 0 <= corner < len(self.caps):
            raise InvalidSetting(f"corner is 0 to {len(self.caps) - 1}, got {corner}")
        cap = float(self.caps[corner])
        shape = self._curve(corner)
        at = self.path.corners[corner]
        tree = shapely.STRtree(obstacles)
        near = tree.query(shapely.Polygon(at + cap * shape), predicate="dwithin", distance=radius)
        if not len(near):
            return cap
        solid = shapely.union_all([obstacles[i] for i in near])
        free, tight = 0.0, cap
        for _ in range(HALVINGS):
            v = (free + tight) / 2
            if keeps_clear([shapely.Polygon(at + v * shape)], solid, radius):
                free = v
            else:
                tight = v
        return free if free > SLOW * self.vehicle.v_max else 0.0

    def _speeds(self, V: Array) -> Array:
        """Speeds (k, n) that somebody gave."""
        return array("V", V, "k", len(self.turns), finite=False)

    def _curve(self, corner: int) -> Array:
        """The curve at speed 1 with the corner as its first point, both relative to the corner (m + 1, 2)."""
        turn = float(self.turns[corner])
        x, y = turn_shape(abs(turn), self.vehicle).T
        along = self.path.points[corner + 1] - self.path.points[corner]
        cos, sin = along / np.hypot(*along)
        y = np.copysign(1.0, turn) * y
        return np.vstack(([0.0, 0.0], np.column_stack((cos * x - sin * y, sin * x + cos * y))))


def keeps_clear(places: Sequence[shapely.Geometry], solid: shapely.Geometry, radius: float, slack: float = 0.0) -> bool:
    """Whether places keep a distance from what is solid; a robot without a radius may touch it, but no line or point.

    Args:
        places: Where the robot's centre is.
        solid: The obstacles, joined.
        radius: The distance, m.
        slack: How much nearer still counts, m.
    """
    if radius > 0:
        return bool((shapely.distance(places, solid) >= radius - slack).all())
    parts = shapely.get_parts(solid)
    flat = parts[shapely.get_dimensions(parts) < 2]
    core = shapely.union_all([solid.buffer(-SKIN, join_style="mitre"), *flat])
    return not shapely.intersects(places, core).any()
