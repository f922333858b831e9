"""Curves: what legs do along a trajectory, and the history of a design."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pin_metaik.arguments import checked
from pin_metaik.figures import new_figure
from pin_metaik.stewart.kinematics.trajectory import Motion
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.show.colours import PLATE, ROD, STEEL
from pin_metaik.stewart.synthesis.design import Designed

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@checked
def draw_motion(motion: Motion, mechanism: Mechanism) -> Figure:
    """A figure of the legs along a trajectory: coordinates and rates over time with their limits, and dexterity.

    Args:
        motion: The result of ``follow``.
        mechanism: The mechanism, for its limits and its unit.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    figure = new_figure((7.2, 7.2))
    panels = figure.subplots(3, sharex=True)
    times, limits, (word, unit, one) = motion.trajectory.times, mechanism.limits, mechanism.coordinate
    legs = mechanism.geometry.actuation.words.legs
    curves = ((motion.coordinates / one, word, unit), (motion.rates / one, "rate", f"{unit}/s"))
    for axes, (values, what, unit) in zip(panels, curves, strict=False):
        for i, column in enumerate(values.T, start=1):
            axes.plot(times, column, lw=1.4, label=f"leg {i}")
        axes.set_ylabel(f"{what} of {legs} ({unit})")
    speeds = () if limits.speed is None else (-limits.speed, limits.speed)
    for axes, ends in zip(panels, (limits.span, speeds), strict=False):
        for end in ends:
            axes.axhline(end / one, color=STEEL, ls="--", lw=1)
    panels[2].plot(times, motion.nu, color=PLATE)
    panels[2].set_ylabel("dexterity nu")
    panels[2].set_xlabel("time (s)")
    panels[2].set_ylim(0.0, 1.0)
    bad = ~motion.reached
    for axes in panels:
        axes.grid(alpha=0.3)
        axes.fill_between(times, 0, 1, where=bad, transform=axes.get_xaxis_transform(), color="#d0302020", step="mid")
    figure.legend(*panels[0].get_legend_handles_labels(), fontsize=8, ncols=6, loc="outside lower center")
    shaded = "; shaded: beyond a limit" if bad.any() else ""
    panels[0].set_title(f"{mechanism.name}: {legs} along the way (dashed: limits{shaded})", fontsize=11)
    return figure


@checked
def draw_history(designed: Designed) -> Figure:
    """A figure of the best fitness over the designs evaluated.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    figure = new_figure((6.0, 3.6))
    axes = figure.add_subplot()
    history = designed.history
    feasible = history[:, 1] >= 0.0
    axes.plot(*history[feasible].T, color=ROD)
    axes.set_xlabel("designs looked at")
    axes.set_ylabel("best fitness")
    axes.set_title(designed.mechanism.name, fontsize=11)
    axes.grid(alpha=0.3)
    return figure
