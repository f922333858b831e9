"""An independent shortest path: every vertex to every vertex, tested by shapely, no pruning."""

import numpy as np
import shapely
from scipy.sparse.csgraph import dijkstra


def shortest_length(start, goal, obstacles, bounds) -> float:
    """Length of the shortest path of a point that may touch obstacles and walls; inf if there is none."""
    solid = shapely.union_all(obstacles)
    core = solid.buffer(-1e-9, join_style="mitre")
    shapely.prepare(core)
    corners = shapely.get_coordinates(solid)
    x_min, y_min, x_max, y_max = bounds
    inside = (corners >= (x_min, y_min)).all(axis=1) & (corners <= (x_max, y_max)).all(axis=1)
    points = np.vstack((start, goal, np.unique(corners[inside], axis=0)))
    i, j = np.triu_indices(len(points), 1)
    free = ~shapely.intersects(core, shapely.linestrings(np.stack((points[i], points[j]), axis=1)))
    weights = np.zeros((len(points), len(points)))
    weights[i[free], j[free]] = np.hypot(*(points[i[free]] - points[j[free]]).T)
    return float(dijkstra(weights, directed=False, indices=0)[1])
