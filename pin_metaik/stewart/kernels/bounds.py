"""The compiled loops that bound a workspace: the exact box of what the legs' lengths allow, and a cover of the rest.

In one orientation the lengths of the legs leave P the intersection of spherical shells ``a <= |P - c_i| <= b`` with
``c_i = b_i - R m_i``, cut by the planes of the ranges that are given. Where a coordinate of P is least or greatest over
such a set, P is the pole of a sphere, an extreme point of a circle in which two surfaces meet, or a point where three
meet. These are few: all are tried, and the box round those within every shell is exact.

The angles of joints, the distances between legs and where the rods of servos reach have no such form. What they leave
is covered: a cell is out when a limit is missed at its centre by more than it can change on the way to a corner.

Arrays are those of ``judging``; ``spheres`` (n, 3) are the c_i of one orientation.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit, shared
from pin_metaik.stewart.kernels.closing import arc_misses
from pin_metaik.stewart.kernels.judging import segment_distance

TOUCH = 1e-9
"""How far outside a shell a point still counts as on it, as a share of the longest leg: rounding leaves 1e-13."""
PARALLEL = 1e-20
"""Squared sine below which two planes have no line in common."""


@inline
def within(x: float, y: float, z: float, spheres: Floats, limits: Floats, ends: Floats) -> bool:
    """Whether a point lies in every shell and between the ends (2, 3), but for rounding."""
    near = TOUCH * limits[1]
    if x < ends[0, 0] - near or y < ends[0, 1] - near or z < ends[0, 2] - near:
        return False
    if x > ends[1, 0] + near or y > ends[1, 1] + near or z > ends[1, 2] + near:
        return False
    for i in range(spheres.shape[0]):
        dx, dy, dz = x - spheres[i, 0], y - spheres[i, 1], z - spheres[i, 2]
        d = math.sqrt(dx * dx + dy * dy + dz * dz)
        if d < limits[0] - near or d > limits[1] + near:
            return False
    return True


@shared
def take(x: float, y: float, z: float, spheres: Floats, limits: Floats, ends: Floats, box: Floats) -> None:
    """Widen the box (2, 3) to a point, if it lies in every shell."""
    if within(x, y, z, spheres, limits, ends):
        box[0, 0], box[1, 0] = min(box[0, 0], x), max(box[1, 0], x)
        box[0, 1], box[1, 1] = min(box[0, 1], y), max(box[1, 1], y)
        box[0, 2], box[1, 2] = min(box[0, 2], z), max(box[1, 2], z)


@inline
def reduced(surfaces: Floats, j: int, k: int, out: Floats) -> None:
    """The plane (4,) in which surface j meets surface k: surface j itself, if it is one."""
    for c in range(4):
        out[c] = surfaces[j, c + 1] - surfaces[j, 0] * surfaces[k, c + 1]


@shared
def poles_and_circles(
    surfaces: Floats, count: int, balls: int, spheres: Floats, limits: Floats, ends: Floats, box: Floats, work: Floats
) -> None:
    """Widen the box to the poles of the spheres and to the extreme points of the circles in which they meet others."""
    plane, centre, way = work[0], work[1], work[2]
    for s in range(balls):
        radius2 = -surfaces[s, 4]
        for c in range(3):
            centre[c] = -0.5 * surfaces[s, c + 1]
            radius2 += centre[c] * centre[c]
        radius = math.sqrt(max(radius2, 0.0))
        for c in range(3):
            for side in (-radius, radius):
                x = centre[0] + (side if c == 0 else 0.0)
                y = centre[1] + (side if c == 1 else 0.0)
                z = centre[2] + (side if c == 2 else 0.0)
                take(x, y, z, spheres, limits, ends, box)
        for j in range(s + 1, count):
            reduced(surfaces, j, s, plane)
            square = plane[0] * plane[0] + plane[1] * plane[1] + plane[2] * plane[2]
            if square <= PARALLEL * radius2:
                continue  # about the same centre
            off = (plane[0] * centre[0] + plane[1] * centre[1] + plane[2] * centre[2] + plane[3]) / square
            rest = radius2 - off * off * square
            if rest < -TOUCH * radius2:
                continue
            ring = math.sqrt(max(rest, 0.0))
            for c in range(3):
                length = 0.0
                for e in range(3):
                    way[e] = (1.0 if e == c else 0.0) - plane[c] * plane[e] / square
                    length += way[e] * way[e]
                length = math.sqrt(length)
                if length <= TOUCH:
                    continue  # the whole circle is as far; its other extremes are tried as well
                for side in (-ring / length, ring / length):
                    take(
                        centre[0] - off * plane[0] + side * way[0],
                        centre[1] - off * plane[1] + side * way[1],
                        centre[2] - off * plane[2] + side * way[2],
                        spheres,
                        limits,
                        ends,
                        box,
                    )


@shared
def corners(
    surfaces: Floats, count: int, balls: int, spheres: Floats, limits: Floats, ends: Floats, box: Floats, work: Floats
) -> None:
    """Widen the box to the points in which three surfaces meet; spheres come before planes."""
    one, two, across = work[0], work[1], work[2]
    for s in range(count - 2):
        for j in range(s + 1, count - 1):
            for k in range(j + 1, count):
                reduced(surfaces, j, s, one)
                reduced(surfaces, k, s, two)
                x = one[1] * two[2] - one[2] * two[1]  # the line both planes have in common: its direction
                y = one[2] * two[0] - one[0] * two[2]
                z = one[0] * two[1] - one[1] * two[0]
                square = x * x + y * y + z * z
                sizes = (one[0] * one[0] + one[1] * one[1] + one[2] * one[2]) * (
                    two[0] * two[0] + two[1] * two[1] + two[2] * two[2]
                )
                if square <= PARALLEL * sizes:
                    continue
                for c in range(3):
                    across[c] = two[3] * one[c] - one[3] * two[c]
                px = (across[1] * z - across[2] * y) / square  # its point nearest to the origin
                py = (across[2] * x - across[0] * z) / square
                pz = (across[0] * y - across[1] * x) / square
                along = surfaces[s, 1] * x + surfaces[s, 2] * y + surfaces[s, 3] * z
                here = surfaces[s, 1] * px + surfaces[s, 2] * py + surfaces[s, 3] * pz + surfaces[s, 4]
                if s >= balls:  # three planes
                    if along != 0.0:
                        t = -here / along
                        take(px + t * x, py + t * y, pz + t * z, spheres, limits, ends, box)
                    continue
                here += px * px + py * py + pz * pz
                half = 0.5 * (along + 2.0 * (px * x + py * y + pz * z)) / square
                root = half * half - here / square
                if root < -TOUCH * limits[1] * limits[1] / square:
                    continue
                root = math.sqrt(max(root, 0.0))
                for t in (-half - root, -half + root):
                    take(px + t * x, py + t * y, pz + t * z, spheres, limits, ends, box)


@jit("void(f8[:,:,::1], f8[::1], f8[:,::1], f8[:,::1])")
def reach(spheres: Floats, limits: Floats, ends: Floats, box: Floats) -> None:
    """The exact box (2, 3) of P within the legs' lengths and the ends (2, 3), in any of the orientations (o, n, 3).

    Ends may be infinite. Where there is no such P, the box is left crossed: its first row is above its second.
    """
    n = spheres.shape[1]
    surfaces = np.zeros((2 * n + 6, 5))  # p'p times the first, plus the next three times p, plus the last, is 0
    middle, moved, inner, here, work = (
        np.zeros(3),
        np.empty((n, 3)),
        np.empty((2, 3)),
        np.empty((2, 3)),
        np.empty((3, 4)),
    )
    box[0], box[1] = math.inf, -math.inf
    for o in range(spheres.shape[0]):
        for c in range(3):
            middle[c] = 0.0
            for i in range(n):
                middle[c] += spheres[o, i, c] / n
        for c in range(3):  # about the middle, so that nothing cancels far from the origin
            for i in range(n):
                moved[i, c] = spheres[o, i, c] - middle[c]
            for end in range(2):
                inner[end, c] = ends[end, c] - middle[c]
        count = 0
        for bound in range(2 if limits[0] < limits[1] else 1):
            for i in range(n):
                surfaces[count, 0] = 1.0
                surfaces[count, 4] = -limits[bound] * limits[bound]
                for c in range(3):
                    surfaces[count, c + 1] = -2.0 * moved[i, c]
                    surfaces[count, 4] += moved[i, c] * moved[i, c]
                count += 1
        balls = count
        for end in range(2):
            for c in range(3):
                if math.isfinite(inner[end, c]):
                    surfaces[count] = 0.0
                    surfaces[count, c + 1], surfaces[count, 4] = 1.0, -inner[end, c]
                    count += 1
        here[0], here[1] = math.inf, -math.inf
        poles_and_circles(surfaces, count, balls, moved, limits, inner, here, work)
        corners(surfaces, count, balls, moved, limits, inner, here, work)
        for c in range(3):
            box[0, c], box[1, c] = min(box[0, c], here[0, c] + middle[c]), max(box[1, c], here[1, c] + middle[c])


@inline
def beyond_cone(d: float, along: float, cos: float) -> float:
    """How far a point is from a cone, at distance d from its tip and ``along`` its axis; 0 within it."""
    if along >= d * cos:
        return 0.0
    across, sin = math.sqrt(max(d * d - along * along, 0.0)), math.sqrt(1.0 - cos * cos)
    return across * cos - along * sin if along * cos + across * sin > 0.0 else d


@shared
def ruled_out(
    base: Floats,
    joint_axes: Floats,
    turned_joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    pairs: Ints,
    legs: Floats,
    radius: float,
) -> bool:
    """Whether no position within this radius (m) is allowed, from the legs (n, 3) of the one in the middle.

    Moving P by s changes the length of a leg, and the distance between two, by at most s; and a joint's angle is
    allowed where the end of its leg lies in a cone. Of servos only their angles and the lengths of rods are looked at.
    """
    if servos is not None:
        for i in range(legs.shape[0]):  # noqa: SIM110  # numba has no any() of a generator
            if arc_misses(servos, i, legs, radius):
                return True
        return False
    for i in range(legs.shape[0]):
        d, at_base, at_platform = 0.0, 0.0, 0.0
        for c in range(3):
            d += legs[i, c] * legs[i, c]
            at_base += legs[i, c] * joint_axes[i, c]
            at_platform -= legs[i, c] * turned_joint_axes[i, c]
        d = math.sqrt(d)
        if d < limits[0] - radius or d > limits[1] + radius:
            return True
        if beyond_cone(d, at_base, limits[2]) > radius or beyond_cone(d, at_platform, limits[3]) > radius:
            return True
    for p in range(pairs.shape[0]):
        if segment_distance(base, legs, pairs[p, 0], pairs[p, 1]) < limits[4] - radius:
            return True
    return False


@jit(
    "i8(f8[:,::1], f8[:,:,::1], f8[:,:,::1], f8[:,:,::1], f8[::1], f8[:,::1]?, i8[:,::1], f8[:,::1], i8[::1],"
    " f8[:,::1])"
)
def cover(
    base: Floats,
    turned: Floats,
    joint_axes: Floats,
    turned_joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    pairs: Ints,
    box: Floats,
    counts: Ints,
    out: Floats,
) -> int:
    """Cells of a box (2, 3), counts (3,) along its axes, that no limit rules out: how many, and the box round them."""
    n = base.shape[0]
    legs, size, place = np.empty((n, 3)), np.empty(3), np.empty(3)
    radius = 0.0
    for c in range(3):
        size[c] = (box[1, c] - box[0, c]) / counts[c]
        radius += 0.25 * size[c] * size[c]
    radius = math.sqrt(radius)
    out[0], out[1] = math.inf, -math.inf
    left = 0
    for ix in range(counts[0]):
        place[0] = box[0, 0] + (ix + 0.5) * size[0]
        for iy in range(counts[1]):
            place[1] = box[0, 1] + (iy + 0.5) * size[1]
            for iz in range(counts[2]):
                place[2] = box[0, 2] + (iz + 0.5) * size[2]
                for o in range(turned.shape[0]):
                    for i in range(n):
                        for c in range(3):
                            legs[i, c] = place[c] + turned[o, i, c] - base[i, c]
                    if not ruled_out(base, joint_axes[0], turned_joint_axes[o], limits, servos, pairs, legs, radius):
                        left += 1
                        for c in range(3):
                            out[0, c] = min(out[0, c], place[c] - 0.5 * size[c])
                            out[1, c] = max(out[1, c], place[c] + 0.5 * size[c])
                        break
    return left
