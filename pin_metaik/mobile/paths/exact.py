"""The shortest path among polygons: A* over the visibility graph, and a proof that the path is free.

The graph is never built: a corner's lines of sight are looked for when the search opens it (A* opens those near the
straight line first, and in an open world few others).
"""

from __future__ import annotations

from contextlib import nullcontext
from heapq import heappop, heappush

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.errors import NoPath
from pin_metaik.mobile.paths import visibility_kernels as kernels
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.visibility import Visibility
from pin_metaik.mobile.world.border import Indices
from pin_metaik.mobile.world.freespace import LARGE, FreeSpace
from pin_metaik.mobile.world.scene import Point
from pin_metaik.notice import notice

Edges = set[tuple[int, int]]


@checked
def shortest_path(space: FreeSpace, start: Point, goal: Point, visibility: Visibility | None = None) -> Path:
    """The shortest path in a free space.

    Args:
        space: The free space.
        start: (x, y).
        goal: (x, y).
        visibility: Visibility of the space, if it was prepared earlier.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no path between them.
    """
    space.check("start", start)
    space.check("goal", goal)
    if start == goal:
        return Path(np.array([start, goal]))
    if not space.connects(start, goal):
        raise NoPath(start, goal, space.clearance, space.nearly_connects(start, goal), space.join)
    search = Search.between(visibility or Visibility(space), start, goal)
    corners = len(search.points)
    with notice(f"shortest path among {corners:,} corners") if corners > LARGE else nullcontext():
        path = search.free_path()
    if path is None:
        raise NoPath(start, goal, space.clearance, space.nearly_connects(start, goal), space.join)
    return path


class Search:
    """A* between a start and a goal.

    Attributes:
        visibility: Visibility of the space.
        points: Nodes (m, 2): the corners, start, goal.
        vertex: Which vertex of the border each node is (m,); -1 for start and goal.
    """

    def __init__(self, visibility: Visibility, points: Array, vertex: Indices) -> None:
        self.visibility, self.points, self.vertex = visibility, points, vertex
        self._arrays = visibility.arrays
        self._to_go = np.hypot(*(points - points[-1]).T)
        self._found = np.empty(len(points), dtype=np.int64)

    @staticmethod
    def between(visibility: Visibility, start: Point, goal: Point) -> Search:
        """The search from a start to a goal, which must be free."""
        return Search(visibility, *visibility.nodes(start, goal))

    def free_path(self) -> Path | None:
        """The shortest way that the exact test lets through, too; None if there is no such way."""
        refused: Edges = set()
        space = self.visibility.space
        while (nodes := self.route(refused)) is not None:
            path = Path(self.points[nodes])
            if space.holds(path.points):
                return path.straightened(self.visibility.border.slack)
            refused.add(_first_blocked(self.points, nodes, space))
        return None

    def route(self, refused: Edges) -> list[int] | None:
        """Nodes of the shortest way from start to goal along no edge that is refused; None if there is no such way."""
        m = len(self.points)
        start, goal = m - 2, m - 1
        length, settled = np.full(m, np.inf), np.zeros(m, dtype=bool)
        before = np.full(m, -1)
        length[start] = 0.0
        heap = [(float(self._to_go[start]), start)]
        while heap:
            _, node = heappop(heap)
            if node == goal:
                return _traced(before, goal)
            if settled[node]:
                continue
            settled[node] = True
            seen = self._opened(node, int(before[node]), length, settled, refused)
            length[seen] = length[node] + np.hypot(*(self.points[seen] - self.points[node]).T)
            before[seen] = node
            for each, whole in zip(seen.tolist(), (length[seen] + self._to_go[seen]).tolist(), strict=True):
                heappush(heap, (whole, each))
        return None

    def _opened(self, node: int, came_from: int, length: Array, settled: NDArray[np.bool_], refused: Edges) -> Indices:
        """The nodes (k,) that are nearer to the start through this one."""
        m = len(self.points)
        count = kernels.nearer_through(
            node,
            came_from,
            self.points,
            self.vertex,
            length,
            self._to_go,
            settled,
            float(length[-1]),
            *self._arrays,
            self._found,
        )
        seen = self._found[:count].copy()
        unsure = seen >= (0 if self.vertex[node] < 0 else m - 2)  # one end is no corner
        unsure[unsure] = self.visibility.inside(self.points[[node]], self.points[seen[unsure]])
        free = seen[~unsure]
        return np.array([each for each in free.tolist() if (node, each) not in refused], dtype=np.int64)


def _traced(before: Indices, goal: int) -> list[int]:
    """Nodes from the start to the goal."""
    nodes = [goal]
    while before[nodes[-1]] >= 0:
        nodes.append(int(before[nodes[-1]]))
    return nodes[::-1]


def _first_blocked(points: Array, nodes: list[int], space: FreeSpace) -> tuple[int, int]:
    """The first edge of a way that the exact test refuses: one that was let through by rounding."""
    for i, j in zip(nodes[:-1], nodes[1:], strict=True):
        if not space.holds(points[[i, j]]):
            return i, j
    raise AssertionError("a path met an obstacle that none of its segments meets")
