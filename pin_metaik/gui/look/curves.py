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
    """x and the y of each curve at every x that any of them has: uPlot takes one x for all.

    Between two of its points, and after its last, a curve has the value of the point before; NaN before its first.
    """
    points = [(np.asarray(x, dtype=float), np.asarray(y, dtype=float)) for x, y in curves.values()]
    xs = np.unique(np.concatenate([x for x, _ in points] or [np.zeros(0)]))
    if len(xs) < 2:  # uPlot has no scale for fewer
        xs = np.array([0.0, 1.0]) if not len(xs) else np.array([xs[0], xs[0] + 1.0])
    columns = [xs]
    for x, y in points:
        index = np.searchsorted(x, xs, side="right") - 1
        columns.append(np.where(index >= 0, y[np.maximum(index, 0)], np.nan) if len(x) else np.full(len(xs), np.nan))
    return tuple(columns)


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
        self._x = x
        looks = {"stroke": "#888", "labelSize": 20}
        axes = ({**looks, "label": x}, {**looks, "label": y, "grid": {"show": not log}, "ticks": {"show": not log}})
        scales = {"x": {"time": False}, "y": {"distr": 3} if log else {}}
        self._log = log
        self._plot = gui.add_uplot(
            aligned({"": ([], [])}), series_of([y], x), scales=scales, axes=axes, height=height, title=y
        )

    def show(self, curves: Curves) -> None:
        """Show these curves."""
        if not curves:
            return
        data = aligned(curves)
        if self._log:
            data = (data[0], *(np.where(y > 0, y, np.nan) for y in data[1:]))
        series = series_of(list(curves), self._x)
        if len(series) != len(self._plot.series):
            self._plot.series = series
        self._plot.data = data
