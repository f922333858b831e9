"""The compiled loop of moving obstacles: at which times a robot must not set out along a straight line.

Along a leg on which an obstacle moves evenly, robot and obstacle meet where all its half-planes hold. In the plane of
the time t and the way s of the robot each of them is a half-plane again. So the meetings fill a convex polygon, and the
departures t - s / v that lead into it are an interval.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit


@inline
def cut(polygon: Floats, count: int, p: float, q: float, r: float, spare: Floats) -> int:
    """What of a convex polygon (count, 2) fulfils p t + q s <= r, into ``spare``; how many corners it has."""
    left = 0
    for i in range(count):
        j = (i + 1) % count
        a = p * polygon[i, 0] + q * polygon[i, 1] - r
        b = p * polygon[j, 0] + q * polygon[j, 1] - r
        if a <= 0.0:
            spare[left, 0], spare[left, 1] = polygon[i, 0], polygon[i, 1]
            left += 1
        if (a < 0.0 < b) or (b < 0.0 < a):
            share = a / (a - b)
            spare[left, 0] = polygon[i, 0] + share * (polygon[j, 0] - polygon[i, 0])
            spare[left, 1] = polygon[i, 1] + share * (polygon[j, 1] - polygon[i, 1])
            left += 1
    return left


@jit("i8(f8[::1], f8, f8[:,::1], i8[::1], f8[:,::1], f8[:,::1], f8[:,::1], f8[:,::1])")
def refused_departures(
    line: Floats,
    speed: float,
    planes: Floats,
    first: Ints,
    legs: Floats,
    polygon: Floats,
    spare: Floats,
    refused: Floats,
) -> int:
    """Intervals of departure times from which a robot meets an obstacle on a line.

    Args:
        line: (4,) from x, y to x, y; twice the same place for a robot that waits, which departs at every time.
        speed: Of the robot.
        planes: (m, 3) half-planes ``n x <= h`` of all obstacles around their own origins, unit normals n, and h.
        first: (obstacles + 1,) where the half-planes of each begin.
        legs: (k, 7): number of the obstacle, times of beginning and end (inf: never), x and y at the beginning, and
            velocity; on the leg without an end it stands still.
        polygon: Room for corners (m + 8, 2).
        spare: The same again.
        refused: (k, 2) filled in: intervals, open at their ends, in the order of the legs.

    Returns:
        How many.
    """
    dx, dy = line[2] - line[0], line[3] - line[1]
    length = math.hypot(dx, dy)
    ux, uy = (dx / length, dy / length) if length > 0.0 else (0.0, 0.0)
    slowness = 1.0 / speed
    count = 0
    for k in range(len(legs)):
        obstacle = int(legs[k, 0])
        begin, end, x, y, wx, wy = legs[k, 1], legs[k, 2], legs[k, 3], legs[k, 4], legs[k, 5], legs[k, 6]
        low, high = -np.inf, np.inf
        if wx == 0.0 and wy == 0.0:  # it stands: only the way matters
            least, most = 0.0, length
            for i in range(first[obstacle], first[obstacle + 1]):
                nx, ny = planes[i, 0], planes[i, 1]
                q = nx * ux + ny * uy
                r = planes[i, 2] - nx * (line[0] - x) - ny * (line[1] - y)
                if q > 0.0:
                    most = min(most, r / q)
                elif q < 0.0:
                    least = max(least, r / q)
                elif r <= 0.0:
                    least, most = 1.0, 0.0
                    break
            if least > most or (least == most and length > 0.0):
                continue
            low, high = begin - most * slowness, end - least * slowness
        else:
            polygon[0, 0], polygon[0, 1] = 0.0, 0.0
            polygon[1, 0], polygon[1, 1] = end - begin, 0.0
            polygon[2, 0], polygon[2, 1] = end - begin, length
            polygon[3, 0], polygon[3, 1] = 0.0, length
            corners = 4
            for i in range(first[obstacle], first[obstacle + 1]):
                nx, ny = planes[i, 0], planes[i, 1]
                r = planes[i, 2] - nx * (line[0] - x) - ny * (line[1] - y)
                corners = cut(polygon, corners, -nx * wx - ny * wy, nx * ux + ny * uy, r, spare)
                for j in range(corners):
                    polygon[j, 0], polygon[j, 1] = spare[j, 0], spare[j, 1]
                if corners == 0:
                    break
            if corners == 0:
                continue
            low, high = np.inf, -np.inf
            for j in range(corners):
                departure = polygon[j, 0] - polygon[j, 1] * slowness
                low, high = min(low, departure), max(high, departure)
            low, high = begin + low, begin + high
        if low < high:
            refused[count, 0], refused[count, 1] = low, high
            count += 1
    return count
