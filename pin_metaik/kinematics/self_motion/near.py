"""What is near a curve: boxes of configurations, near one of its points, and configurations that are on it."""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.forward import FULL_TURN


@inline
def is_within(box: Floats, x: Floats, multi_turn: Ints, side: float, distance: float) -> bool:
    """Whether the far side of a box (2 m,), or its near one (``side`` -1), is so near to x (n,) in each coordinate."""
    m = box.shape[0] // 2
    for c in range(x.shape[0]):
        way = x[c] - box[c]
        if multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        if abs(way) + side * box[m + c] > distance:
            return False
    return True


@inline
def is_on(x: Floats, a: Floats, b: Floats, multi_turn: Ints, same: float) -> bool:
    """Whether x (n,) is so near to the line from a to b (n,) in every coordinate."""
    along = length = 0.0
    for c in range(x.shape[0]):
        way, step = x[c] - a[c], b[c] - a[c]
        if multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        along += way * step
        length += step * step
    share = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    for c in range(x.shape[0]):
        way = x[c] - a[c] - share * (b[c] - a[c])
        if multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        if abs(way) > same:
            return False
    return True


@jit("b1(f8[::1], f8[:,::1], i8[::1], f8)")
def is_on_curve(x: Floats, X: Floats, multi_turn: Ints, same: float) -> bool:
    """Whether x (n,) is so near to the line through points X (p, n)."""
    for i in range(X.shape[0] - 1):  # noqa: SIM110  any(...) takes a generator, which numba does not
        if is_on(x, X[i], X[i + 1], multi_turn, same):
            return True
    return False


@jit("void(f8[:,::1], f8[:,::1], i8[::1], f8, f8, i8[::1])")
def mark_near(boxes: Floats, X: Floats, multi_turn: Ints, side: float, distance: float, near: Ints) -> None:
    """Mark with 1 the boxes (k, 2 m) whose far or near side is so near to a point X (p, n); see ``is_within``."""
    for k in range(boxes.shape[0]):
        if near[k] == 0:
            for i in range(X.shape[0]):
                if is_within(boxes[k], X[i], multi_turn, side, distance):
                    near[k] = 1
                    break
