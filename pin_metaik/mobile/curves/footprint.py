"""The area that a vehicle's outline sweeps along a motion, and its first contact: by bounds, not by samples.

Between two places nothing of the outline is farther from where it is in the middle than the way travelled plus the turn
times its reach. So if the outline in the middle is farther than that from all obstacles, the whole stretch is free;
else it is cut in two.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.curves.curve import Curve, Pose
from pin_metaik.mobile.motion.trajectory import Trajectory
from pin_metaik.mobile.world.polygons import read_obstacles
from pin_metaik.optimize.settings import within

TOLERANCE = 1e-6  # m


Motion = Curve | Trajectory  # over its length in m, or over its time in s


@checked
@dataclass(frozen=True, eq=False)
class Footprint:
    """A vehicle's outline: a convex polygon in its own frame, x ahead, perhaps with a distance around it.

    Attributes:
        corners: (m, 2) in m, relative to the vehicle's reference point, e.g. the middle of the rear axle; one corner is
            a point.
        around: Distance by which the outline is larger than the polygon, m; a single point with it is a disc.

    Raises:
        InvalidGeometry: The corners are not (m, 2) finite numbers.
        InvalidSetting: A distance below zero.
    """

    corners: Array
    around: float = 0.0

    def __post_init__(self) -> None:
        corners = array("corners", self.corners, "m", 2, error=InvalidGeometry)
        if not len(corners):
            raise InvalidGeometry("a footprint has at least one corner")
        within("around", self.around, 0)
        hull = shapely.get_coordinates(shapely.MultiPoint(corners).convex_hull)
        object.__setattr__(self, "corners", hull)

    @staticmethod
    @checked
    def rectangle(length: float, width: float, behind: float | None = None) -> Footprint:
        """A rectangle along the vehicle.

        Args:
            length: m.
            width: m.
            behind: How much of the length is behind the reference point, m; default: half.
        """
        within("length", length, 0)
        within("width", width, 0)
        back = length / 2 if behind is None else behind
        return Footprint(np.array([(x, y) for x in (-back, length - back) for y in (-width / 2, width / 2)]))

    @staticmethod
    @checked
    def disc(radius: float) -> Footprint:
        """A disc around the reference point, with a radius in m."""
        return Footprint(np.zeros((1, 2)), radius)

    @property
    def reach(self) -> float:
        """Largest distance, m, of a corner from the reference point."""
        return float(np.hypot(*self.corners.T).max())

    @checked
    def at(self, poses: Array) -> np.ndarray:
        """The polygon (without ``around``) at poses (n, 3): shapely geometries (n,)."""
        x, y, heading = array("poses", poses, "n", 3).T
        turned = (self.corners @ [1, 1j]) * np.exp(1j * heading)[:, None]
        placed = np.stack((x[:, None] + turned.real, y[:, None] + turned.imag), axis=-1)
        match len(self.corners):
            case 1:
                return np.asarray(shapely.points(placed[:, 0]))
            case 2:
                return np.asarray(shapely.linestrings(placed))
        return np.asarray(shapely.polygons(placed))


@dataclass(frozen=True)
class Contact:
    """The first place where a footprint meets an obstacle.

    Attributes:
        s: Arc length along a curve, m, or time in a trajectory, s.
        pose: (x, y, heading) there, m and rad.
        point: The obstacle's nearest point (x, y), m.
        obstacle: Its number in the list of obstacles.
    """

    s: float
    pose: Pose
    point: tuple[float, float]
    obstacle: int


@checked
def first_contact(motion: Motion, footprint: Footprint, obstacles: Any, tolerance: float = TOLERANCE) -> Contact | None:
    """The first contact of a moving footprint with an obstacle; None: proved free of contact, up to rounding.

    The rounding errors are far below the tolerance.

    Args:
        motion: A ``Curve`` or a ``Trajectory``.
        footprint: The vehicle's outline.
        obstacles: Polygons, lines and points: anything ``read_obstacles`` takes.
        tolerance: In m, above 0: an obstacle that comes nearer than this may be reported as a contact. Before the
            contact reported everything is free, except possibly in a last interval in which no point of the outline
            moves farther than this.

    Raises:
        InvalidSetting: A tolerance that is not above zero.
        InvalidGeometry: An obstacle is not a geometry.
    """
    within("tolerance", tolerance, np.finfo(float).tiny)
    solid = read_obstacles(obstacles)
    if not solid:
        return None
    return _search(motion, footprint, solid, tolerance)


def _search(
    motion: Motion, footprint: Footprint, solid: Sequence[shapely.Geometry], tolerance: float
) -> Contact | None:
    tree = shapely.STRtree(solid)
    ends = motion.boundaries
    a, b = (ends[:-1], ends[1:]) if len(ends) > 1 and ends[-1] > 0 else (ends[:1], ends[:1])
    first = np.inf
    while len(a):
        middle = (a + b) / 2
        shapes = footprint.at(motion.poses(middle))
        travel, turn = motion.moved(a, b)
        room = travel + turn * footprint.reach
        gap = _gaps(tree, shapes, solid) - footprint.around
        met = (gap <= 0) | ((gap <= room) & (room <= tolerance))
        first = min(first, float(middle[met].min(initial=np.inf)))
        cut = (gap <= room) & (room > tolerance) & (a < first)
        a, b = np.concatenate((a[cut], middle[cut])), np.concatenate((middle[cut], b[cut]))
    if not np.isfinite(first):
        return None
    (pose,) = motion.poses([first])
    shape = footprint.at(pose[None])[0]
    number = int(np.argmin(shapely.distance(solid, shape)))
    x, y = shapely.get_coordinates(shapely.shortest_line(solid[number], shape))[0].tolist()
    return Contact(first, (float(pose[0]), float(pose[1]), float(pose[2])), (x, y), number)


def _gaps(tree: shapely.STRtree, shapes: np.ndarray, solid: Sequence[shapely.Geometry]) -> Array:
    """Distances (n,) of shapes from the nearest obstacle."""
    (whose, _), distances = tree.query_nearest(shapes, return_distance=True, all_matches=False)
    gaps = np.empty(len(shapes))
    gaps[whose] = distances
    return gaps
