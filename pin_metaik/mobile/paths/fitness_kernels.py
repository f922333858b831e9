"""The compiled loops of the fitnesses: costs of the paths of a population."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, inline, jit


@inline
def corner(via: Floats, v: int, ends: Floats) -> tuple[float, float]:
    """Via point v of a path (2 n,), or its goal, after the last of them."""
    if 2 * v < via.shape[0]:
        return via[2 * v], via[2 * v + 1]
    return ends[2], ends[3]


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
            x2, y2 = corner(X[i], v, ends)
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
            x2, y2 = corner(X[i], v, ends)
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
                        along = ux * (ax + share * (bx - ax)) + uy * (ay + share * (by - ay))
                        at = count
                        while at > 0 and crossings[at - 1] > along:
                            crossings[at] = crossings[at - 1]
                            at -= 1
                        crossings[at] = along
                        count += 1
                for c in range(0, count - 1, 2):
                    inside = min(crossings[c + 1], L) - max(crossings[c], 0.0)
                    if inside > 0.0:
                        f += c_p * (1 + inside)
                        n += 1
            x1, y1 = x2, y2
        costs[i], hits[i] = f, n
