"""Figures of path planners: the paths of all runs, and the time of each; drawn into a figure that is handed in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pin_metaik.arrays import Array
from pin_metaik.compare.report.plots import colours_of

if TYPE_CHECKING:  # shapely is an extra
    from pin_metaik.mobile import PathProblem


ACROSS = 4  # panels of one scene side by side


@dataclass(frozen=True, eq=False)
class Overlaid:
    """The paths of a planner's runs on a scene.

    Attributes:
        points: Of each run (n, 2).
        free: Whether it is free, of each.
    """

    points: Sequence[Array]
    free: Sequence[bool]


def overlay(canvas: Any, problems: Mapping[str, PathProblem], rows: Mapping[str, Mapping[str, Overlaid]]) -> None:
    """All runs over one another, a row for each planner and a column for each scene; one scene's planners in rows.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        problems: By scene; their shortest paths are dashed.
        rows: What the runs found, by planner and by scene.
    """
    from pin_metaik.mobile import Path
    from pin_metaik.mobile.plots import draw_runs

    colours = colours_of(rows)
    down, across = shape_of(len(rows), len(problems))
    axes = canvas.subplots(down, across, squeeze=False).ravel()
    panels = [(method, scene) for method in rows for scene in problems]
    for ax in axes[len(panels) :]:
        ax.set_axis_off()
    for ax, (method, scene) in zip(axes, panels, strict=False):
        ran, problem = rows[method][scene], problems[scene]
        free, colliding = (
            [Path(points) for points, well in zip(ran.points, ran.free, strict=True) if well is wanted]
            for wanted in (True, False)
        )
        draw_runs(ax, problem.scene, free, problem.optimum, colours[method], colliding)
        ax.set_title(f"{scene}, {method}: {len(free)} of {len(ran.points)} free", fontsize="medium")


def shape_of(methods: int, scenes: int) -> tuple[int, int]:
    """Rows and columns of the panels of an overlay."""
    across = scenes if scenes > 1 else min(methods, ACROSS)
    return -(-methods * scenes // across), across


def times(canvas: Any, panels: Mapping[str, Mapping[str, Sequence[float]]], log: bool = False) -> None:
    """Processor time of every run.

    Args:
        canvas: An empty ``matplotlib.figure.Figure``.
        panels: Times in s of the runs, by planner by scene.
        log: Whether the times are of different orders of magnitude.
    """
    colours = colours_of(method for panel in panels.values() for method in panel)
    for ax, (scene, panel) in zip(canvas.subplots(1, len(panels), squeeze=False)[0], panels.items(), strict=True):
        for method, seconds in panel.items():
            ax.plot(
                range(1, len(seconds) + 1),
                [1e3 * each for each in seconds],
                ".-",
                color=colours[method],
                linewidth=0.8,
                label=method,
            )
        ax.set(title=scene, xlabel="run", ylabel="processor time, ms")
        ax.set(**({"yscale": "log"} if log else {"ylim": (0, None)}))
        ax.grid(alpha=0.3)
        ax.xaxis.get_major_locator().set_params(integer=True)
    lines, labels = ax.get_legend_handles_labels()
    canvas.legend(lines, labels, loc="outside lower center", ncols=min(len(labels), 5), frameon=False)
