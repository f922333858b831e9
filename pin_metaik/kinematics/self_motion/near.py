"""What is near a curve: boxes near one of its points, boxes that it goes through, and single configurations."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.kinematics.kernel.forward import FULL_TURN

BULGE = 5e-3  # rad or m by which a curve leaves the line between two of its points, at most
TOGETHER = 16  # points of a curve that are looked at one by one only near a box around them


@inline
def is_within(box: Floats, x: Floats, half: Floats | None, multi_turn: Ints, side: float, distance: float) -> bool:
    """Whether the far side of a box (2 m,), or its near one (``side`` -1), is so near to x (n,) in each coordinate.

    With half widths (n,) of another box around x: whether it may be so near to a point of that.
    """
    m = box.shape[0] // 2
    for c in range(x.shape[0]):
        way = x[c] - box[c]
        if multi_turn[c] == 1:
            way -= FULL_TURN * np.round(way / FULL_TURN)
        if abs(way) + side * box[m + c] - (0.0 if half is None else half[c]) > distance:
            return False
    return True


@inline
def is_near_line(x: Floats, a: Floats, b: Floats, multi_turn: Ints, same: float, copied: Floats) -> tuple[bool, float]:
    """Whether x (n,) is so near to the line from a to b (n,) in every coordinate, and where on it, from 0 to 1.

    ``copied`` (n,) gets the copy of x by whole turns that is nearest to a.
    """
    along = length = 0.0
    for c in range(x.shape[0]):
        turns = np.round((x[c] - a[c]) / FULL_TURN) if multi_turn[c] == 1 else 0.0
        copied[c] = x[c] - FULL_TURN * turns
        along += (copied[c] - a[c]) * (b[c] - a[c])
        length += (b[c] - a[c]) ** 2
    share = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    for c in range(x.shape[0]):
        if abs(copied[c] - a[c] - share * (b[c] - a[c])) > same:
            return False, share
    return True, share


@inline
def point_between(a: Floats, b: Floats, tangents: Floats, share: float, point: Floats, way: Floats) -> float:
    """Hermite's cubic between points of a curve (n,) with the tangents (2, n) there: ``point`` and its derivative.

    ``share`` is from 0 at a to 1 at b. Returns the squared length of the derivative.
    """
    h = size = 0.0
    for c in range(a.shape[0]):
        h += (b[c] - a[c]) ** 2
    h = math.sqrt(h)
    for c in range(a.shape[0]):
        u, v, d = h * tangents[0, c], h * tangents[1, c], b[c] - a[c]
        second, third = 3.0 * d - 2.0 * u - v, u + v - 2.0 * d
        point[c] = a[c] + share * (u + share * (second + share * third))
        way[c] = u + share * (2.0 * second + 3.0 * share * third)
        size += way[c] ** 2
    return size


@jit("b1(f8[::1], f8[:,::1], i8[::1], f8)")
def is_near_curve(x: Floats, X: Floats, multi_turn: Ints, same: float) -> bool:
    """Whether x (n,) is so near to the line through points X (p, n)."""
    copied = np.empty(x.shape[0])
    for i in range(X.shape[0] - 1):  # noqa: SIM110  any(...) takes a generator, which numba does not
        if is_near_line(x, X[i], X[i + 1], multi_turn, same, copied)[0]:
            return True
    return False


@inline
def surround(X: Floats, first: int, last: int, middle: Floats, half: Floats) -> None:
    """The centre (n,) and the half widths (n,) of the box around some points of X (p, n)."""
    for c in range(X.shape[1]):
        low = high = X[first, c]
        for i in range(first + 1, last):
            low, high = min(low, X[i, c]), max(high, X[i, c])
        middle[c], half[c] = 0.5 * (low + high), 0.5 * (high - low)


@jit("void(f8[:,::1], f8[:,::1], i8[::1], f8, f8, i8[::1])")
def mark_near(boxes: Floats, X: Floats, multi_turn: Ints, side: float, distance: float, near: Ints) -> None:
    """Mark with 1 the boxes (k, 2 m) whose far or near side is so near to a point X (p, n); see ``is_within``."""
    p, n = X.shape
    middle, half = np.empty(n), np.empty(n)
    for first in range(0, p, TOGETHER):
        last = min(first + TOGETHER, p)
        surround(X, first, last, middle, half)
        for k in range(boxes.shape[0]):
            if near[k] == 1 or not is_within(boxes[k], middle, half, multi_turn, side, distance):
                continue
            for i in range(first, last):
                if is_within(boxes[k], X[i], None, multi_turn, side, distance):
                    near[k] = 1
                    break


@jit("void(f8[:,::1], f8[:,::1], f8[:,::1], i8[::1], f8, i8[::1])")
def mark_crossed(boxes: Floats, X: Floats, tangents: Floats, multi_turn: Ints, same: float, crossed: Ints) -> None:
    """Mark with 1 the boxes (k, 2 m) to which the curve through X (p, n) with its tangents comes as near as ``same``.

    Between two points it is looked for where it is nearest to the centre of a box.
    """
    p, n = X.shape
    middle, half, copied, point, way = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for first in range(0, p - 1, TOGETHER):
        last = min(first + TOGETHER, p - 1)
        surround(X, first, last + 1, middle, half)
        for k in range(boxes.shape[0]):
            box = boxes[k]
            if crossed[k] == 1 or not is_within(box, middle, half, multi_turn, -1.0, BULGE):
                continue
            widest = 0.0
            for c in range(n):
                widest = max(widest, box[box.shape[0] // 2 + c])
            for i in range(first, last):
                near, share = is_near_line(box[:n], X[i], X[i + 1], multi_turn, widest + BULGE, copied)
                if not near:
                    continue
                point_between(X[i], X[i + 1], tangents[i : i + 2], share, point, way)
                if is_within(box, point, None, multi_turn, -1.0, same):
                    crossed[k] = 1
                    break
