"""Curves in the panel, by uPlot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

COLOURS = ("#1f5fa8", "#c9432b", "#2a8a4a", "#8a4fb0", "#b8860b", "#107c8c", "#d0559a", "#6b6b6b")

Curves = Mapping[str, tuple[ArrayLike, ArrayLike]]
"""x and y of each curve by its name."""


def aligned(curves: Curves) -> tuple[NDArray[np.float64], ...]:
    """x and the y of each curve at every x that any of them has: uPlot takes one x for all, and no gaps.

    Between two of its points, and after its last, a curve has the value of the point before; before its first, of that.
    """
    points = [(np.asarray(x, dtype=float), np.asarray(y, dtype=float)) for x, y in curves.values()]
    xs = np.unique(np.concatenate([x for x, _ in points] or [np.zeros(0)]))
    if len(xs) < 2:  # uPlot has no scale for fewer
        xs = np.array([0.0, 1.0]) if not len(xs) else np.array([xs[0], xs[0] + 1.0])
    columns = [xs]
    for x, y in points:
        before = np.maximum(np.searchsorted(x, xs, side="right") - 1, 0)
        columns.append(y[before] if len(x) else np.zeros(len(xs)))
    return tuple(columns)


def drawable(columns: tuple[NDArray[np.float64], ...], log: bool) -> tuple[NDArray[np.float64], ...]:
    """The same with what an axis cannot show, infinite, or not above zero on a logarithmic one, at its edge."""
    values = np.concatenate(columns[1:])
    shown = values[np.isfinite(values) & ((values > 0.0) | (not log))]
    low, high = (shown.min(), shown.max()) if len(shown) else (1.0, 1.0)
    return columns[0], *(np.clip(np.nan_to_num(y, nan=low), low, high) for y in columns[1:])


def series_of(names: Sequence[str], x: str) -> tuple[dict[str, Any], ...]:
    """uPlot's series: x, then a line for each name, each in a colour of its own."""
    lines = [
        {"label": name, "stroke": COLOURS[number % len(COLOURS)], "width": 2, "spanGaps": False}
        for number, name in enumerate(names)
    ]
    return ({"label": x}, *lines)


class CurvePlot:
    """A plot of several curves, which may come and go.

    Args:
        gui: Of one tab.
        x: What runs along x, with its unit.
        y: What goes up, with its unit.
        log: Whether y is on a logarithmic scale.
    """

    def __init__(self, gui: Any, x: str, y: str, *, log: bool = False, height: int = 230) -> None:
        self._gui, self._x, self._y, self._log, self._height = gui, x, y, log, height
        self._holder = gui.add_folder(None)
        self._plot: Any = None
        self._names: list[str] = []
        self.show({y: ([], [])})

    def show(self, curves: Curves) -> None:
        """Show these curves. Other names make another plot: uPlot does not find its scales again after that."""
        if not curves:
            return
        data = drawable(aligned(curves), self._log)
        if list(curves) == self._names:
            self._plot.data = data
            return
        if self._plot is not None:
            self._plot.remove()
        self._names = list(curves)
        looks = {"stroke": "#888", "labelSize": 20}
        show = {"show": not self._log}
        axes = ({**looks, "label": self._x}, {**looks, "label": self._y, "grid": show, "ticks": show})
        scales = {"x": {"time": False}, "y": {"distr": 3} if self._log else {}}
        series = series_of(self._names, self._x)
        with self._holder:
            self._plot = self._gui.add_uplot(data, series, scales=scales, axes=axes, height=self._height, title=self._y)
