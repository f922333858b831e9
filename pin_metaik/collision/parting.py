"""How far bodies are apart along a direction: a distance that they have at least, without a search for it.

Where the direction is that of two nearest points, it is the distance. What was the direction some ticks ago still
nearly is: as it lies in the frame of the one body, or of the other, or from where the one of the two points has come to
where the other has. The best of these three is taken. Of a half-space or a plane the direction is always its normal.

* ``cover``: the points that bodies are around, see ``Covers``.
* ``hints`` (N, 12): of each pair the direction from the first body to the second in the frame of the first, and of the
  second; a nearest point in the frame of the first, and of the second, m. Zeros of a pair whose distance was not asked.
* ``poses`` (m, 12): where each moving body is: rotation column by column, then translation.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit

NORMAL, FIRST, SECOND, ALONG, ROW = 0, 3, 6, 9, 10  # of what is said of a pair
ROUNDING = 1e-9  # m
SOLID, PLANE = 0, 2  # kinds of cover


class Bodies(NamedTuple):
    """The bodies of a world where a configuration puts them.

    Attributes:
        poses: As above.
        m: How many move.
        points: (3, P) as ``Covers`` has them ...
        starts: (b + 1,) ...
        radii: (b,) ...
        normals: (b, 3) ...
        kinds: (b,) ... and so on.
    """

    poses: Floats
    m: int
    points: Floats
    starts: Ints
    radii: Floats
    normals: Floats
    kinds: Ints


@inline
def turned(bodies: Bodies, b: int, u: float, v: float, w: float) -> tuple[float, float, float]:
    """A direction in the frame of a body, in the world."""
    if b >= bodies.m:
        return u, v, w
    p = bodies.poses[b]
    return p[0] * u + p[3] * v + p[6] * w, p[1] * u + p[4] * v + p[7] * w, p[2] * u + p[5] * v + p[8] * w


@inline
def put(bodies: Bodies, b: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A point in the frame of a body, in the world."""
    u, v, w = turned(bodies, b, x, y, z)
    if b >= bodies.m:
        return u, v, w
    p = bodies.poses[b]
    return u + p[9], v + p[10], w + p[11]


@inline
def farthest(bodies: Bodies, b: int, u: float, v: float, w: float) -> float:
    """How far a body reaches along a direction of the world, m; of a half-space or plane, where its surface is."""
    shift = 0.0
    if b < bodies.m:
        p = bodies.poses[b]
        shift = u * p[9] + v * p[10] + w * p[11]
        u, v, w = (
            u * p[0] + v * p[1] + w * p[2],
            u * p[3] + v * p[4] + w * p[5],
            u * p[6] + v * p[7] + w * p[8],
        )
    most = -np.inf
    for k in range(bodies.starts[b], bodies.starts[b + 1]):
        most = max(most, u * bodies.points[0, k] + v * bodies.points[1, k] + w * bodies.points[2, k])
    return float(most + shift + bodies.radii[b])


@inline
def apart(bodies: Bodies, i: int, j: int, u: float, v: float, w: float) -> float:
    """How far two bodies are apart along a direction of length 1 from the first to the second, m."""
    return -farthest(bodies, j, -u, -v, -w) - farthest(bodies, i, u, v, w)


@inline
def off_surface(bodies: Bodies, flat: int, other: int) -> tuple[float, float, float]:
    """The normal of a half-space, or that of a plane on the side of another body."""
    u, v, w = turned(bodies, flat, bodies.normals[flat, 0], bodies.normals[flat, 1], bodies.normals[flat, 2])
    if bodies.kinds[flat] == PLANE:
        k = bodies.starts[other]
        x, y, z = put(bodies, other, bodies.points[0, k], bodies.points[1, k], bodies.points[2, k])
        if u * x + v * y + w * z < farthest(bodies, flat, u, v, w):
            return -u, -v, -w
    return u, v, w


@inline
def has_direction(hint: Floats) -> bool:
    """Whether there was a direction between the nearest points of a pair."""
    return bool(hint[0] * hint[0] + hint[1] * hint[1] + hint[2] * hint[2] > 0.5)


@inline
def part(bodies: Bodies, i: int, j: int, hint: Floats, enough: float, row: Floats) -> float:
    """A distance (m) that two bodies have at least, and what is nearest, into ``row`` (10,).

    Once it is found to be ``enough`` no other direction is tried. Without a hint it is minus infinity, but for a
    half-space or a plane.
    """
    a0, a1, a2 = put(bodies, i, hint[6], hint[7], hint[8])
    b0, b1, b2 = put(bodies, j, hint[9], hint[10], hint[11])
    row[FIRST], row[FIRST + 1], row[FIRST + 2] = a0, a1, a2
    row[SECOND], row[SECOND + 1], row[SECOND + 2] = b0, b1, b2
    best = -np.inf
    first, second = bodies.kinds[i], bodies.kinds[j]
    if first != SOLID and second != SOLID:
        return best
    for k in range(3):
        if second != SOLID:
            u, v, w = off_surface(bodies, j, i)
            u, v, w = -u, -v, -w
        elif first != SOLID:
            u, v, w = off_surface(bodies, i, j)
        elif not has_direction(hint):
            return best
        elif k == 0:
            u, v, w = b0 - a0, b1 - a1, b2 - a2
            length = math.sqrt(u * u + v * v + w * w)
            if length < ROUNDING:
                continue
            u, v, w = u / length, v / length, w / length
        elif k == 1:
            u, v, w = turned(bodies, j, hint[3], hint[4], hint[5])
        else:
            u, v, w = turned(bodies, i, hint[0], hint[1], hint[2])
        distance = apart(bodies, i, j, u, v, w) - ROUNDING
        if distance > best:
            best = distance
            row[NORMAL], row[NORMAL + 1], row[NORMAL + 2] = u, v, w
            row[ALONG] = u * (b0 - a0) + v * (b1 - a1) + w * (b2 - a2)
        if best >= enough or first != SOLID or second != SOLID:
            break
    return best


