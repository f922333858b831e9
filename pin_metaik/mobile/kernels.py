"""The compiled loops: who sees whom, what a path of a population costs, the best speeds along a route.

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


@inline
def hits_area(
    x1: float, y1: float, x2: float, y2: float, vertices: Floats, first: int, last: int, area: Floats
) -> bool:
    """The paper's test: the boxes of segment and obstacle overlap, and its line has vertices on both sides (Eq. 4)."""
    if not (area[0] < max(x1, x2) and min(x1, x2) < area[2] and area[1] < max(y1, y2) and min(y1, y2) < area[3]):
        return False
    px, py = x2 - x1, y2 - y1
    least, most = 0.0, 0.0
    for k in range(first, last):
        s = px * (vertices[k, 1] - y1) - py * (vertices[k, 0] - x1)  # p x a
        least, most = min(least, s), max(most, s)
    return least < 0.0 < most


@jit("void(f8[:,::1], f8[:,::1], i8[::1], f8[:,::1], b1[:,::1])")
def segment_hits(segments: Floats, vertices: Floats, offsets: Ints, areas: Floats, hits: NDArray[np.bool_]) -> None:
    """Which obstacle areas each of the segments (k, 4) hits by the paper's test (k, obstacles), filled in."""
    for i in range(len(segments)):
        x1, y1, x2, y2 = segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3]
        for j in range(len(areas)):
            hits[i, j] = hits_area(x1, y1, x2, y2, vertices, offsets[j], offsets[j + 1], areas[j])


