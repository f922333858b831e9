"""The compiled loop of dynamic programming: the best speeds along a route."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, inline, jit


@inline
def straight(length: float, v0: float, v1: float, a: float, v_max: float) -> float:
    """Least time for a straight from speed v0 to v1; inf if it is too short for that."""
    if length < abs(v1 * v1 - v0 * v0) / (2 * a) - 1e-12:
        return np.inf
    v_p = min(v_max, math.sqrt((v0 * v0 + v1 * v1) / 2 + a * max(length, 0.0)))
    if v_p == 0.0:
        return 0.0
    return (2 * v_p - v0 - v1) / a + max(length - (2 * v_p * v_p - v0 * v0 - v1 * v1) / (2 * a), 0.0) / v_p


@jit("f8(f8[::1], f8[::1], f8[:,::1], f8[:,::1], f8[:,::1], f8, f8, f8[::1])")
def best_speeds(
    lengths: Floats,
    ends: Floats,
    grid: Floats,
    tangents: Floats,
    turning: Floats,
    a: float,
    v_max: float,
    speeds: Floats,
) -> float:
    """Least time along a route over speeds from a grid, by dynamic programming.

    Args:
        lengths: Of the polyline's segments (n + 1,), in m.
        ends: Speeds (2,) at the start and at the goal, in m/s.
        grid: Speeds (n, m) to choose from at each corner, in m/s.
        tangents: Their tangent lengths (n, m), in m.
        turning: Times (n, m) of their turns, in s.
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
        time[0, j] = straight(lengths[0] - tangents[0, j], ends[0], v, a, v_max) + turning[0, j]
    for i in range(1, n):
        for j in range(m):
            v = grid[i, j]
            left = lengths[i] - tangents[i, j]
            best, where = np.inf, 0
            for k in range(m):
                if time[i - 1, k] >= best:
                    continue
                u = grid[i - 1, k]
                t = time[i - 1, k] + straight(left - tangents[i - 1, k], u, v, a, v_max)
                if t < best:
                    best, where = t, k
            time[i, j], came[i, j] = best + turning[i, j], where
    best, where = np.inf, 0
    for j in range(m):
        v = grid[n - 1, j]
        t = time[n - 1, j] + straight(lengths[n] - tangents[n - 1, j], v, ends[1], a, v_max)
        if t < best:
            best, where = t, j
    for i in range(n - 1, -1, -1):
        speeds[i] = grid[i, where]
        where = came[i, where]
    return best
