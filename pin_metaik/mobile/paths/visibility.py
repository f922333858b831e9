"""The visibility graph: corners of the free space and the straight lines between them that a shortest path can have.

A shortest path among polygons bends only at corners, and at both ends of every piece it touches the obstacle without
cutting it (it is taut; Lozano-Perez and Wesley 1979). Few pairs of corners are, so most are never tested. The search
for one path asks only for what the corners that it opens see (as Oh and Leong 2017); all pairs are there for those who
want more paths than one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import csr_array

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.paths import visibility_kernels as kernels
from pin_metaik.mobile.paths.edge_grid import EdgeGrid
from pin_metaik.mobile.world.border import Border, Indices
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.scene import Point

Arrays = tuple[Array, Indices, Indices, NDArray[np.bool_], float, Indices, Indices, Array, int]

SLACK = 0.5  # of what counts as touching: points nearer to a line are on it


@dataclass(frozen=True, eq=False)
class VisibilityGraph:
    """The graph between a start and a goal: nodes are the corners, then start, then goal.

    Attributes:
        border: The border of the free space.
        points: Nodes (c + 2, 2).
        edges: Whether two nodes see each other along a taut line (c + 2, c + 2), symmetric.
    """

    border: Border
    points: Array
    edges: NDArray[np.bool_]

    @property
    def start(self) -> int:
        """Node of the start."""
        return len(self.points) - 2

    @property
    def goal(self) -> int:
        """Node of the goal."""
        return len(self.points) - 1

    @cached_property
    def weights(self) -> csr_array:
        """Lengths of the edges, sparse."""
        i, j = np.nonzero(self.edges)
        along = self.points[j] - self.points[i]
        return csr_array((np.hypot(along[:, 0], along[:, 1]), (i, j)), shape=self.edges.shape)


@checked
class Visibility:
    """Visibility graph of a free space, for any start and goal.

    Attributes:
        space: The free space.
        border: Its border.
        grid: The edges near each cell of the space.
    """

    def __init__(self, space: FreeSpace) -> None:
        self.space = space
        self.border = Border.of(space.region, SLACK * space.touch).weeded()
        self.grid = EdgeGrid.of(self.border)

    @property
    def arrays(self) -> Arrays:
        """Border and grid, as kernels take them."""
        border = self.border
        return *border.arrays, border.bends, border.slack, *self.grid.arrays

    @cached_property
    def mutual(self) -> NDArray[np.bool_]:
        """(c, c) which corners see each other along a taut line; computed on first use."""
        corners = self.border.corners
        points = self.border.vertices[corners]
        sees = np.zeros((len(corners), len(corners)), dtype=bool)
        for i in range(len(corners)):
            kernels.seen_from(i, i + 1, points, corners, *self.arrays, sees[i])
        sees |= sees.T
        return sees

    @checked
    def nodes(self, start: Point, goal: Point) -> tuple[Array, Indices]:
        """Corners, start and goal as points (c + 2, 2), and which vertex each is (c + 2,), -1 for the last two."""
        corners = self.border.corners
        return np.vstack((self.border.vertices[corners], start, goal)), np.append(corners, (-1, -1))

    @checked
    def between(self, start: Point, goal: Point) -> VisibilityGraph:
        """The whole graph with a start and a goal, which must be free."""
        points, vertex = self.nodes(start, goal)
        c = len(points) - 2
        edges = np.zeros((c + 2, c + 2), dtype=bool)
        edges[:c, :c] = self.mutual
        slack = self.border.slack
        for node in (c, c + 1):
            kernels.seen_from(node, 0, points, vertex, *self.arrays, edges[node])
            seen = np.flatnonzero(edges[node])
            edges[node, seen[self.inside(points[[node]], points[seen])]] = False
            edges[:, node] = edges[node]
        edges[c, c + 1] = edges[c + 1, c] = edges[c, c + 1] or np.hypot(*(points[c] - points[c + 1])) <= slack
        return VisibilityGraph(self.border, points, edges)

    def inside(self, a: Array, b: Array) -> NDArray[np.bool_]:
        """Which lines from a (n, 2) to b (n, 2), of which one is not a corner, run inside an obstacle.

        The kernels find where a line crosses the border. A line inside an obstacle between two points of its border
        crosses nothing, and is found here. At a corner that cannot happen, as lines there are taut.
        """
        a, b = array("a", a, "n", 2), array("b", b, "n", 2)
        if 1 not in (len(a), len(b)) and len(a) != len(b):
            raise InvalidSetting(f"as many ends as beginnings, or one, got {len(a)} and {len(b)}")
        a, b = np.broadcast_arrays(a, b)
        return np.asarray(shapely.intersects(self.space.core, shapely.linestrings(np.stack((a, b), axis=1))))
