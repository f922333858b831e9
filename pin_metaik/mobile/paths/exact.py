"""The shortest path among polygons: visibility graph, Dijkstra, and a proof that what comes out is free."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from pin_metaik.arguments import checked
from pin_metaik.mobile.errors import NoPath
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.visibility import Visibility, VisibilityGraph
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.scene import Point


@checked
def shortest_path(space: FreeSpace, start: Point, goal: Point, visibility: Visibility | None = None) -> Path:
    """The shortest path that keeps the space's clearance.

    Args:
        space: The free space.
        start: (x, y).
        goal: (x, y).
        visibility: The graph of the space, if it was already built.

    Raises:
        Blocked: The robot cannot be at the start or the goal.
        NoPath: There is no way between them.
    """
    space.check("start", start)
    space.check("goal", goal)
    if start == goal:
        return Path(np.array([start, goal]))
    graph = (visibility or Visibility(space)).between(start, goal)
    while True:
        nodes = _route(graph)
        if nodes is None:
            raise NoPath(start, goal, space.clearance)
        path = Path(graph.points[nodes])
        if space.holds(path.points):
            return path.straightened(graph.border.slack)
        graph = _without_blocked(graph, nodes, space)


def _route(graph: VisibilityGraph) -> list[int] | None:
    """Nodes of the shortest way from start to goal; None if there is none."""
    _, before = dijkstra(graph.weights, directed=False, indices=graph.start, return_predecessors=True)
    nodes = [graph.goal]
    while nodes[-1] != graph.start:
        if before[nodes[-1]] < 0:
            return None
        nodes.append(int(before[nodes[-1]]))
    return nodes[::-1]


def _without_blocked(graph: VisibilityGraph, nodes: list[int], space: FreeSpace) -> VisibilityGraph:
    """The graph without the first edge of a way that the exact test refuses: one that was let through by rounding."""
    for i, j in zip(nodes[:-1], nodes[1:], strict=True):
        if not space.holds(graph.points[[i, j]]):
            return graph.without(i, j)
    raise AssertionError("a path met an obstacle that none of its segments meets")
