"""Curves for vehicles with a least turning radius through the corners of a path, clear of obstacles."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.curves.curve import Curve, Pose, joined
from pin_metaik.mobile.curves.footprint import Contact, Footprint, first_contact
from pin_metaik.mobile.curves.shortest import curve_of, shortest_words, turning
from pin_metaik.mobile.errors import Obstructed
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.world.polygons import read_obstacles

HEADINGS = 24  # tried at each point
ROUNDS, SHRINK = 12, 0.5  # of looking closer, and how much smaller the window becomes
CLOSER = np.linspace(-1, 1, 7)  # headings of a window; its middle is the best so far
CHECKS = 3000  # curves between two points that are checked at most


@checked
def curve_through(
    path: Path | ArrayLike,
    turning_radius: float,
    obstacles: Any = (),
    *,
    footprint: Footprint | None = None,
    start_heading: float | None = None,
    goal_heading: float | None = None,
    reverse: bool = False,
) -> Curve:
    """A short curve through the points of a path, with at least the given turning radius and clear of obstacles.

    Between neighbouring points it is the shortest curve for its headings there. The headings are the best of a grid, by
    dynamic programming, then of finer grids around them; so the whole is short, but not proved the shortest. Pieces
    that meet an obstacle are excluded, so that headings that lead around it are found, if the grid has any.

    Args:
        path: A polyline, or its points (n, 2) in m; the curve goes through all of them.
        turning_radius: Least radius of the vehicle, m.
        obstacles: Polygons, lines and points, not grown: anything ``read_obstacles`` takes.
        footprint: The vehicle's outline, which is proved clear of obstacles; default: a point.
        start_heading: rad; default: the best one.
        goal_heading: rad; default: the best one.
        reverse: Whether the vehicle may also drive backwards.

    Raises:
        InvalidSetting: A radius that is not above zero.
        InvalidGeometry: A malformed path or obstacle.
        Obstructed: Every curve tried meets an obstacle; the error says where the best one does.
    """
    turning(turning_radius)
    if not isinstance(path, Path):
        path = Path(array("path", path, "n", 2, error=InvalidGeometry))
    solid = read_obstacles(obstacles)
    outline = Footprint.disc(0.0) if footprint is None else footprint
    points = path.points[np.concatenate(([True], path.lengths > 0))]
    for name, heading in (("start_heading", start_heading), ("goal_heading", goal_heading)):
        if heading is not None:
            number(name, heading)
    fixed = [start_heading, *[None] * (len(points) - 2), goal_heading][: len(points)]
    grids = [
        free if heading is None else np.array([heading]) for heading, free in zip(fixed, _headings(points), strict=True)
    ]
    legs = [_Leg(points[i], points[i + 1], turning_radius, reverse, solid, outline) for i in range(len(points) - 1)]
    best = _best(legs, grids)
    window = np.pi / HEADINGS
    for _ in range(ROUNDS):
        closer = [
            np.array([h]) if given is not None else h + window * CLOSER for h, given in zip(best, fixed, strict=True)
        ]
        best, window = _best(legs, closer), SHRINK * window
    pieces = [leg.curve(a, b) for leg, a, b in zip(legs, best[:-1], best[1:], strict=True)]
    return joined(pieces) if pieces else Curve((*points[0].tolist(), best[0]), turning_radius, "", ())


def _headings(points: Array) -> list[Array]:
    """Headings to try at points (n, 2): all around, along the segments before and after, and half way between."""
    around = np.linspace(-np.pi, np.pi, HEADINGS, endpoint=False)
    along = np.diff(points[:, 0] + 1j * points[:, 1])
    along = along / np.abs(along)
    before, after = np.concatenate((along[:1], along)), np.concatenate((along, along[-1:]))
    own = np.angle(np.stack((before, after, before + after), axis=1))
    return [np.union1d(around, headings) for headings in own] if len(along) else [around] * len(points)


class _Leg:
    """The curves between two neighbouring points, and which of them meet an obstacle."""

    def __init__(
        self,
        a: Array,
        b: Array,
        radius: float,
        reverse: bool,
        solid: tuple[shapely.Geometry, ...],
        footprint: Footprint,
    ) -> None:
        self.a, self.b, self.radius, self.reverse = a, b, radius, reverse
        self.solid, self.footprint = solid, footprint
        self.met: dict[tuple[float, float], Contact | None] = {}

    def lengths(self, into: Array, out: Array) -> Array:
        """Lengths (k, m) for headings (k,) at the first point and (m,) at the second; inf where one collides."""
        first, second = (grid.ravel() for grid in np.meshgrid(into, out, indexing="ij"))
        starts = np.column_stack((np.tile(self.a, (len(first), 1)), first))
        goals = np.column_stack((np.tile(self.b, (len(first), 1)), second))
        _, lengths = shortest_words(starts, goals, self.radius, self.reverse)
        found = np.abs(lengths).sum(axis=1)
        if self.met:
            pairs = zip(first.tolist(), second.tolist(), strict=True)
            found[[self.met.get(pair) is not None for pair in pairs]] = np.inf
        return np.asarray(found.reshape(len(into), len(out)))

    def curve(self, a: float, b: float) -> Curve:
        start: Pose = (float(self.a[0]), float(self.a[1]), a)
        word, lengths = shortest_words(np.array([start]), np.array([(*self.b, b)]), self.radius, self.reverse)
        return curve_of(start, self.radius, word[0], lengths[0])

    def contact(self, a: float, b: float) -> Contact | None:
        """Where the curve with headings a and b meets an obstacle first."""
        if (a, b) not in self.met:
            self.met[a, b] = first_contact(self.curve(a, b), self.footprint, self.solid) if self.solid else None
        return self.met[a, b]


def _best(legs: list[_Leg], grids: list[Array]) -> list[float]:
    """The headings of grids whose curves are the shortest in sum and meet no obstacle.

    Curves are checked only when they are part of the shortest so far; what meets an obstacle is then no longer there.
    """
    costs = [leg.lengths(a, b) for leg, a, b in zip(legs, grids[:-1], grids[1:], strict=True)]
    met: Contact | None = None
    for _ in range(CHECKS):
        chosen = _shortest_chain(costs, [len(grid) for grid in grids])
        if chosen is None:
            break
        headings = [float(grid[k]) for grid, k in zip(grids, chosen, strict=True)]
        clear = True
        for i, leg in enumerate(legs):
            contact = leg.contact(headings[i], headings[i + 1])
            if contact is not None:
                met, clear = met or contact, False
                costs[i][chosen[i], chosen[i + 1]] = np.inf
        if clear:
            return headings
    if met is None:  # all were known to meet something
        met = next(contact for leg in legs for contact in leg.met.values() if contact is not None)
    raise Obstructed(met.pose, met.point)


def _shortest_chain(costs: list[Array], sizes: list[int]) -> list[int] | None:
    """One index for each grid, so that the costs between neighbours are least in sum; None if all are infinite."""
    total, came = np.zeros(sizes[0]), []
    for cost in costs:
        sums = total[:, None] + cost
        came.append(sums.argmin(axis=0))
        total = sums.min(axis=0)
    if not np.isfinite(total).any():
        return None
    chosen = [int(total.argmin())]
    for back in reversed(came):
        chosen.append(int(back[chosen[-1]]))
    return chosen[::-1]
