"""Random scenes: convex obstacles that keep a gap, so that there always is a path; the same seed, the same scene."""

from __future__ import annotations

import math

import numpy as np
import shapely

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.world.scene import Point, Scene
from pin_metaik.randomness import as_generator

MOST = 10_000  # obstacles; the time they take grows with the square of their number
ATTEMPTS = 2000  # places tried for one obstacle


@checked
def random_scene(
    obstacles: int = 15,
    rng: int | np.random.Generator | None = 0,
    *,
    size: float = 10.0,
    fill: float = 0.3,
    gap: float = 0.1,
    start: Point | None = None,
    goal: Point | None = None,
) -> Scene:
    """A square workspace with convex polygons of 3 to 8 corners.

    Args:
        obstacles: How many.
        rng: Seed or generator; ``None`` is a fixed seed.
        size: Width of the workspace, in m.
        fill: Share of the workspace that the circles around the obstacles cover.
        gap: Least distance between obstacles, and from them to start and goal, in m. Twice a robot's clearance lets it
            through everywhere, if obstacles grow with round joins: mitred corners stick out further.
        start: (x, y); default: near the lower left corner.
        goal: (x, y); default: near the upper right corner.

    Raises:
        InvalidSetting: The obstacles do not fit.
    """
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
            polygon = _convex(generator, generator.uniform(radius, size - radius, 2), radius)
            if shapely.distance(polygon, placed).min() >= gap:
                placed.append(polygon)
                break
        else:
            raise InvalidSetting(f"only {i} of {obstacles} obstacles fit: fewer, a smaller fill, or a smaller gap")
    return Scene(start, goal, tuple(placed[2:]), (0.0, 0.0, size, size), name)


def _convex(rng: np.random.Generator, centre: np.ndarray, radius: float) -> shapely.Polygon:
    """The hull of points on a circle, rounded to a thousandth of the radius so that it prints well."""
    count = rng.integers(3, 9)
    angles = 2 * math.pi * (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
    points = centre + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    digits = 3 - math.floor(math.log10(radius))
    return shapely.MultiPoint(points.round(digits)).convex_hull
