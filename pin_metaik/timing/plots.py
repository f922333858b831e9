"""A picture of a timed path: the motion of the joints, and their limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.figures import new_figure
from pin_metaik.timing.timed import TimedPath

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLES = 500
SIZE = (9.0, 8.0)  # inches


@checked
def draw_timed(timed: TimedPath) -> Figure:
    """A figure of coordinates, of speeds and accelerations as shares of their limits, and of the frames' speeds.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    figure = new_figure(SIZE)
    samples = timed.sample(timed.duration / SAMPLES)
    limits, chain = timed.limits, timed.chain
    joints, speeds, accelerations, tips = figure.subplots(4, 1, sharex=True)
    for j, name in enumerate(chain.names):
        (line,) = joints.plot(samples.t, samples.x[:, j], label=name)
        for end in (chain.limits.lower[j], chain.limits.upper[j]):
            if np.isfinite(end) and np.abs(samples.x[:, j] - end).min() < 0.2:
                joints.axhline(end, color=line.get_color(), linestyle=":", linewidth=0.8)
        speeds.plot(samples.t, samples.v[:, j] / limits.velocity[j], color=line.get_color())
        accelerations.plot(samples.t, samples.a[:, j] / limits.acceleration[j], color=line.get_color(), linewidth=0.9)
    for ax in (speeds, accelerations):
        for end in (-1.0, 1.0):
            ax.axhline(end, color="black", linestyle=":", linewidth=0.8)
    for t, frame in enumerate(chain.frames):
        tips.plot(samples.t, samples.tip_speed[:, t], label=frame)
    joints.set(ylabel="joints, rad or m", title=f"{timed.duration:.3f} s")
    speeds.set(ylabel="speed / limit")
    accelerations.set(ylabel="acceleration / limit")
    tips.set(ylabel="frames, m/s", xlabel="time, s", ylim=(0.0, None))
    joints.legend(fontsize="x-small", ncols=4)
    tips.legend(fontsize="x-small")
    return figure
