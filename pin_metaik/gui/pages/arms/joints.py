"""Sliders of the joints: they show where the chain is, between its limits, and move it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.gui.forms import fine
from pin_metaik.gui.tab import Tab
from pin_metaik.kinematics import Chain

FAR = 2.0  # m, of a slide without limits


class JointSliders:
    """A slider for each coordinate of a chain.

    Args:
        tab: The tab.
        chain: The chain.
        x: (n,) where it is.
        moved: Called with the coordinates (n,) when a slider is moved.
    """

    def __init__(
        self, tab: Tab, chain: Chain, x: NDArray[np.float64], moved: Callable[[NDArray[np.float64]], None]
    ) -> None:
        self._handles: list[Any] = []
        limits = chain.limits
        for number, name in enumerate(chain.names):
            turn = math.pi if limits.rotates[number] else FAR
            low, high = float(limits.lower[number]), float(limits.upper[number])
            low = low if math.isfinite(low) else -turn
            high = high if math.isfinite(high) else turn
            step, decimals = fine(low, high)
            unit = "rad" if limits.rotates[number] else "m"
            handle = tab.client.gui.add_slider(
                f"{name}, {unit}",
                min=low,
                max=max(high, low + 1e-9),
                step=step,
                initial_value=float(np.clip(round(x[number], decimals), low, high)),
                disabled=high <= low,
                hint=f"Limits: {low:.4g} to {high:.4g} {unit}.",
            )
            handle.on_update(tab.doing(lambda: moved(np.array([each.value for each in self._handles]))))
            self._handles.append(handle)

    def show(self, x: NDArray[np.float64]) -> None:
        """Show where the chain is."""
        for handle, value in zip(self._handles, x, strict=True):
            handle.value = float(np.clip(value, handle.min, handle.max))