@inline
def number(pair: Ints, m: int, own: int, standing: int) -> int:
    """The number of a pair among all of a world: first those that move, then those of a body against what stands."""
    return int(pair[2] if pair[2] >= 0 else own + pair[0] * standing + pair[1] - m)


@jit(
    "void(f8[:,::1], f8[:,::1], i8[::1], f8[::1], f8[:,::1], i8[::1], i8, i8[:,::1], f8[:,::1], f8[::1], f8[::1],"
    "f8[::1])"
)
def part_all(
    poses: Floats,
    points: Floats,
    starts: Ints,
    radii: Floats,
    normals: Floats,
    kinds: Ints,
    own: int,
    pairs: Ints,
    hints: Floats,
    taken: Floats,
    enough: Floats,
    rooms: Floats,
) -> None:
    """How far pairs of bodies are apart at least, beyond what is taken off.

    Args:
        poses: As above; rows of bodies that move.
        points: As ``Covers`` has them, ...
        starts: ...
        radii: ...
        normals: ...
        kinds: ... so on.
        own: How many pairs of bodies that move there are.
        pairs: (k, 3) numbers of both bodies, and the pair's row among the pairs that move or -1.
        hints: As above.
        taken: (N,) what is taken off the distance of each pair of the world, m.
        enough: (k,) m; once a pair is found to have so much room, no more is looked for.
        rooms: (k,) receives the rooms, m.
    """
    bodies = Bodies(poses, poses.shape[0], points, starts, radii, normals, kinds)
    standing = kinds.shape[0] - bodies.m
    row = np.empty(ROW)
    for r in range(pairs.shape[0]):
        h = number(pairs[r], bodies.m, own, standing)
        rooms[r] = part(bodies, pairs[r, 0], pairs[r, 1], hints[h], enough[r] + taken[h], row) - taken[h]


@jit(
    "i8(f8[:,::1], f8[:,::1], i8[::1], f8[::1], f8[:,::1], i8[::1], f8[:,::1], f8[::1], i8[:,::1], f8[::1], f8[::1],"
    "f8[:,::1], f8[:,::1], f8[::1], f8[::1], f8, f8, f8, i8[:,::1], f8[:,::1], f8[:,::1])"
)
def survey(
    poses: Floats,
    points: Floats,
    starts: Ints,
    radii: Floats,
    normals: Floats,
    kinds: Ints,
    hints: Floats,
    taken: Floats,
    found: Ints,
    least: Floats,
    reaches: Floats,
    moved: Floats,
    known: Floats,
    own_gone: Floats,
    body_gone: Floats,
    influence: float,
    spare: float,
    stale: float,
    pairs: Ints,
    rooms: Floats,
    rows: Floats,
) -> int:
    """What is known, without a search for nearest points, of the pairs of bodies that matter.

    A pair matters within ``influence``, or where it may come within ``spare``. What is known of it is worth while if
    it is nearly the distance that the nearest points of some ticks ago now have along the direction.

    Args:
        poses: As for ``part_all``, as are all up to ``taken``.
        points: ...
        starts: ...
        radii: ...
        normals: ...
        kinds: ...
        hints: ...
        taken: ...
        found: (f, 3) pairs that may matter, ...
        least: (f,) ... and how far they are apart by their boxes, m.
        reaches: (p,) how much nearer pairs of bodies that move may come, m.
        moved: (m, D + 1) how far bodies may move, its first column, m.
        known: (N, 2) the room of each pair when nearest points were last asked for, m, and how far it had gone then.
        own_gone: (p,) how far pairs of bodies that move have come nearer, or gone apart, in all; m.
        body_gone: (m,) how far bodies have moved in all, m.
        influence: m.
        spare: m.
        stale: A fraction of the distance.
        pairs: (f, 3) receives those that matter.
        rooms: (f, 4) receives how far they are apart at least, how much nearer they may come, how far they nearly are
            apart, and 1 where that is not worth while.
        rows: (f, 10) receives directions and nearest points.

    Returns:
        How many there are.
    """
    bodies = Bodies(poses, poses.shape[0], points, starts, radii, normals, kinds)
    own, standing, count = reaches.shape[0], kinds.shape[0] - bodies.m, 0
    for f in range(found.shape[0]):
        i, j, k = found[f, 0], found[f, 1], found[f, 2]
        h = number(found[f], bodies.m, own, standing)
        travel = reaches[k] if k >= 0 else moved[i, 0]
        most = max(influence, travel + spare)
        if least[f] - taken[h] > most:
            continue
        row = rows[count]
        room = part(bodies, i, j, hints[h], most + taken[h], row) - taken[h]
        room = max(room, known[h, 0] - ((own_gone[k] if k >= 0 else body_gone[i]) - known[h, 1]))
        if room > most:
            continue
        nearly = row[ALONG] - taken[h] if has_direction(hints[h]) else known[h, 0]
        if not has_direction(hints[h]):
            row[NORMAL] = np.nan
        for c in range(3):
            pairs[count, c] = found[f, c]
        rooms[count, 0], rooms[count, 1], rooms[count, 2] = room, travel, nearly
        rooms[count, 3] = 0.0 if nearly > 0.0 and room >= (1.0 - stale) * nearly else 1.0
        count += 1
    return count
