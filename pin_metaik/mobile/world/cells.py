"""Square cells over a workspace, for planners that go from cell to cell or need places to stand."""

from __future__ import annotations

import numpy as np

from pin_metaik.arrays import Array


def cell_middles(box: tuple[float, float, float, float], cells: int) -> Array:
    """The middles (rows, columns, 2) of cells that cover a box, as nearly square as they fit.

    Args:
        box: (x_min, y_min, x_max, y_max).
        cells: Along its longer side.
    """
    x_min, y_min, x_max, y_max = box
    width = max(x_max - x_min, y_max - y_min) / cells
    columns, rows = (max(1, round((high - low) / width)) for low, high in ((x_min, x_max), (y_min, y_max)))
    x = x_min + (np.arange(columns) + 0.5) * (x_max - x_min) / columns
    y = y_min + (np.arange(rows) + 0.5) * (y_max - y_min) / rows
    return np.stack(np.meshgrid(x, y), axis=-1)
