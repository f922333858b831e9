"""A path for the planner of speeds: lengths and turns, and for each corner the largest speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile.motion.straight import straight_time
from pin_metaik.mobile.motion.turn import lead_time, turn_shape, turn_time
from pin_metaik.mobile.motion.vehicle import Vehicle
from pin_metaik.mobile.paths.path import Path
from pin_metaik.optimize.settings import within

FLAT = 1e-9  # m; corners nearer to a straight line are none
TINY = 1e-12  # s; no tangent length per speed is shorter, so that it can be divided by
SLOW = 1e-3  # of the largest speed; a corner that allows no more is for stopping
SKIN = 1e-6  # m; how deep a point robot may touch an obstacle
HALVINGS = 34  # of the interval in which the largest free speed lies
MANTISSA = 53  # halvings that leave no interval

_Shape = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Route:
    """Straights s_0 ... s_n with turns theta_1 ... theta_n between them.

    Attributes:
        path: The polyline, without points on straight lines.
        vehicle: The robot.
        turns: Angle at each corner (n,) in rad, positive to the left.
        g: Tangent length per speed at each corner (n,), in s; for a differential drive, in the limit of slow turns.
        caps: Largest speed at each corner (n,) in m/s; 0 where the robot must stop and turn on the spot.
        ends: Speeds at the start and at the goal, m/s.
    """

    path: Path
    vehicle: Vehicle
    turns: Array
    g: Array
    caps: Array
    ends: tuple[float, float] = (0.0, 0.0)

    @staticmethod
    @checked
    def along(
        path: Path,
        vehicle: Vehicle,
        obstacles: Sequence[shapely.Geometry] = (),
        radius: float | None = None,
        ends: tuple[float, float] = (0.0, 0.0),
    ) -> Route:
        """The route along a path.

        A corner's cap is the smallest of: the robot's largest speed; the speed at which the tangents fit into the
        adjacent straights; the speed up to which the whole area between corner and curve keeps the radius from the
        obstacles.

        Args:
            path: A polyline that is free itself, with the robot's radius.
            vehicle: The robot.
            obstacles: Polygons, lines and points, not grown.
            radius: Distance of the robot's centre from obstacles, in m; default: the robot's radius.
            ends: Speeds at the start and at the goal, m/s, along the path.

        Raises:
            InvalidSetting: Speeds at the ends that the robot does not drive.
            InvalidGeometry: The path turns back on itself.
        """
        for role, speed in zip(("start", "goal"), ends, strict=True):
            within(f"the speed at the {role}", speed, 0, vehicle.v_max * (1 + FLAT))
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
        route = Route(path, vehicle, turns, g, caps, ends)
        if vehicle.coupled:
            route = replace(route, caps=route._with_room(np.minimum(s[:-1], s[1:])))
        clear = [route.clear_speed(i, obstacles, vehicle.radius if radius is None else radius) for i in range(len(g))]
        return replace(route, caps=np.array(clear))

    @property
    def lengths(self) -> Array:
        """Length of each segment (n + 1,) in m."""
        return self.path.lengths

    @property
    def stop_and_turn(self) -> float:
        """Time in s with a stop at every corner: always feasible from rest to rest; inf if a speed at an end is not."""
        return float(self.times(np.zeros((1, len(self.turns))))[0])

    @checked
    def tangents(self, V: Array) -> Array:
        """Tangent lengths (k, n), m, at speeds V (k, n): the distance before a corner at which its turn begins."""
        V = self._speeds(V)
        return V * (lead_time(np.abs(self.turns), self.vehicle, V) if self.vehicle.coupled else self.g)

    @checked
    def turning(self, V: Array) -> Array:
        """Times (k, n), s, of the turns at speeds V (k, n)."""
        return turn_time(self.turns, self.vehicle, self._speeds(V))

    def straights(self, V: Array, tangents: Array | None = None) -> Array:
        """Lengths (k, n + 1) left for the straights at speeds V (k, n); tangent lengths (k, n) default to exact."""
        V = self._speeds(V)
        alpha = self.tangents(V) if tangents is None else array("tangents", tangents, *V.shape, finite=False)
        alpha = np.pad(alpha, ((0, 0), (1, 1)))
        return np.asarray(self.lengths - alpha[:, :-1] - alpha[:, 1:])

    def times(self, V: Array, tangents: Array | None = None) -> Array:
        """Times (k,) in s at speeds V (k, n); inf where a straight is too short."""
        V = self._speeds(V)
        v = self._with_ends(V)
        straights = straight_time(self.straights(V, tangents), v[:, :-1], v[:, 1:], self.vehicle)
        return np.asarray(straights.sum(axis=1) + self.turning(V).sum(axis=1))

    def lack(self, V: Array, tangents: Array | None = None) -> Array:
        """Sum (k,), m, of the lengths by which straights are too short at speeds V (k, n); 0 is feasible."""
        V = self._speeds(V)
        v = self._with_ends(V)
        needed = np.abs(v[:, 1:] ** 2 - v[:, :-1] ** 2) / (2 * self.vehicle.a_max)
        return np.asarray(np.maximum(needed - self.straights(V, tangents), 0).sum(axis=1))

    @checked
    def clear_speed(self, corner: int, obstacles: Sequence[shapely.Geometry], radius: float) -> float:
        """The largest speed up to the cap at which the curve, and all between it and the corner, keeps the radius.

        The faster the robot, the larger the radius of its curve at a given direction, whether the curves are similar to
        each other or have longer arcs. So each curve lies between the corner and all faster ones: a speed below a free
        one is free, and bisection finds the largest.
        """
        if not 0 <= corner < len(self.caps):
            raise InvalidSetting(f"corner is 0 to {len(self.caps) - 1}, got {corner}")
        cap = float(self.caps[corner])
        tree = shapely.STRtree(obstacles)
        shape = self._curve(corner, cap)
        near = tree.query(_cut(shape, cap), predicate="dwithin", distance=radius)
        if not len(near):
            return cap
        solid = shapely.union_all([obstacles[i] for i in near])
        free, tight = 0.0, cap
        for _ in range(HALVINGS):
            v = (free + tight) / 2
            shape = self._curve(corner, v) if self.vehicle.coupled else shape
            if keeps_clear([_cut(shape, v)], solid, radius):
                free = v
            else:
                tight = v
        return free if free > SLOW * self.vehicle.v_max else 0.0

    def _speeds(self, V: Array) -> Array:
        """Speeds (k, n) of a caller, checked."""
        return array("V", V, "k", len(self.turns), finite=False)

    def _with_ends(self, V: Array) -> Array:
        """Speeds (k, n + 2) with those at the start and at the goal."""
        start, goal = self.ends
        return np.pad(V, ((0, 0), (1, 1)), constant_values=((0, 0), (start, goal)))

    def _with_room(self, room: Array) -> Array:
        """The largest speeds (n,) up to the caps whose tangent lengths are at most a room (n,), in m."""
        free, tight = np.zeros_like(self.caps), self.caps.copy()
        for _ in range(MANTISSA):
            v = (free + tight) / 2
            fits = self.tangents(v[None])[0] <= room
            free, tight = np.where(fits, v, free), np.where(fits, tight, v)
        return free

    def _curve(self, corner: int, v: float) -> _Shape:
        """A corner (2,), and the curve at speed v from there (m, 2), per m/s."""
        turn = float(self.turns[corner])
        x, y = turn_shape(abs(turn), self.vehicle, v).T
        at, along = self.path.corners[corner], self.path.points[corner + 1] - self.path.points[corner]
        cos, sin = along / np.hypot(*along)
        y = np.copysign(1.0, turn) * y
        return at, np.column_stack((cos * x - sin * y, sin * x + cos * y))


def _cut(shape: _Shape, v: float) -> shapely.Polygon:
    """What lies between a corner and its curve at speed v."""
    at, curve = shape
    return shapely.Polygon(np.vstack((at, at + v * curve)))


def keeps_clear(places: Sequence[shapely.Geometry], solid: shapely.Geometry, radius: float, slack: float = 0.0) -> bool:
    """Whether places keep a distance from an obstacle; a robot of radius 0 may touch polygons, but no line or point.

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
