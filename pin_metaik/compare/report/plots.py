"""Figures of searches, drawn into a matplotlib figure that is handed in: nothing here imports matplotlib."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pin_metaik.arrays import Array

# Okabe and Ito: told apart by every eye and in grey.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
PANEL, CATEGORY, MARGIN, HEIGHT = 3.6, 0.3, 0.6, 3.8  # inches


@dataclass(frozen=True)
class Runs:
    """Final costs of several runs of a method, and what the paper printed, if it did."""

    method: str
    costs: Sequence[float]
    paper: float | None = None


def size(*categories: int) -> tuple[float, float]:
    """Width and height in inches of a figure whose panels have so many categories (or 1) side by side."""
    return max(5.0, MARGIN + sum(max(PANEL, CATEGORY * count) for count in categories)), HEIGHT


def convergence(canvas: Any, panels: Mapping[str, Mapping[str, Sequence[Array]]], cost: str, floor: float) -> None:
    """Best cost so far against evaluations, both logarithmic: every run thin, their median thick.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        panels: Traces (g, 2) by method by panel; those of one method at the same evaluations.
        cost: The cost with its unit.
        floor: Where smaller costs, zeros too, are drawn.
    """
    colours = colours_of(method for panel in panels.values() for method in panel)
    axes = canvas.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for ax, (title, panel) in zip(axes, panels.items(), strict=True):
        for method, traces in panel.items():
            if not traces:
                continue
            costs = np.maximum([trace[:, 1] for trace in traces], floor)  # (runs, g)
            ax.plot(traces[0][:, 0], costs.T, color=colours[method], linewidth=0.5, alpha=0.4)
            ax.plot(traces[0][:, 0], np.median(costs, axis=0), color=colours[method], linewidth=2, label=method)
        ax.set(title=title, xscale="log", yscale="log", xlabel="evaluations")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel(cost)
    labelled = {label: line for ax in axes for line, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    canvas.legend(labelled.values(), labelled.keys(), loc="outside lower center", ncols=len(labelled), frameon=False)


def strip(canvas: Any, panels: Mapping[str, Mapping[str, Runs]], cost: str, floor: float) -> None:
    """Final cost of every run as a dot, their median as a bar, the paper's number as a diamond; logarithmic.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        panels: Runs by label by panel.
        cost: The cost with its unit.
        floor: Where smaller costs, zeros too, are drawn.
    """
    colours = colours_of([runs.method for panel in panels.values() for runs in panel.values()])
    axes = canvas.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for ax, (title, panel) in zip(axes, panels.items(), strict=True):
        for i, runs in enumerate(panel.values()):
            colour = colours[runs.method]
            if runs.costs:
                costs = np.maximum(runs.costs, floor)
                dots = i + np.linspace(-0.2, 0.2, len(costs) + 2)[1:-1]
                ax.plot(dots, costs, "o", color=colour, markersize=4, alpha=0.7)
                ax.plot([i - 0.3, i + 0.3], [np.median(costs)] * 2, color=colour, linewidth=2)
            if runs.paper is not None:
                ax.plot(i + 0.35, max(runs.paper, floor), "D", markerfacecolor="none", color="black", markersize=5)
        ax.set(title=title, yscale="log", xlim=(-0.6, len(panel) - 0.4))
        ax.set_xticks(range(len(panel)), list(panel), fontsize="small")
        ax.grid(axis="y", alpha=0.3)
    axes[0].set_ylabel(cost)
    marks = axes[0].plot([], [], "o", color="grey", markersize=4, label="a run") + axes[0].plot(
        [], [], color="grey", linewidth=2, label="median"
    )
    if any(runs.paper is not None for panel in panels.values() for runs in panel.values()):
        marks += axes[0].plot([], [], "D", markerfacecolor="none", color="black", markersize=5, label="the paper")
    canvas.legend(handles=marks, loc="outside lower center", ncols=len(marks), frameon=False)


def colours_of(methods: Iterable[str]) -> dict[str, str]:
    """A colour for each method."""
    return dict(zip(dict.fromkeys(methods), itertools.cycle(COLOURS), strict=False))
