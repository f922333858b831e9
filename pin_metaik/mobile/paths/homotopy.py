"""Alternatives: the shortest paths of the k best homotopy classes.

Among polygons every homotopy class has exactly one taut path, a polyline that bends at corners only and wraps around
their obstacles. So the k shortest taut paths are the k best classes, one each. They are found best first, over partial
paths, led by the exact distance that a taut path still has to go.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.paths.exact import shortest_path
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.visibility import Visibility, VisibilityGraph
from pin_metaik.mobile.world.border import Indices
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.scene import Point
from pin_metaik.optimize.settings import whole

LARGEST = 100_000  # partial paths looked at before giving up on more alternatives


@checked
def shortest_paths(
    space: FreeSpace, start: Point, goal: Point, count: int, visibility: Visibility | None = None
) -> list[Path]:
    """The shortest paths of the `count` best homotopy classes, shortest first.

    Paths that pass a corner twice or cross themselves are left out.

    Args:
        space: The free space.
        start: (x, y).
        goal: (x, y).
        count: How many, at least 1; fewer come back if there are no more, or after 100,000 partial paths.
        visibility: The graph of the space, if it was already built.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no path between them.
        InvalidSetting: A count below 1.
    """
    whole("count", count, 1)
    visibility = visibility or Visibility(space)
    best = shortest_path(space, start, goal, visibility)
    if count == 1 or start == goal:
        return [best]
    graph = visibility.between(start, goal)
    taut = TautGraph.of(graph)
    found: list[Path] = []
    first = np.flatnonzero(taut.edges[:, 0] == graph.start)
    heap: list[tuple[float, float, tuple[int, ...]]] = []
    for e in first[np.isfinite(taut.to_goal[first])]:
        heappush(heap, (float(taut.lengths[e] + taut.to_goal[e]), float(taut.lengths[e]), (int(e),)))
    for _ in range(LARGEST):
        if not heap or len(found) == count:
            break
        _, length, walk = heappop(heap)
        nodes = taut.edges[list(walk), 1]
        path = Path(np.vstack((graph.points[graph.start], graph.points[nodes])))
        if not shapely.LineString(path.points).is_simple:
            continue
        if nodes[-1] == graph.goal:
            if space.holds(path.points):
                found.append(path.straightened(graph.border.slack))
            continue
        for e in taut.after(walk[-1]):
            if taut.edges[e, 1] not in nodes and np.isfinite(taut.to_goal[e]):
                further = length + taut.lengths[e]
                heappush(heap, (further + taut.to_goal[e], further, (*walk, int(e))))
    return found or [best]


@dataclass(frozen=True, eq=False)
class TautGraph:
    """Directed edges of a visibility graph, and which may follow which on a taut path.

    Attributes:
        edges: From node to node (e, 2).
        lengths: Their lengths (e,).
        follows: Sparse (e, e): entry (a, b), the length of b, if b may follow a.
        to_goal: Length a taut path has to go after each edge (e,); inf if none gets to the goal.
    """

    edges: Indices
    lengths: Array
    follows: csr_array
    to_goal: Array

    @staticmethod
    def of(graph: VisibilityGraph) -> TautGraph:
        """The taut graph of a visibility graph."""
        edges = np.argwhere(graph.edges)
        along = graph.points[edges[:, 1]] - graph.points[edges[:, 0]]
        lengths = np.hypot(along[:, 0], along[:, 1])
        one, other = [], []
        border = graph.border
        for node, k in enumerate(border.corners):
            into, out = np.flatnonzero(edges[:, 1] == node), np.flatnonzero(edges[:, 0] == node)
            obstacle = border.vertices[[border.before[k], border.after[k]]] - border.vertices[k]
            a, b = np.nonzero(_wraps(along[into], along[out], obstacle, border.slack))
            one.append(into[a])
            other.append(out[b])
        a, b = np.concatenate([np.empty(0, int), *one]), np.concatenate([np.empty(0, int), *other])
        follows = csr_array((lengths[b], (a, b)), shape=(len(edges), len(edges)))
        last = np.flatnonzero(edges[:, 1] == graph.goal)
        to_goal = dijkstra(follows.T, indices=last, min_only=True)
        return TautGraph(edges, lengths, follows, to_goal)

    def after(self, edge: int) -> Indices:
        """The edges that may follow one."""
        where: Indices = self.follows.indices[self.follows.indptr[edge] : self.follows.indptr[edge + 1]]
        return where


def _wraps(into: Array, out: Array, obstacle: Array, slack: float) -> NDArray[np.bool_]:
    """Whether a path may bend at a corner, for each way in (p, 2) and out (q, 2): (p, q).

    It may towards the obstacle, which must stay on the same side; and it may go straight on.

    Args:
        into: Vectors that end at the corner.
        out: Vectors that begin there.
        obstacle: Vectors (2, 2) along the obstacle's edges at the corner.
        slack: Distance from a line that still is on it.
    """
    turn = into[:, 0, None] * out[:, 1] - into[:, 1, None] * out[:, 0]
    longer = np.maximum(np.hypot(*into.T)[:, None], np.hypot(*out.T))
    straight = np.abs(turn) <= slack * longer  # the corner is within the slack of the line past it
    left = _is_left(into, obstacle)[:, None]
    bends = ~straight & ((turn > 0) == left) & (_is_left(out, obstacle) == left)
    may: NDArray[np.bool_] = bends | (straight & (into @ out.T > 0))
    return may


def _is_left(along: Array, edges: Array) -> NDArray[np.bool_]:
    """Whether an obstacle with these edges (2, 2) at the origin is left of lines (k, 2) that touch it there."""
    offset = along[:, 0, None] * edges[:, 1] - along[:, 1, None] * edges[:, 0]  # (k, 2)
    larger = np.abs(offset).argmax(axis=1)
    left: NDArray[np.bool_] = offset[np.arange(len(along)), larger] > 0
    return left
