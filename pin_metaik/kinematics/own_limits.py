"""Limits of the caller in place of the model's: taken unchanged, with a warning where they look like a mistake."""

from __future__ import annotations

from collections.abc import Mapping

from pin_metaik.kinematics.limits import Limits
from pin_metaik.robots.plausible import range_in_degrees
from pin_metaik.said import warn

ROOM = 1e-6  # rad or m; figures that were rounded outwards


def with_own(model: Limits, own: Mapping[str, tuple[float, float]]) -> Limits:
    """Limits of the model with some joints' ranges replaced; warns of those in degrees or beyond the model's.

    Raises:
        InvalidBounds: If a name is not a joint of this chain, or a range is crossed or NaN.
    """
    limits = model.replace(dict(own))
    for i in map(limits.names.index, own):
        name, low, high = limits.names[i], limits.lower[i], limits.upper[i]
        remark = range_in_degrees(name, low, high) if limits.rotates[i] else ""
        if not remark and (low < model.lower[i] - ROOM or high > model.upper[i] + ROOM):
            remark = (
                f"joint {name!r} has own limits [{low:g}, {high:g}] beyond [{model.lower[i]:g}, {model.upper[i]:g}]"
            )
        if remark:
            warn(f"{remark}; they are used unchanged")
    return limits
