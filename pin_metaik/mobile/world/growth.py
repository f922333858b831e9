"""Obstacles grown by a clearance, so that a robot with a radius becomes a point.

Written out rather than left to ``shapely.buffer``: that one simplifies concave outlines first, and its arcs run inside
the circle, so what it returns is up to a percent of the clearance too small.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np
import shapely

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.world.border import rings

Join = Literal["mitre", "round"]

MITRE_LIMIT = 5.0  # how many clearances a corner may stick out before its tip is cut
STRAIGHT = 1e-9  # rad; smaller turns are none
ARC = math.pi / 16  # rad; the longest arc one corner of a round join stands for
INWARD = 1 / 16  # of a clearance; how far pieces reach inside: beyond rounding, and no further, as overlaps cost time
WITHIN = math.cos(ARC / 2)  # obstacles grown with round joins by this share of a clearance lie within the clearance


def grow(obstacles: Sequence[shapely.Geometry], clearance: float, join: Join = "mitre") -> list[shapely.Polygon]:
    """Polygons whose union is everything nearer than the clearance, and a little more at the corners.

    Around an edge that is a rectangle. Around a vertex it is the arc's circumscribed polygon, never its chords: with
    one corner (``mitre``; more only if it would stick out too far) or one for every 11 degrees (``round``). Each piece
    grows in proportion to the clearance, so a larger clearance never frees anything.

    Args:
        obstacles: Polygons, lines and points; polygons come back first, unchanged.
        clearance: Distance to keep, at least 0, in the obstacles' unit.
        join: ``mitre`` has fewer vertices, ``round`` gives more room at corners.

    Raises:
        InvalidSetting: A clearance below zero or not finite, or no such join.
    """
    if not 0 <= clearance < math.inf:
        raise InvalidSetting(f"the clearance must be a finite number of at least 0, not {clearance!r}")
    match join:
        case "mitre":
            widest = 2 * math.acos(1 / MITRE_LIMIT)
        case "round":
            widest = ARC
        case _:
            raise InvalidSetting(f"join must be 'mitre' or 'round', not {join!r}")
    pieces = [obstacle for obstacle in obstacles if obstacle.geom_type == "Polygon"]
    if clearance == 0:
        return pieces
    for obstacle in obstacles:
        match obstacle.geom_type:
            case "Point":
                pieces.append(_disc(shapely.get_coordinates(obstacle)[0], clearance, widest))
            case "LineString":
                there = shapely.get_coordinates(obstacle)
                pieces.extend(_collar(np.vstack((there, there[-2:0:-1])), clearance, widest, whole=True))
            case _:
                for ring in rings(obstacle):
                    pieces.extend(_collar(ring, clearance, widest, whole=not obstacle.interiors))
    return pieces


def _disc(centre: Array, clearance: float, widest: float) -> shapely.Polygon:
    """The circumscribed polygon of a circle, four corners at least."""
    quarter = _circumscribed(np.array([1.0, 0.0]), math.pi / 2, widest)
    turns = (quarter, quarter[:, ::-1] * (-1, 1), -quarter, quarter[:, ::-1] * (1, -1))
    return shapely.Polygon(centre + clearance * np.vstack(turns))


def _collar(ring: Array, clearance: float, widest: float, whole: bool) -> Iterator[shapely.Polygon]:
    """Convex pieces that cover what lies outside a ring and nearer than the clearance, and reach inside.

    They overlap: pieces that only shared borders would leave slits between them by rounding. With `whole` the inside
    may be covered, too.
    """
    ring = ring[(ring != np.roll(ring, 1, axis=0)).any(axis=1)]
    after = np.roll(ring, -1, axis=0)
    length = np.hypot(*(after - ring).T)
    along = (after - ring) / length[:, None]
    normal = np.column_stack((along[:, 1], -along[:, 0]))  # outward: the inside is on the left
    before = np.roll(normal, 1, axis=0)  # the normal of the edge that ends in the vertex
    turn = np.arctan2(before[:, 0] * normal[:, 1] - before[:, 1] * normal[:, 0], (before * normal).sum(axis=1))
    turn[turn < STRAIGHT - math.pi] = math.pi  # the end of a line
    outward = turn > -STRAIGHT
    tips = {i: ring[i] + clearance * _circumscribed(before[i], turn[i], widest) for i in np.flatnonzero(outward)}
    if whole and (turn > 0).all():  # convex: one piece for everything
        yield shapely.Polygon(np.vstack(list(tips.values())))
        return
    out = clearance * normal
    inward = INWARD * out
    yield from shapely.polygons(np.stack((ring - inward, after - inward, after + out, ring + out), axis=1))  # (n, 4, 2)
    step = np.minimum(length, clearance)[:, None] / 2 * along
    back, onwards = ring + clearance * before - np.roll(step, 1, axis=0), ring + out + step
    yield from (shapely.Polygon(np.vstack((ring[i], back[i], tip, onwards[i]))) for i, tip in tips.items())


def _circumscribed(normal: Array, angle: float, widest: float) -> Array:
    """Corners (k, 2) of the polyline around the arc of the unit circle from `normal` on through `angle`."""
    corners = max(1, math.ceil(angle / widest))
    at = angle / corners * (np.arange(corners) + 0.5)
    cos, sin = np.cos(at), np.sin(at)
    return np.column_stack((cos * normal[0] - sin * normal[1], sin * normal[0] + cos * normal[1])) / math.cos(at[0])
