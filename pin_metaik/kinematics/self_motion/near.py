"""What is near a curve: boxes of configurations, near one of its points, and configurations that are on it."""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.closed_form import cross, dot, vector
from pin_metaik.kinematics.kernel.forward import FULL_TURN, IDENTITY, forward


@inline
def bend_all(joints: Floats, wiring: Ints, tip: Floats, X: Floats, out: Floats, room: Floats, pose: Floats) -> None:
    """``bends`` in room that was made for it."""
    S = joints.shape[0]
    axes, origins = room[:S], room[S:]
    for k in range(X.shape[0]):
        forward(joints, wiring, 0, S, tip, IDENTITY, X[k], axes, origins, pose)
        out[k] = dot(vector(axes[S - 3]), cross(vector(axes[S - 2]), vector(axes[S - 1])))


@jit("void(f8[:,::1], i8[:,::1], f8[::1], f8[:,::1], f8[::1])")
def bends(joints: Floats, wiring: Ints, tip: Floats, X: Floats, out: Floats) -> None:
    """Triple product (k,) of the last three axes at coordinates X (k, n): its sign says how a wrist is bent."""
    bend_all(joints, wiring, tip, X, out, np.empty((2 * joints.shape[0], 3)), np.empty(12))


@inline
def is_within(box: Floats, x: Floats, counts: Ints, multi_turn: Ints, resolution: float) -> bool:
    """Whether all of a box (2 m,) is within the resolution of x (n,) in each coordinate that counts."""
    m = box.shape[0] // 2
    for c in counts:
        way = x[c] - box[c]
        if multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        if abs(way) + box[m + c] > resolution:
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


@jit("void(f8[:,::1], f8[:,::1], i8[::1], i8[::1], f8, i8[::1])")
def mark_near(boxes: Floats, X: Floats, counts: Ints, multi_turn: Ints, resolution: float, near: Ints) -> None:
    """Mark with 1 those of the boxes (k, 2 m) that are within the resolution of a point X (p, n)."""
    for k in range(boxes.shape[0]):
        if near[k] == 0:
            for i in range(X.shape[0]):
                if is_within(boxes[k], X[i], counts, multi_turn, resolution):
                    near[k] = 1
                    break
