"""The compiled loops of the visibility graph: who sees whom.

Arrays they share:

* ``vertices`` (n, 2), ``before`` and ``after`` (n,): the border of the free space, each vertex with the indices of its
  neighbours along the ring; the free space is on the left of every edge ``vertices[k] -> vertices[after[k]]``.
* ``corners`` (c,): the vertices a shortest path can bend at, those where the free space is wider than a half-plane.
* ``slack``: how far from a line a point still counts as on it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, inline, jit

BORDER = "f8[:,::1], i8[::1], i8[::1]"  # vertices, before, after


@inline
def side(ax: float, ay: float, ux: float, uy: float, px: float, py: float, slack: float) -> int:
    """On which side of the line through a with unit direction u the point p is: 1 left, -1 right, 0 on it."""
    s = ux * (py - ay) - uy * (px - ax)
    return 1 if s > slack else (-1 if s < -slack else 0)


@inline
def taut(k: int, ux: float, uy: float, vertices: Floats, before: Ints, after: Ints, slack: float) -> bool:
    """Whether a line through corner k only touches the obstacle there: both neighbours on one side of it."""
    x, y = vertices[k, 0], vertices[k, 1]
    a, b = before[k], after[k]
    s = side(x, y, ux, uy, vertices[a, 0], vertices[a, 1], slack)
    return s * side(x, y, ux, uy, vertices[b, 0], vertices[b, 1], slack) >= 0


@inline
def blocker(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    first: int,
) -> int:
    """The vertex whose edge (or which itself) stands between a and b, or -1. `first` is looked at first.

    A vertex on the line blocks it, unless it lies amid an edge along the line. At a corner the two shorter segments,
    which end there, stand for the long one; anywhere else the free space is convex, and the line leaves it.
    """
    length = math.hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    n = len(vertices)
    for i in range(n):
        k = first + i
        if k >= n:
            k -= n
        px, py = vertices[k, 0] - ax, vertices[k, 1] - ay
        q = after[k]
        qx, qy = vertices[q, 0] - ax, vertices[q, 1] - ay
        sp, sq = ux * py - uy * px, ux * qy - uy * qx
        if -slack <= sp <= slack:  # the vertex is on the line
            t = ux * px + uy * py
            if slack < t < length - slack:
                o = before[k]
                so = ux * (vertices[o, 1] - ay) - uy * (vertices[o, 0] - ax)
                if bends[k] or abs(so) > slack or abs(sq) > slack:
                    return k
        elif (sp > 0) != (sq > 0) and not -slack <= sq <= slack:  # the edge crosses the line
            share = sp / (sp - sq)
            t = ux * (px + share * (qx - px)) + uy * (py + share * (qy - py))
            if slack < t < length - slack:
                return k
    return -1


@jit(f"void({BORDER}, i8[::1], b1[::1], f8, b1[:,::1])")
def see_each_other(
    vertices: Floats,
    before: Ints,
    after: Ints,
    corners: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    sees: NDArray[np.bool_],
) -> None:
    """Which corners see each other along a line that is taut at both (c, c): the edges a shortest path can have."""
    c = len(corners)
    last = 0
    for i in range(c):
        k = corners[i]
        ax, ay = vertices[k, 0], vertices[k, 1]
        for j in range(i + 1, c):
            m = corners[j]
            bx, by = vertices[m, 0], vertices[m, 1]
            length = math.hypot(bx - ax, by - ay)
            if length <= slack:
                continue
            ux, uy = (bx - ax) / length, (by - ay) / length
            if not taut(k, ux, uy, vertices, before, after, slack):
                continue
            if not taut(m, ux, uy, vertices, before, after, slack):
                continue
            wall = blocker(ax, ay, bx, by, vertices, before, after, bends, slack, last)
            if wall < 0:
                sees[i, j] = sees[j, i] = True
            else:
                last = wall


@jit(f"void(f8, f8, {BORDER}, i8[::1], b1[::1], f8, b1[::1])")
def seen_from(
    x: float,
    y: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    corners: Ints,
    bends: NDArray[np.bool_],
    slack: float,
    sees: NDArray[np.bool_],
) -> None:
    """Which corners a point sees along a line that is taut there (c,); not the one it stands on, if it does."""
    last = 0
    for j in range(len(corners)):
        m = corners[j]
        bx, by = vertices[m, 0], vertices[m, 1]
        length = math.hypot(bx - x, by - y)
        if length <= slack:
            continue
        if not taut(m, (bx - x) / length, (by - y) / length, vertices, before, after, slack):
            continue
        wall = blocker(x, y, bx, by, vertices, before, after, bends, slack, last)
        if wall < 0:
            sees[j] = True
        else:
            last = wall


@jit(f"b1(f8, f8, f8, f8, {BORDER}, b1[::1], f8)")
def sees(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    vertices: Floats,
    before: Ints,
    after: Ints,
    bends: NDArray[np.bool_],
    slack: float,
) -> bool:
    """Whether two points see each other; a corner that the line touches is in the way."""
    if math.hypot(bx - ax, by - ay) <= slack:
        return True
    return blocker(ax, ay, bx, by, vertices, before, after, bends, slack, 0) < 0
