"""The visibility graph: corners of the free space and the straight lines between them that a shortest path can have.

A shortest path among polygons bends only at corners, and at both ends of every piece it touches the obstacle without
cutting it (it is taut; Lozano-Perez and Wesley 1979). Few pairs of corners are, so most are never tested.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import csr_array

from pin_metaik.arguments import checked
from pin_metaik.mobile.paths import visibility_kernels as kernels
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.growth import rings
from pin_metaik.mobile.world.scene import Point
from pin_metaik.optimize.space import Array

Indices = NDArray[np.int64]
SLACK = 0.5  # of what counts as touching: points nearer to a line are on it


@dataclass(frozen=True, eq=False)
class Border:
    """The border of a free space as arrays; the free side is on the left.

    Attributes:
        vertices: (n, 2).
        before: The vertex before along the ring (n,).
        after: The vertex after along the ring (n,).
        bends: Whether a shortest path can bend there (n,): the free space is wider than a half-plane.
        slack: How far from a line a point still counts as on it.
    """

    vertices: Array
    before: Indices
    after: Indices
    bends: NDArray[np.bool_]
    slack: float

    @staticmethod
    def of(space: FreeSpace) -> Border:
        """The border of a free space."""
        slack = SLACK * space.touch
        outlines = list(rings(space.region))
        first = np.cumsum([0, *map(len, outlines)])
        before = [start + (np.arange(len(ring)) - 1) % len(ring) for start, ring in zip(first, outlines, strict=False)]
        vertices = np.ascontiguousarray(np.concatenate([np.empty((0, 2)), *outlines]))
        back = np.concatenate([np.empty(0, dtype=np.int64), *before])
        on = np.empty_like(back)
        on[back] = np.arange(len(back))
        return Border(vertices, back, on, _turns_right(vertices[back], vertices, vertices[on], slack), slack)

    @property
    def arrays(self) -> tuple[Array, Indices, Indices]:
        """What every kernel takes first."""
        return self.vertices, self.before, self.after

    @cached_property
    def corners(self) -> Indices:
        """Indices (c,) of the vertices a shortest path can bend at."""
        return np.flatnonzero(self.bends)


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

    def without(self, i: int, j: int) -> VisibilityGraph:
        """The graph without one edge."""
        edges = self.edges.copy()
        edges[i, j] = edges[j, i] = False
        return VisibilityGraph(self.border, self.points, edges)


@checked
class Visibility:
    """The part of the graph that does not depend on start and goal, built once for a free space.

    Attributes:
        space: The free space.
        border: Its border.
        mutual: Which corners see each other along a taut line (c, c).
    """

    def __init__(self, space: FreeSpace) -> None:
        self.space = space
        self.border = Border.of(space)
        corners = self.border.corners
        self.mutual = np.zeros((len(corners), len(corners)), dtype=bool)
        kernels.see_each_other(*self.border.arrays, corners, self.border.bends, self.border.slack, self.mutual)

    @checked
    def between(self, start: Point, goal: Point) -> VisibilityGraph:
        """The graph with a start and a goal, which must be free."""
        border, c = self.border, len(self.border.corners)
        edges = np.zeros((c + 2, c + 2), dtype=bool)
        edges[:c, :c] = self.mutual
        for node, (x, y) in ((c, start), (c + 1, goal)):
            seen = np.zeros(c, dtype=bool)
            kernels.seen_from(x, y, *border.arrays, border.corners, border.bends, border.slack, seen)
            edges[node, :c] = edges[:c, node] = seen
        ends = (start[0], start[1], goal[0], goal[1])
        direct = kernels.sees(*ends, *border.arrays, border.bends, border.slack)
        edges[c, c + 1] = edges[c + 1, c] = direct
        points = np.vstack((border.vertices[border.corners], start, goal))
        return VisibilityGraph(border, points, self._outside(points, edges))

    def _outside(self, points: Array, edges: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Edges (n, n) without those from start and goal, the last two points, that run inside an obstacle.

        Kernels see where a line crosses the border. From one point on it to another, inside, it crosses nothing; at a
        corner that cannot be, as lines are taut there.
        """
        i, j = np.nonzero(edges[-2:])
        i += len(points) - 2
        inside = shapely.intersects(self.space.core, shapely.linestrings(np.stack((points[i], points[j]), axis=1)))
        edges[i[inside], j[inside]] = edges[j[inside], i[inside]] = False
        return edges


def _turns_right(before: Array, here: Array, after: Array, slack: float) -> NDArray[np.bool_]:
    """Where a border (n, 2) with the free space on its left turns right, by more than rounding."""
    (ux, uy), (vx, vy), (x, y) = (here - before).T, (after - here).T, (after - before).T
    length = np.hypot(x, y)
    right: NDArray[np.bool_] = np.where(length > 0, x * uy - y * ux > slack * length, ux * vy - uy * vx < 0)
    return right
