"""Random scenes: obstacles that keep a gap, so that there always is a path; the same seed, the same scene."""

from __future__ import annotations

import math

import numpy as np
import shapely

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.world.scene import Point, Scene
from pin_metaik.optimize.settings import within
from pin_metaik.randomness import as_generator

MOST = 10_000  # obstacles; the time they take grows with the square of their number
ATTEMPTS = 2000  # places tried for one obstacle
NEAREST, BITTEN = 0.35, 0.9  # of the radius, how near corners of stars may be; of the hull's area, how much a star has


@checked
def random_scene(
    obstacles: int = 15,
    rng: int | np.random.Generator | None = 0,
    *,
    size: float = 10.0,
    fill: float = 0.3,
    gap: float = 0.1,
    concave: float = 0.0,
    start: Point | None = None,
    goal: Point | None = None,
) -> Scene:
    """A square workspace with random convex polygons of 3 to 8 corners and, with ``concave``, concave ones of 5 to 9.

    Args:
        obstacles: Number of obstacles.
        rng: Seed or generator; ``None`` is a fixed seed.
        size: Width of the workspace, in m.
        fill: Share of the workspace that the circles around the obstacles cover.
        gap: Least distance between obstacles, and from them to start and goal, in m. With twice the robot's clearance
            it can pass everywhere, if obstacles are grown with round joins (mitred corners stick out further); but a
            start or goal in the pocket of a concave obstacle may still be shut in.
        concave: Probability that an obstacle is concave: a star with 5 to 9 corners.
        start: (x, y); default: near the lower left corner.
        goal: (x, y); default: near the upper right corner.

    Raises:
        InvalidSetting: The obstacles do not fit.
    """
    within("concave", concave, 0, 1)
    if not (0 <= obstacles <= MOST and 0 < size < math.inf and 0 < fill < 1 and gap >= 0):
        raise InvalidSetting(
            f"a random scene takes 0 to {MOST:,} obstacles, size > 0, 0 < fill < 1 and gap >= 0, got "
            f"{obstacles}, {size}, {fill}, {gap}"
        )
    name = f"random:{rng}" if isinstance(rng, int) else "random"
    generator = as_generator(rng)
    start = start or (0.05 * size, 0.05 * size)
    goal = goal or (0.95 * size, 0.95 * size)
    usual = size * math.sqrt(fill / (math.pi * max(obstacles, 1)))  # radius
    placed: list[shapely.Geometry] = [shapely.Point(start), shapely.Point(goal)]
    for i in range(obstacles):
        for _ in range(ATTEMPTS):
            radius = usual * generator.uniform(0.6, 1.4)
            centre = generator.uniform(radius, size - radius, 2)
            star = concave > 0 and generator.random() < concave  # no draw without stars: seeds keep their scenes
            polygon = (_concave if star else _convex)(generator, centre, radius)
            if shapely.distance(polygon, placed).min() >= gap:
                placed.append(polygon)
                break
        else:
            raise InvalidSetting(
                f"only {i} of {obstacles} obstacles fit: ask for fewer, a smaller fill or a smaller gap"
            )
    return Scene(start, goal, tuple(placed[2:]), (0.0, 0.0, size, size), name)


def _convex(rng: np.random.Generator, centre: np.ndarray, radius: float) -> shapely.Polygon:
    """The hull of points on a circle."""
    count = int(rng.integers(3, 9))
    return shapely.MultiPoint(_around(rng, centre, np.full(count, radius), radius)).convex_hull


def _concave(rng: np.random.Generator, centre: np.ndarray, radius: float) -> shapely.Polygon:
    """A polygon whose corners lie around a centre at several distances, drawn until it is not convex."""
    while True:
        distances = radius * rng.uniform(NEAREST, 1.0, int(rng.integers(5, 10)))
        star = shapely.Polygon(_around(rng, centre, distances, radius))
        if star.is_valid and star.area < BITTEN * star.convex_hull.area:
            return star


def _around(rng: np.random.Generator, centre: np.ndarray, distances: np.ndarray, size: float) -> np.ndarray:
    """Points (k, 2) at distances (k,) around a centre, rounded to a thousandth of a size so that they print well."""
    count = len(distances)
    angles = 2 * math.pi * (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
    points = centre + distances[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    return np.asarray(points.round(3 - math.floor(math.log10(size))))
