"""An independent shortest path, every vertex to every vertex tested by shapely, without pruning; and scenes for it."""

from collections.abc import Callable

import numpy as np
import shapely
from scipy.sparse.csgraph import dijkstra
from shapely import affinity

from pin_metaik.mobile import Scene

TOUCH = 1e-9  # rings nearer than this touch: no scene here has gaps nearly so narrow but of width 0
PLUG = 1e-7  # how much around the place where they do is solid


def shortest_length(start, goal, obstacles, bounds) -> float:
    """Length of the shortest path of a point that may touch obstacles and walls, but not pass where two of them touch.

    Infinite if there is none.
    """
    solid = shapely.set_precision(shapely.union_all(obstacles, grid_size=1e-11), 0)
    if bounds is not None:
        x_min, y_min, x_max, y_max = bounds
        outside = shapely.box(x_min - 1, y_min - 1, x_max + 1, y_max + 1).difference(shapely.box(*bounds))
        solid = shapely.union(solid, outside)
    solid = shapely.union_all([solid, *contacts(solid)])
    core = solid.buffer(-1e-9, join_style="mitre")
    shapely.prepare(core)
    corners = shapely.get_coordinates(solid)
    if bounds is not None:
        corners = corners[(corners >= (x_min, y_min)).all(axis=1) & (corners <= (x_max, y_max)).all(axis=1)]
    points = np.vstack((start, goal, np.unique(corners, axis=0)))
    i, j = np.triu_indices(len(points), 1)
    free = ~shapely.intersects(core, shapely.linestrings(np.stack((points[i], points[j]), axis=1)))
    weights = np.zeros((len(points), len(points)))
    weights[i[free], j[free]] = np.hypot(*(points[i[free]] - points[j[free]]).T)
    return float(dijkstra(weights, directed=False, indices=0)[1])


def contacts(solid) -> list:
    """Small squares where two rings of a region touch; a path may bend round them."""
    rings = [ring for part in shapely.get_parts(solid) for ring in (part.exterior, *part.interiors)]
    pairs = [(a, b) for i, a in enumerate(rings) for b in rings[i + 1 :] if a.distance(b) < TOUCH]
    met = [part for a, b in pairs for part in shapely.get_parts(a.buffer(2 * TOUCH).intersection(b))]
    return [part.centroid.buffer(PLUG, quad_segs=1) for part in met]


def overlapping(rng) -> Scene:
    """Triangles and quadrangles thrown on each other, some over the walls."""
    obstacles = []
    for _ in range(9):
        centre, count = rng.uniform(1, 9, 2), rng.integers(3, 6)
        hull = shapely.MultiPoint(centre + rng.uniform(-1.5, 1.5, (count, 2))).convex_hull
        if hull.area > 0.05 and hull.distance(shapely.MultiPoint([(0, 0), (10, 10)])) > 0.2:
            obstacles.append(hull)
    return Scene((0, 0), (10, 10), tuple(obstacles), (0, 0, 10, 10))


def cells(rng) -> Scene:
    """Occupied cells that touch along edges and in corners."""
    at = np.argwhere(rng.random((8, 8)) < 0.4)
    obstacles = tuple(shapely.box(x, y, x + 1, y + 1) for x, y in at if 0 < x + y < 14)
    return Scene((0.5, 0.5), (7.5, 7.5), obstacles, (0, 0, 8, 8))


def lattice(rng) -> Scene:
    """Triangles and quadrangles with whole coordinates: corners on corners, on edges and on walls; some turned."""
    obstacles = []
    for _ in range(8):
        corners = rng.integers(0, 9, 2) + rng.integers(-2, 3, (rng.integers(3, 5), 2))
        hull = shapely.MultiPoint(corners).convex_hull
        if hull.area > 0.1 and hull.distance(shapely.MultiPoint([(0.4, 0.3), (7.7, 7.6)])) > 0.1:
            obstacles.append(hull)
    if rng.random() < 0.5:
        return Scene((0.4, 0.3), (7.7, 7.6), tuple(obstacles), (0, 0, 8, 8))
    walls = shapely.box(-1, -1, 9, 9).difference(shapely.box(0, 0, 8, 8))
    angle = rng.uniform(0, 360)
    turned = [affinity.rotate(each, angle, (0, 0)) for each in (*obstacles, walls)]
    ends = [affinity.rotate(shapely.Point(end), angle, (0, 0)).coords[0] for end in ((0.4, 0.3), (7.7, 7.6))]
    return Scene(*ends, tuple(turned))


def concave(rng) -> Scene:
    """Stars with needles and notches in a plane without walls."""
    obstacles = []
    for x, y in ((2, 3), (7, 3), (3, 7.5), (7.5, 7)):
        angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
        star = np.array([x, y]) + rng.uniform(0.2, 2.3, (9, 1)) * np.column_stack((np.cos(angles), np.sin(angles)))
        parts = shapely.get_parts(shapely.make_valid(shapely.Polygon(star)))
        obstacles += [part for part in parts if part.geom_type == "Polygon" and part.area > 1e-3]
    free = shapely.union_all(obstacles).distance(shapely.MultiPoint([(0, 0), (10, 10)])) > 0.1
    return Scene((0, 0), (10, 10), tuple(obstacles)) if free else concave(rng)


def rooms(rng) -> Scene:
    """Walls across the workspace with doors; some end at the workspace's wall, some at each other, some with a tip."""
    obstacles = []
    for x in (2, 4, 6, 8):
        door = rng.uniform(0.5, 9)
        obstacles += [shapely.box(x, 0, x + 0.3, door), shapely.box(x, door + 0.4, x + 0.3, 10)]
        y = float(rng.integers(1, 10))
        obstacles.append(shapely.Polygon([(x + 0.3, y), (x + 2, y - 0.6), (x + 2, y - 0.1)]))  # its tip at the wall
    return Scene((1, 5), (9.5, 5), tuple(obstacles), (0, 0, 10, 10))


FAMILIES: dict[str, Callable[..., Scene]] = {
    "overlapping": overlapping,
    "cells": cells,
    "lattice": lattice,
    "concave": concave,
    "rooms": rooms,
}
