"""A target's pose as proofs take it: a rotation to the last digit, and how far the given matrix is from it."""

from __future__ import annotations

import math

from pin_metaik.compiled import Floats, inline, jit
from pin_metaik.kinematics.kernel.closed_form import Numbers, Vector, dot, numbers_of


@inline
def nearer(a: Vector, b: Vector, c: Vector) -> tuple[Vector, Vector, Vector, float]:
    """One step of Newton's from three rows to the nearest rotation, (3 I - R R') R / 2; and |R R' - I| before it."""
    aa, bb, cc, ab, ac, bc = dot(a, a), dot(b, b), dot(c, c), dot(a, b), dot(a, c), dot(b, c)
    skew = math.sqrt((aa - 1.0) ** 2 + (bb - 1.0) ** 2 + (cc - 1.0) ** 2 + 2.0 * (ab * ab + ac * ac + bc * bc))
    return (
        blend(a, b, c, 3.0 - aa, -ab, -ac),
        blend(a, b, c, -ab, 3.0 - bb, -bc),
        blend(a, b, c, -ac, -bc, 3.0 - cc),
        skew,
    )


@inline
def blend(a: Vector, b: Vector, c: Vector, u: float, v: float, w: float) -> Vector:
    """(u a + v b + w c) / 2."""
    return (
        0.5 * (u * a[0] + v * b[0] + w * c[0]),
        0.5 * (u * a[1] + v * b[1] + w * c[1]),
        0.5 * (u * a[2] + v * b[2] + w * c[2]),
    )


@inline
def exactly(pose: Numbers) -> tuple[Numbers, float]:
    """The pose (12,) with the nearest rotation, and by how much the given one may stretch a vector, relative."""
    a, b, c = (pose[0], pose[1], pose[2]), (pose[3], pose[4], pose[5]), (pose[6], pose[7], pose[8])
    a, b, c, skew = nearer(a, b, c)
    a, b, c, _ = nearer(a, b, c)  # a pose is orthonormal to 1e-6, and each step squares what is left
    return (a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], pose[9], pose[10], pose[11]), skew


@jit("f8(Array(f8, 2, 'A', readonly=True), f8[::1])")
def exact_pose(target: Floats, out: Floats) -> float:
    """Write a target (4, 4) into out (12,) with the nearest rotation; returns by how much it may stretch a vector."""
    pose, skew = exactly(numbers_of(target))
    for i in range(12):
        out[i] = pose[i]
    return skew
