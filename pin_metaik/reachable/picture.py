"""A picture of a map: how many orientations are reached, and how well the chain can move there, slice by slice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.figures import need_plots, new_figure, picture_file
from pin_metaik.optimize.settings import few
from pin_metaik.reachable.result import Reachability

DPI = 150
NONE = "#f2f0ec"  # where nothing is reached


@checked
def save_reachability(found: Reachability, path: str | Path, *, slices: int = 4) -> Path:
    """Draw a map to a file; its suffix gives the format (``.png``, ``.svg``, ``.pdf``).

    Args:
        found: The map.
        path: The file.
        slices: How many heights of a grid to show, evenly from the lowest to the highest with anything reached.

    Raises:
        MissingExtra: If matplotlib is not installed.
        CannotWrite: If the file cannot be written.
        InvalidSetting: If there is not at least one slice, or the suffix is not one of a picture.
    """
    few("slices", slices)
    where = picture_file(path)
    figure = new_figure((3.2 * slices + 1.0, 6.4) if _is_grid(found) else (8.0, 4.0))
    draw_reachability(figure, found, slices=slices)
    figure.savefig(where, dpi=DPI)
    return where


@checked
def draw_reachability(figure: Any, found: Reachability, *, slices: int = 4) -> None:
    """Draw a map into an empty ``matplotlib.figure.Figure``.

    The upper row shows the share of orientations that is reached, the lower one the greatest manipulability. For a
    grid, each column is a height; for a list of positions there is one column, seen from above.

    Args:
        figure: The empty figure.
        found: The map.
        slices: How many heights of a grid to show.

    Raises:
        MissingExtra: If matplotlib is not installed.
        InvalidSetting: If there is not at least one slice, or the figure is not one of matplotlib.
    """
    need_plots()
    few("slices", slices)
    if not hasattr(figure, "subplots"):
        raise InvalidSetting("figure is one of matplotlib's: matplotlib.figure.Figure()")
    values = (found.share, "share of orientations"), (found.best, "best manipulability")
    if not _is_grid(found):
        for ax, (colours, title) in zip(figure.subplots(1, 2, squeeze=False)[0], values, strict=True):
            order = np.argsort(colours)
            drawn = ax.scatter(*found.positions[order, :2].T, c=colours[order], s=12)
            _label(ax, "seen from above")
            figure.colorbar(drawn, ax=ax, label=title)
        return
    a, b, c = found.shape
    places = found.positions.reshape(a, b, c, 3)
    heights = _heights(found.share.reshape(a, b, c), slices)
    axes = figure.subplots(2, len(heights), squeeze=False, sharex=True, sharey=True)
    x, y = places[:, 0, 0, 0], places[0, :, 0, 1]
    for row, (colours, title) in zip(axes, values, strict=True):
        cells, top = colours.reshape(a, b, c), float(colours.max()) or 1.0
        for ax, k in zip(row, heights, strict=True):
            shown = np.ma.masked_equal(cells[:, :, k].T, 0.0)
            drawn = ax.pcolormesh(x, y, shown, vmin=0.0, vmax=top, shading="nearest")
            ax.set_facecolor(NONE)
            _label(ax, f"z = {places[0, 0, k, 2]:.2f} m")
            ax.label_outer()
        figure.colorbar(drawn, ax=list(row), label=title)


def _is_grid(found: Reachability) -> bool:
    return found.shape[0] > 1 and found.shape[1] > 1


def _heights(share: Any, slices: int) -> list[int]:
    """Numbers of the slices to show."""
    some = np.flatnonzero(share.any(axis=(0, 1)))
    low, high = (int(some[0]), int(some[-1])) if len(some) else (0, share.shape[2] - 1)
    return sorted(set(np.linspace(low, high, min(slices, high - low + 1)).round().astype(int).tolist()))


def _label(ax: Any, title: str) -> None:
    ax.set_title(title, fontsize=10)
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")
    ax.set_aspect("equal")