@jit("void(f8[:,::1], f8[::1], f8[:,::1], i8[::1], f8[:,::1], f8, f8, f8, b1, f8[::1], i8[::1])")
def paper_costs(
    X: Floats,
    ends: Floats,
    vertices: Floats,
    offsets: Ints,
    areas: Floats,
    c_p: float,
    p_p: float,
    longest: float,
    of_total: bool,
    costs: Floats,
    hits: Ints,
) -> None:
    """Eq. 5 of Toz, Erdogmus and Sahin 2011 for a population.

    Args:
        X: Via points (k, 2 n): x and y of one after the other.
        ends: Start and goal (4,).
        vertices: Corners (m, 2) of the convex obstacle areas, one obstacle after the other.
        offsets: Obstacle j has the vertices ``offsets[j]:offsets[j + 1]``.
        areas: Penalty areas (obstacles, 7): x_min, y_min, x_max, y_max, centre x and y, half diagonal h.
        c_p: Collision constant.
        p_p: Factor of a length above the longest.
        longest: Length L above which p_p acts, 3 d_u.
        of_total: Whether L is the whole path's length; in the paper it is a segment's.
        costs: f (k,), filled in.
        hits: Pairs of a segment and an obstacle it hits (k,), filled in.
    """
    for i in range(len(X)):
        f, total, n = 0.0, 0.0, 0
        x1, y1 = ends[0], ends[1]
        for v in range(X.shape[1] // 2 + 1):
            x2, y2 = ends[2], ends[3]
            if 2 * v < X.shape[1]:
                x2, y2 = X[i, 2 * v], X[i, 2 * v + 1]
            px, py = x2 - x1, y2 - y1
            L = math.hypot(px, py)
            total += L
            f += L if of_total or longest > L else p_p * L
            for j in range(len(areas)):
                if hits_area(x1, y1, x2, y2, vertices, offsets[j], offsets[j + 1], areas[j]):
                    ax, ay, h = areas[j, 4] - x1, areas[j, 5] - y1, areas[j, 6]
                    d = abs(px * ay - py * ax) / L  # |a x p| / |p|
                    f += c_p * (1 + h - d) ** 2
                    n += 1
            x1, y1 = x2, y2
        if of_total and not total < longest:
            f += (p_p - 1) * total
        costs[i], hits[i] = f, n


@jit("void(f8[:,::1], f8[::1], f8[:,::1], i8[::1], f8, f8[::1], i8[::1])")
def overlap_costs(
    X: Floats, ends: Floats, vertices: Floats, after: Ints, c_p: float, costs: Floats, hits: Ints
) -> None:
    """Length plus ``c_p (1 + length inside)`` for every stretch of a segment inside the obstacles.

    The line of a segment enters and leaves the obstacles at every second crossing with their border.

    Args:
        X: Via points (k, 2 n).
        ends: Start and goal (4,).
        vertices: Border of obstacles and walls (m, 2).
        after: The next vertex along the ring (m,).
        c_p: Collision constant.
        costs: Filled in (k,).
        hits: Stretches inside (k,), filled in.
    """
    crossings, side_of = np.empty(len(vertices)), np.empty(len(vertices))
    for i in range(len(X)):
        f, n = 0.0, 0
        x1, y1 = ends[0], ends[1]
        for v in range(X.shape[1] // 2 + 1):
            x2, y2 = ends[2], ends[3]
            if 2 * v < X.shape[1]:
                x2, y2 = X[i, 2 * v], X[i, 2 * v + 1]
            px, py = x2 - x1, y2 - y1
            L = math.hypot(px, py)
            f += L
            if L > 0.0:
                ux, uy = px / L, py / L
                for k in range(len(vertices)):  # once for each vertex: its two edges must agree on the side
                    side_of[k] = ux * (vertices[k, 1] - y1) - uy * (vertices[k, 0] - x1)
                count = 0
                for k in range(len(vertices)):
                    q = after[k]
                    if (side_of[k] > 0.0) != (side_of[q] > 0.0):
                        share = side_of[k] / (side_of[k] - side_of[q])
                        ax, ay = vertices[k, 0] - x1, vertices[k, 1] - y1
                        bx, by = vertices[q, 0] - x1, vertices[q, 1] - y1
                        crossings[count] = ux * (ax + share * (bx - ax)) + uy * (ay + share * (by - ay))
                        count += 1
                crossings[:count].sort()
                for c in range(0, count - 1, 2):
                    inside = min(crossings[c + 1], L) - max(crossings[c], 0.0)
                    if inside > 0.0:
                        f += c_p * (1 + inside)
                        n += 1
            x1, y1 = x2, y2
        costs[i], hits[i] = f, n


@inline
def straight(length: float, v0: float, v1: float, a: float, v_max: float) -> float:
    """Least time for a straight from speed v0 to v1; inf if it is too short for that."""
    if length < abs(v1 * v1 - v0 * v0) / (2 * a) - 1e-12:
        return np.inf
    v_p = min(v_max, math.sqrt((v0 * v0 + v1 * v1) / 2 + a * max(length, 0.0)))
    if v_p == 0.0:
        return 0.0
    return (2 * v_p - v0 - v1) / a + max(length - (2 * v_p * v_p - v0 * v0 - v1 * v1) / (2 * a), 0.0) / v_p


@jit("f8(f8[::1], f8[::1], f8[:,::1], f8, f8, f8[::1])")
def best_speeds(lengths: Floats, g: Floats, grid: Floats, a: float, v_max: float, speeds: Floats) -> float:
    """Least time of the straights of a route over speeds from a grid, by dynamic programming.

    Args:
        lengths: Of the polyline's segments (n + 1,), in m.
        g: Tangent length per speed at each corner (n,), in s.
        grid: Speeds (n, m) to choose from at each corner, in m/s.
        a: Largest acceleration, m/s^2.
        v_max: Largest speed, m/s.
        speeds: The chosen ones (n,), filled in.

    Returns:
        Time in s; inf if no choice is feasible.
    """
    n, m = grid.shape
    time = np.empty((n, m))
    came = np.zeros((n, m), dtype=np.int64)
    for j in range(m):
        v = grid[0, j]
        time[0, j] = straight(lengths[0] - g[0] * v, 0.0, v, a, v_max)
    for i in range(1, n):
        for j in range(m):
            v = grid[i, j]
            left = lengths[i] - g[i] * v
            best, where = np.inf, 0
            for k in range(m):
                if time[i - 1, k] >= best:
                    continue
                u = grid[i - 1, k]
                t = time[i - 1, k] + straight(left - g[i - 1] * u, u, v, a, v_max)
                if t < best:
                    best, where = t, k
            time[i, j], came[i, j] = best, where
    best, where = np.inf, 0
    for j in range(m):
        v = grid[n - 1, j]
        t = time[n - 1, j] + straight(lengths[n] - g[n - 1] * v, v, 0.0, a, v_max)
        if t < best:
            best, where = t, j
    for i in range(n - 1, -1, -1):
        speeds[i] = grid[i, where]
        where = came[i, where]
    return best
