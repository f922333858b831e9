"""Figures of comparisons, drawn into a matplotlib figure that is handed in: nothing here imports matplotlib."""

from __future__ import annotations

import itertools
import re
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pin_metaik.arrays import Array
from pin_metaik.compare.results.series import Duels

# Okabe and Ito, black first and their yellow left out: told apart by every eye. Grey, brown, violet if they run out.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#8b4513", "#6a3d9a")
STYLES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))
GRID = {"alpha": 0.25, "linewidth": 0.6}


@dataclass(frozen=True)
class Line:
    """How the lines of a method are drawn."""

    color: str
    linestyle: Any
    linewidth: float


def lines(methods: Sequence[str], thick: Container[str] = ()) -> dict[str, Line]:
    """A line for each method: its colour says where starts come from, its style what follows.

    ``gwo+dls`` and ``gwo`` have one colour, ``gwo+dls`` and ``mtde+dls`` one style; ``lm`` and ``lm+restarts`` differ
    in style, ``lm+restarts`` and ``dls+restarts`` in colour.
    """
    firsts = {method: re.split("[@+]", method, maxsplit=1)[0] for method in methods}
    parts = {method: (first, method.removeprefix(first)) for method, first in firsts.items()}
    colours = dict(zip(dict.fromkeys(first for first, _ in parts.values()), itertools.cycle(COLOURS), strict=False))
    rest = sorted(dict.fromkeys(rest for _, rest in parts.values()), key=lambda rest: (rest != "+restarts", rest == ""))
    styles = dict(zip(rest, itertools.cycle(STYLES), strict=False))
    return {m: Line(colours[first], styles[rest], 3.0 if m in thick else 1.5) for m, (first, rest) in parts.items()}


def panels(canvas: Any, titles: Sequence[str], **shared: Any) -> dict[str, Any]:
    """Axes by title, in rows."""
    columns, rows = _grid(len(titles))
    axes = canvas.subplots(rows, columns, squeeze=False, **shared).ravel()
    for ax in axes[len(titles) :]:
        ax.remove()
    for ax, title in zip(axes, titles, strict=False):
        ax.set_title(title, fontsize="medium", loc="left")
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
    return dict(zip(titles, axes, strict=False))


def panel_size(count: int) -> tuple[float, float]:
    """Width and height in inches of a figure with so many panels and a legend below."""
    columns, rows = _grid(count)
    return 10.6 if columns > 1 else 6.5, (3.0 if columns == 3 else 3.4) * rows + 0.9


