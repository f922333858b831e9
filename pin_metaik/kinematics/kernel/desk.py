"""Where the fast lane works on one target: what it reads of the target and the start, and what it writes."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, allocating, inline
from pin_metaik.kinematics.kernel.closed_form import ORIGIN, Numbers, Vector, numbers_of
from pin_metaik.kinematics.kernel.layout import Entries
from pin_metaik.kinematics.pose import ORTHONORMAL

Quaternion: TypeAlias = tuple[float, float, float, float]
Desk: TypeAlias = tuple[Floats, Floats]

POSE = "Array(f8, 2, 'A', readonly=True)"  # (4, 4), however it lies in memory; read only
NOWHERE = ORIGIN, (0.0, 0.0, 0.0, 1.0)


@inline
def is_pose(M: Floats) -> bool:
    """Whether a matrix is a pose: (4, 4), finite, orthonormal, right-handed, last row 0 0 0 1. NaN fails every test."""
    if M.shape[0] != 4 or M.shape[1] != 4:
        return False
    sound = bool(M[3, 0] == 0.0 and M[3, 1] == 0.0 and M[3, 2] == 0.0 and M[3, 3] == 1.0)
    for i in range(3):
        sound = sound and abs(M[i, 3]) < np.inf
        j, k = (i + 1) % 3, (i + 2) % 3
        sound = sound and abs(M[i, 0] * M[i, 0] + M[i, 1] * M[i, 1] + M[i, 2] * M[i, 2] - 1.0) <= ORTHONORMAL
        for c in range(3):  # each row is the cross product of the two after it
            d, e = (c + 1) % 3, (c + 2) % 3
            sound = sound and abs(M[j, d] * M[k, e] - M[j, e] * M[k, d] - M[i, c]) <= ORTHONORMAL
    return sound


@inline
def quaternion(pose: Numbers) -> Quaternion:
    """Unit quaternion (x, y, z, w) of a pose, with the sign that Pinocchio (Eigen; Shoemake 1987) gives it."""
    a, b, c, d, e, f, g, h, i = pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]
    if a + e + i > 0.0:
        x, y, z, w = h - f, c - g, d - b, 1.0 + a + e + i
    elif i >= a and i >= e:
        x, y, z, w = c + g, f + h, 1.0 + i - a - e, d - b
    elif e > a:
        x, y, z, w = b + d, 1.0 + e - i - a, h + f, c - g
    else:
        x, y, z, w = 1.0 + a - e - i, d + b, g + c, h - f
    k = 1.0 / math.sqrt(x * x + y * y + z * z + w * w)
    return k * x, k * y, k * z, k * w


@inline
def parts_of(target: Floats) -> tuple[Vector, Quaternion]:
    """Position and quaternion of a target (4, 4)."""
    pose = numbers_of(target)
    return (pose[9], pose[10], pose[11]), quaternion(pose)


@inline
def write_world(pose: Numbers, task: Floats) -> None:
    """Write the world as seen from the target into a task."""
    for i in range(3):
        offset = 0.0
        for j in range(3):
            task[3 * i + j] = pose[3 * j + i]
            offset -= pose[3 * j + i] * pose[9 + j]
        task[9 + i] = offset


@inline
def read_start(q: Floats, entries: Entries, guess: Floats) -> bool:
    """Bring q inside the limits and read its coordinates; whether it is (nq,) and finite."""
    least, most, places = entries
    if q.shape[0] != least.shape[0]:
        return False
    sound = True
    for e in range(q.shape[0]):
        sound = sound and abs(q[e]) < np.inf
        q[e] = min(max(q[e], least[e]), most[e])
    for c in range(guess.shape[0]):
        e = places[c, 0]
        guess[c] = math.atan2(q[e + 1], q[e]) if places[c, 1] == 1 else q[e]
    return sound


@inline
def read(target: Floats, q: Floats, entries: Entries, task: Floats, guess: Floats) -> bool:
    """Write the target's world and the start's coordinates; whether they are a pose and a configuration."""
    if not is_pose(target) or not read_start(q, entries, guess):
        return False
    write_world(numbers_of(target), task)
    return True


@inline
def write_end(x: Floats, entries: Entries, q: Floats) -> None:
    """Write coordinates (n,) into q, not a rounding beyond the limits."""
    least, most, places = entries
    for c in range(x.shape[0]):
        e = places[c, 0]
        if places[c, 1] == 1:
            q[e], q[e + 1] = math.cos(x[c]), math.sin(x[c])
        else:
            q[e] = min(max(x[c], least[e]), most[e])


@allocating
def desk_for(n: int, S: int) -> Desk:
    """Where a target is worked on."""
    return np.empty(26 + 3 * n + 18), np.empty((2 * S, 3))


@inline
def laid_out(desk: Desk, n: int) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Task (26,), guess, start and best (n,), and room for a pose and its error (18,)."""
    one = desk[0]
    a, b, c = 26 + n, 26 + 2 * n, 26 + 3 * n
    return one[:26], one[26:a], one[a:b], one[b:c], one[c:]
