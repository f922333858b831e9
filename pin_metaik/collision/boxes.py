"""The broad phase: which pairs of solids may be near each other, by the boxes around them.

A box is turned with its solid. Two are apart when their balls are, or when one of fifteen directions parts them: the
axes of both, and the cross products of one axis of each (Gottschalk, Lin and Manocha 1996). What is apart needs no
further look, so that a check costs what is near, not what there is.

* ``poses`` (m, 12): where each moving solid is: its rotation column by column, then its translation.
* ``boxes`` (m, 8): box of each in its own frame: centre, half of its edges, radius of its ball; and its padding, which
  is added to the margin against what stands.
* ``standing`` (s, 17): box of what stands, in the world: centre, axes one by one, half of the edges, radius; padding.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, inline, jit

Flags = NDArray[np.bool_]

SLACK = 1e-9  # m that boxes count as larger, for roundings
PARALLEL = 1e-12  # square of a cross product below which its axes are parallel, and part nothing that they do not


@inline
def dot(a: Floats, i: int, b: Floats, j: int) -> float:
    """The product of the three numbers of a from i and of b from j."""
    return float(a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2])


@inline
def put(pose: Floats, box: Floats, placed: Floats) -> None:
    """Where a box is whose solid has this pose (12,), as a row (17,) of ``standing``."""
    for k in range(3):
        placed[k] = pose[9 + k] + pose[k] * box[0] + pose[3 + k] * box[1] + pose[6 + k] * box[2]
        placed[12 + k] = box[3 + k]
    for k in range(9):
        placed[3 + k] = pose[k]
    placed[15] = box[6]
    placed[16] = box[7]


@inline
def reaches(a: Floats, axis_of: Floats, k: int) -> float:
    """How far box a reaches from its centre along the k-th axis of another box."""
    i = 3 + 3 * k
    return float(
        a[12] * abs(dot(a, 3, axis_of, i)) + a[13] * abs(dot(a, 6, axis_of, i)) + a[14] * abs(dot(a, 9, axis_of, i))
    )


@inline
def parted(a: Floats, b: Floats, reach: float) -> float:
    """A distance (m) that two boxes are at least apart; infinite when it is certainly above ``reach``."""
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    far = a[15] + b[15] + reach + SLACK
    if x * x + y * y + z * z > far * far:
        return math.inf
    gap = -math.inf
    for k in range(3):
        i = 3 + 3 * k
        along_a = abs(a[i] * x + a[i + 1] * y + a[i + 2] * z) - a[12 + k] - reaches(b, a, k)
        along_b = abs(b[i] * x + b[i + 1] * y + b[i + 2] * z) - b[12 + k] - reaches(a, b, k)
        gap = max(gap, along_a, along_b)
    gap -= SLACK
    if gap > reach:
        return math.inf
    if math.isinf(a[15]) or math.isinf(b[15]):
        return gap  # what is without end reaches along all other directions
    for i in range(3, 12, 3):
        for j in range(3, 12, 3):
            u = a[i + 1] * b[j + 2] - a[i + 2] * b[j + 1]
            v = a[i + 2] * b[j] - a[i] * b[j + 2]
            w = a[i] * b[j + 1] - a[i + 1] * b[j]
            square = u * u + v * v + w * w
            if square > PARALLEL:
                room = abs(u * x + v * y + w * z)
                for k in range(3):
                    f = 3 + 3 * k
                    room -= a[12 + k] * abs(u * a[f] + v * a[f + 1] + w * a[f + 2])
                    room -= b[12 + k] * abs(u * b[f] + v * b[f + 1] + w * b[f + 2])
                if room > 0.0 and room * room > (reach + SLACK) * (reach + SLACK) * square:
                    return math.inf
    return gap


@jit("i8(f8[:,::1], f8[:,::1], i8[:,::1], f8[::1], f8[:,::1], b1[:,::1], f8, f8, f8[:,::1], i8[:,::1], f8[::1])")
def near(
    poses: Floats,
    boxes: Floats,
    pairs: Ints,
    margins: Floats,
    standing: Floats,
    asked: Flags,
    margin: float,
    beyond: float,
    placed: Floats,
    found: Ints,
    least: Floats,
) -> int:
    """The pairs whose boxes are not farther apart than their margin and ``beyond`` (m).

    Args:
        poses: Of what moves, as above; further rows do not count.
        boxes: Of what moves, as above.
        pairs: (p, 2) numbers of two moving solids that are asked about ...
        margins: (p,) ... and their margins, m.
        standing: What stands, as above.
        asked: (m, s) which moving solids are asked about against which standing ones ...
        margin: ... and their margin, m; their paddings come on top.
        beyond: m.
        placed: (m, 17) scratch.
        found: (k, 3) receives the pairs, what stands numbered from m on, and their row in ``pairs`` or -1; the pair
            first whose boxes overlap most, as it is the likeliest to collide.
        least: (k,) receives a distance that the two are at least apart, m.

    Returns:
        How many there are; when they are more than k, only k were written.
    """
    count, room = 0, found.shape[0]
    m = boxes.shape[0]
    for i in range(m):
        put(poses[i], boxes[i], placed[i])
    for j in range(standing.shape[0]):
        for i in range(m):
            if asked[i, j]:
                gap = parted(placed[i], standing[j], margin + placed[i, 16] + standing[j, 16] + beyond)
                if gap < math.inf:
                    if count < room:
                        found[count, 0], found[count, 1], found[count, 2], least[count] = i, m + j, -1, gap
                    count += 1
    for k in range(pairs.shape[0]):
        i, j = pairs[k, 0], pairs[k, 1]
        gap = parted(placed[i], placed[j], margins[k] + beyond)
        if gap < math.inf:
            if count < room:
                found[count, 0], found[count, 1], found[count, 2], least[count] = i, j, k, gap
            count += 1
    deepest = 0
    for k in range(1, min(count, room)):
        if least[k] < least[deepest]:
            deepest = k
    if deepest > 0:
        least[0], least[deepest] = least[deepest], least[0]
        for k in range(3):
            found[0, k], found[deepest, k] = found[deepest, k], found[0, k]
    return count
