"""A scale of colours from 0 to 1 that is the same whatever is shown, and its legend with numbers."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

STOPS = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])  # viridis at each quarter
TICKS = (0.0, 0.25, 0.5, 0.75, 1.0)


def colours(values: ArrayLike) -> NDArray[np.uint8]:
    """Red, green and blue (k, 3), 0 to 255, of values (k,); those beyond 0 and 1 have the colours of these."""
    at = np.asarray(values, dtype=float)
    return np.column_stack([np.interp(at, TICKS, column) for column in STOPS.T]).round().astype(np.uint8)


def legend(gui: Any, quantity: str, low: str, high: str) -> Any:
    """Put a legend into the panel.

    Args:
        gui: Of one tab.
        quantity: What the colours tell, with its unit.
        low: What 0 means.
        high: What 1 means.
    """
    stops = ", ".join(f"rgb({red},{green},{blue})" for red, green, blue in STOPS.tolist())
    numbers = "".join(f"<span>{tick:g}</span>" for tick in TICKS)
    row = "display:flex;justify-content:space-between"
    return gui.add_html(
        f'<div role="img" aria-label="{escape(quantity)}: 0, {escape(low)}, to 1, {escape(high)}" '
        'style="padding:0 0.75em 0.6em;font-size:0.8em">'
        f'<div>{escape(quantity)}</div><div style="height:0.9em;background:linear-gradient(to right,{stops})"></div>'
        f'<div style="{row}">{numbers}</div><div style="{row}"><span>{escape(low)}</span><span>{escape(high)}</span>'
        "</div></div>"
    )
