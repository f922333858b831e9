"""A grid over the border of a free space: whether two points see each other is tested with the edges near the line."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.mobile.paths import visibility_kernels as kernels
from pin_metaik.mobile.world.border import Border, Indices

CELLS = 2  # for each edge


@dataclass(frozen=True, eq=False)
class EdgeGrid:
    """Square cells, row after row, and the edges near each.

    Attributes:
        first: Where the edges of each cell begin (cells + 1,).
        edges: Edges, those of one cell after those of another.
        place: x and y of the lower left corner, and the width of a cell (3,).
        columns: Cells in a row.
    """

    first: Indices
    edges: Indices
    place: Array
    columns: int

    @staticmethod
    def of(border: Border) -> EdgeGrid:
        """The grid of a border."""
        corner = border.vertices.min(axis=0, initial=np.inf)
        if not len(border.vertices):
            return EdgeGrid(np.zeros(2, dtype=np.int64), np.empty(0, dtype=np.int64), np.array([0.0, 0.0, 1.0]), 1)
        size = border.vertices.max(axis=0) - corner
        width = max(math.sqrt(size[0] * size[1] / (CELLS * len(border.vertices))), size.max() / len(border.vertices))
        columns, rows = (int(n) + 1 for n in size / width)
        place = np.array([*corner, width])
        pad = 4 * border.slack + 1e-9 * width
        counts = np.zeros(rows * columns + 1, dtype=np.int64)
        sort = (border.vertices, border.after, pad, place, columns, rows)
        kernels.sort_into_cells(*sort, counts, np.empty(0, dtype=np.int64))
        ends = np.cumsum(counts)
        first = ends - counts
        edges = np.empty(ends[-1], dtype=np.int64)
        kernels.sort_into_cells(*sort, first.copy(), edges)
        return EdgeGrid(first, edges, place, columns)

    @property
    def arrays(self) -> tuple[Indices, Indices, Array, int]:
        """What every kernel takes after the border."""
        return self.first, self.edges, self.place, self.columns
