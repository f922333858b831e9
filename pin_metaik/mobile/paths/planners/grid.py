"""A* on a grid of cells, by networkx: what maps of cells are usually planned with (Hart, Nilsson and Raphael 1968)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import need
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.planners.protocol import Found, LineTests
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.world.cells import cell_middles
from pin_metaik.optimize.settings import whole

MOST = 2_000  # cells along a side: networkx takes a minute for a graph of a million
AROUND = 9  # cells that the start and the goal are joined to: the nearest, and those round it
STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))  # rows and columns to one of each pair of neighbours


@checked
@dataclass(frozen=True)
class GridAStar:
    """A*: the shortest path over the centres of square cells, each joined to its eight neighbours.

    Lines between neighbours are tested exactly, so that the path is free. Having only eight directions makes it up to
    8.24 percent too long in the open, and gaps narrower than about a cell may be missed. It ignores the budget: it
    tests the lines of the whole grid.

    Attributes:
        cells: Number of cells along the longer side of the workspace.
    """

    cells: int = 100

    def __post_init__(self) -> None:
        whole("cells", self.cells, 2)
        if self.cells > MOST:
            raise InvalidSetting(f"cells is at most {MOST:,} along a side, not {self.cells:,}")

    @checked
    def route(self, problem: PathProblem, tests: LineTests, rng: np.random.Generator) -> Found:
        """The shortest path over the grid; ``path`` is None if there is none."""
        need("A* on a grid", "planners", "networkx")
        import networkx as nx

        middles = cell_middles(problem.space.box, self.cells)
        places = np.vstack((middles.reshape(-1, 2), problem.scene.start, problem.scene.goal))
        start, goal = len(places) - 2, len(places) - 1
        graph = nx.Graph()
        graph.add_nodes_from((start, goal))
        graph.add_weighted_edges_from(_neighbours(middles, tests))
        for node in (start, goal):
            graph.add_weighted_edges_from(_onto(node, places, middles, tests))
        if tests.spent() and tests.stopped is not None:
            return Found(None)
        try:
            nodes = nx.astar_path(graph, start, goal, lambda a, b: math.dist(places[a], places[b]))
        except nx.NetworkXNoPath:
            return Found(None)
        return Found(Path(places[nodes]))


def _neighbours(middles: Array, tests: LineTests) -> list[tuple[int, int, float]]:
    """Free lines between neighbours: two cells, and the length."""
    rows, columns, _ = middles.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    pairs = []
    for down, right in STEPS:
        left = max(0, -right)
        one = number[: rows - down, left : columns - max(0, right)]
        other = number[down:, left + right : columns - max(0, right) + right]
        pairs.append(np.stack((one.ravel(), other.ravel()), axis=1))
    both = np.concatenate(pairs)
    lines = middles.reshape(-1, 2)[both]
    free = tests.free_lines(lines)
    lengths = np.hypot(*(lines[free, 1] - lines[free, 0]).T)
    return [(int(a), int(b), float(length)) for (a, b), length in zip(both[free], lengths, strict=True)]


def _onto(node: int, places: Array, middles: Array, tests: LineTests) -> list[tuple[int, int, float]]:
    """Free lines from the start or goal, a node of places (n, 2), to the cells around it."""
    away = np.hypot(*(places[: middles[..., 0].size] - places[node]).T)
    near = np.argsort(away, kind="stable")[:AROUND]
    lines = places[np.column_stack((np.full(len(near), node), near))]
    return [(node, int(cell), float(away[cell])) for cell in near[tests.free_lines(lines)]]