def _grid(count: int) -> tuple[int, int]:
    """Columns and rows of so many panels."""
    columns = {1: 1, 2: 2, 4: 2}.get(count, 3)
    return columns, -(-count // columns)


def distributions(canvas: Any, shares: Mapping[str, Mapping[str, Array]], at: Array, looks: Mapping[str, Line]) -> None:
    """Share of tasks solved within so many evaluations, a panel a case.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        shares: Shares (m,) by method by case.
        at: (m,) evaluations.
        looks: How the methods are drawn.
    """
    axes = panels(canvas, list(shares), sharex=True, sharey=True)
    for case, ax in axes.items():
        for method, share in shares[case].items():
            ax.step(at, share, where="post", label=method, **vars(looks[method]))
        ax.set(xscale="log", ylim=(-0.02, 1.02), xlim=(at[0], at[-1]))
        ax.grid(**GRID)
    _labelled(canvas, axes, "kernel evaluations", "share of trials solved")


def rates(canvas: Any, found: Mapping[str, Mapping[str, tuple[float, float, float]]]) -> None:
    """Rates with their intervals, a panel a case, a line a method, the highest rate first.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        found: Rate, lower and upper end of its interval, by method by case.
    """
    axes = panels(canvas, list(found), sharex=True)
    for case, ax in axes.items():
        order = sorted(found[case], key=lambda method: found[case][method], reverse=True)
        for i, method in enumerate(order):
            rate, low, high = found[case][method]
            ax.plot([low, high], [i, i], color="#0072b2", linewidth=3, alpha=0.35, solid_capstyle="round")
            ax.plot(rate, i, "o", color="#0072b2", markersize=5)
        ax.set(ylim=(len(order) - 0.5, -0.5), xlim=(-0.03, 1.03))
        ax.set_yticks(range(len(order)), order, fontsize="small")
        ax.grid(**GRID)
    _labelled(canvas, axes, "share solved, with its 95 % interval", "", legend=False)


def convergence(canvas: Any, curves: Mapping[str, Mapping[str, Array]], at: Array, looks: Mapping[str, Line]) -> None:
    """Median of the best cost so far, and the middle half of the trials, a panel a case.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        curves: Lower quartile, median and upper quartile (3, m) by method by case.
        at: (m,) evaluations.
        looks: How the methods are drawn.
    """
    axes = panels(canvas, list(curves), sharex=True, sharey=True)
    for case, ax in axes.items():
        for method, (low, middle, high) in curves[case].items():
            ax.fill_between(at, low, high, color=looks[method].color, alpha=0.12, linewidth=0)
            ax.plot(at, middle, label=method, linewidth=looks[method].linewidth, color=looks[method].color)
        ax.set(xscale="log", yscale="log")
        ax.grid(**GRID)
    _labelled(canvas, axes, "kernel evaluations", "best cost so far, m + rad")


def duels(canvas: Any, fought: Mapping[str, Duels]) -> None:
    """Every method against every other, a panel a case: how many times fewer evaluations the row's method takes.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        fought: All pairs, by case.
    """
    axes = panels(canvas, list(fought), sharex=True, sharey=True)
    image = None
    for case, ax in axes.items():
        names, ratios, certain = fought[case].methods, fought[case].ratios, fought[case].certain
        image = ax.imshow(ratios, cmap="RdBu_r", vmin=-2.0, vmax=2.0)
        for i, j in itertools.permutations(range(len(names)), 2):
            dark = abs(ratios[i, j]) > 1.2
            colour = ("white" if dark else "black") if certain[i, j] else "#8a8a8a"
            size = min(8.0, 60.0 / len(names))
            ax.text(j, i, times(ratios[i, j]), color=colour, fontsize=size, ha="center", va="center")
        ax.set_xticks(range(len(names)), names, rotation=90, fontsize="x-small")
        ax.set_yticks(range(len(names)), names, fontsize="x-small")
        ax.tick_params(length=0)
    if image is not None:
        bar = canvas.colorbar(image, ax=list(axes.values()), shrink=0.7, location="right")
        bar.set_ticks([-2, -1, 0, 1, 2], labels=["100x less", "10x less", "equal", "10x more", "100x more"])


def times(exponent: float) -> str:
    """10 to a power, in at most four letters."""
    value = 10.0**exponent
    return f"{value:.0f}" if value >= 9.95 else f"{value:.1f}" if value >= 0.995 else f"{value:.2g}".lstrip("0")[:4]


def _labelled(canvas: Any, axes: Mapping[str, Any], x: str, y: str, legend: bool = True) -> None:
    """Labels at the outer panels, and one legend for all of them."""
    grids = [(ax, ax.get_subplotspec()) for ax in axes.values()]
    for ax, spec in grids:
        if spec.is_first_col():
            ax.set_ylabel(y)
        below = any(s.rowspan.start > spec.rowspan.start and s.colspan == spec.colspan for _, s in grids)
        if not below:
            ax.set_xlabel(x)
            ax.tick_params(labelbottom=True)
    if legend:
        named = {label: line for ax, _ in grids for line, label in zip(*ax.get_legend_handles_labels(), strict=True)}
        canvas.legend(
            named.values(), named.keys(), loc="outside lower center", ncols=min(6, len(named)), frameon=False,
            fontsize="small", handlelength=2.6,
        )  # fmt: skip
