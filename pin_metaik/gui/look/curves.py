"""Curves in the panel, by uPlot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

COLOURS = ("#1f5fa8", "#c9432b", "#2a8a4a", "#8a4fb0", "#b8860b", "#107c8c", "#d0559a", "#6b6b6b")

PADDING = (12, 32, 0, 0)  # pixels above, right, below and left: the outermost numbers have room
Line = tuple[ArrayLike, ArrayLike]
"""x and y."""
Curves = Mapping[str, Line | tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]]
"""Of each curve by its name x and y, and perhaps the lower and the upper edge of a band around it."""


def lines_of(curves: Curves) -> tuple[dict[str, Line], list[int]]:
    """All lines, edges of bands as lines of their own below their curve, and which curve each is of."""
    lines: dict[str, Line] = {}
    numbers = []
    for number, (name, (x, *ys)) in enumerate(curves.items()):
        for label, y in zip((name, f"{name}, lower quartile", f"{name}, upper quartile"), ys, strict=False):
            lines[label] = (x, y)
            numbers.append(number)
    return lines, numbers


def aligned(curves: Mapping[str, Line]) -> tuple[NDArray[np.float64], ...]:
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


def series_of(names: Sequence[str], numbers: Sequence[int], x: str) -> tuple[dict[str, Any], ...]:
    """uPlot's series: x, then the lines, those of a curve in one colour, and its first the widest."""
    lines = [
        {
            "label": name,
            "stroke": COLOURS[number % len(COLOURS)],
            "width": 2 if number not in numbers[:k] else 0.5,
            "spanGaps": False,
        }
        for k, (name, number) in enumerate(zip(names, numbers, strict=True))
    ]
    return ({"label": x}, *lines)


def bands_of(numbers: Sequence[int]) -> tuple[dict[str, Any], ...]:
    """uPlot's bands: between the two edges of each curve that has them."""
    edges = [k for k, number in enumerate(numbers) if numbers.count(number) == 3]
    return tuple(
        {"series": (upper + 1, lower + 1), "fill": f"{COLOURS[numbers[lower] % len(COLOURS)]}22"}
        for _, lower, upper in zip(edges[::3], edges[1::3], edges[2::3], strict=True)
    )


class CurvePlot:
    """A plot of several curves, which may come and go.

    Args:
        gui: Of one tab.
        x: What runs along x, with its unit.
        y: What goes up, with its unit.
        log: Whether y is on a logarithmic scale.
        log_x: Whether x is.
    """

    def __init__(self, gui: Any, x: str, y: str, *, log: bool = False, log_x: bool = False, height: int = 230) -> None:
        self._gui, self._x, self._y, self._log, self._log_x, self._height = gui, x, y, log, log_x, height
        self._holder = gui.add_folder(None)
        self._plot: Any = None
        self._names: list[str] = []

    def show(self, curves: Curves) -> None:
        """Show these curves; of none, nothing. Other names make another plot: uPlot finds its scales only once."""
        lines, numbers = lines_of(curves)
        if self._plot is not None and list(lines) == self._names:
            self._plot.data = drawable(aligned(lines), self._log)
            return
        if self._plot is not None:
            self._plot.remove()
            self._plot = None
        self._names = list(lines)
        if not lines:
            return
        axes = (self._axis(self._x, self._log_x), self._axis(self._y, self._log))
        scales = {"x": {"time": False, "distr": 3 if self._log_x else 1}, "y": {"distr": 3 if self._log else 1}}
        series, bands = series_of(self._names, numbers, self._x), bands_of(numbers)
        with self._holder:
            self._plot = self._gui.add_uplot(
                drawable(aligned(lines), self._log),
                series,
                bands=bands or None,
                scales=scales,
                axes=axes,
                height=self._height,
                padding=PADDING,
                title=self._y,
            )

    @staticmethod
    def _axis(label: str, log: bool) -> dict[str, Any]:
        """An axis; a logarithmic one has no grid, whose lines are many."""
        shown = {"show": not log}
        return {"stroke": "#888", "labelSize": 20, "label": label, "grid": shown, "ticks": shown}
