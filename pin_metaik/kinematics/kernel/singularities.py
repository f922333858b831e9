"""What vanishes where an arm of six joints is singular, at many configurations: its signs tell branches apart.

The determinant of the Jacobian is a product of three factors where the arm has a closed form. Axes 2 and 3 are
parallel, h2, and axes 5 and 6 meet in O5, as does axis 4 in a wrist, or it is parallel to axes 2 and 3. Then three
columns of the Jacobian span all that the factors of the others are taken modulo:

    shoulder = h2 . (h1 x (O5 - O1)),  elbow = h2 . ((O3 - O2) x (O4 - O3)),  wrist = h4 . (h5 x h6)

(Pieper 1968; of arms with three parallel axes O4 is on axis 4, of those with a wrist it is O5).
"""

from __future__ import annotations

import numpy as np

from pin_metaik.compiled import Floats, inline, jit
from pin_metaik.kinematics.kernel.closed_form import Vector, cross, dot, minus, vector
from pin_metaik.kinematics.kernel.forward import IDENTITY, forward, sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import COLUMN, O5_TIP, ROTATES, SCALE, SIDE_2, Arm

SHOULDER, ELBOW, WRIST, WHOLE = range(4)


@inline
def determinant(A: Floats) -> float:
    """Of A (n, n), which is overwritten: by elimination with pivots."""
    n, product = A.shape[0], 1.0
    for c in range(n):
        best = c
        for r in range(c + 1, n):
            if abs(A[r, c]) > abs(A[best, c]):
                best = r
        if A[best, c] == 0.0:
            return 0.0
        if best != c:
            product = -product
            for k in range(c, n):
                A[c, k], A[best, k] = A[best, k], A[c, k]
        product *= A[c, c]
        for r in range(c + 1, n):
            share = A[r, c] / A[c, c]
            for k in range(c + 1, n):
                A[r, k] -= share * A[c, k]
    return product


@inline
def write_columns(arm: Arm, axes: Floats, origins: Floats, tip: Vector, J: Floats) -> None:
    """The transposed Jacobian (6, 6) of the tip in the world frame."""
    joints, wiring, _, _ = arm
    for c in range(6):
        for k in range(6):
            J[c, k] = 0.0
    for s in range(joints.shape[0]):
        c, scale, axis = wiring[s, COLUMN], joints[s, SCALE], vector(axes[s])
        if wiring[s, ROTATES] == 1:
            moved = cross(axis, minus(tip, vector(origins[s])))
            for k in range(3):
                J[c, k] += scale * moved[k]
                J[c, 3 + k] += scale * axis[k]
        else:
            for k in range(3):
                J[c, k] += scale * axis[k]


@inline
def write_factors(form: Floats, axes: Floats, origins: Floats, pose: Floats, out: Floats) -> None:
    """The three factors of an arm with a closed form."""
    tip = vector(form[O5_TIP])
    wrist = minus(
        (pose[9], pose[10], pose[11]),
        (
            pose[0] * tip[0] + pose[1] * tip[1] + pose[2] * tip[2],
            pose[3] * tip[0] + pose[4] * tip[1] + pose[5] * tip[2],
            pose[6] * tip[0] + pose[7] * tip[1] + pose[8] * tip[2],
        ),
    )
    h1, h2, elbow = vector(axes[0]), vector(axes[1]), vector(origins[2])
    end = wrist if form[SIDE_2] == 0.0 else vector(origins[3])
    out[SHOULDER] = dot(h2, cross(h1, minus(wrist, vector(origins[0]))))
    out[ELBOW] = dot(h2, cross(minus(elbow, vector(origins[1])), minus(end, elbow)))
    out[WRIST] = dot(vector(axes[3]), cross(vector(axes[4]), vector(axes[5])))


@inline
def factors_in(block: Floats, X: Floats, out: Floats, axes: Floats, origins: Floats, pose: Floats, J: Floats) -> None:
    """``factors`` in room that was made for it."""
    arm, _, _, _, form = unpack(block)
    joints, wiring, ends, tips = arm
    for i in range(X.shape[0]):
        forward(joints, wiring, ends[0], ends[1], tips[0], IDENTITY, X[i], axes, origins, pose)
        write_columns(arm, axes, origins, (pose[9], pose[10], pose[11]), J)
        out[i, WHOLE] = determinant(J)
        if form.shape[0] > 0:
            write_factors(form, axes, origins, pose, out[i])


@jit("void(f8[::1], f8[:,::1], f8[:,::1])")
def factors(block: Floats, X: Floats, out: Floats) -> None:
    """Write, for coordinates X (k, 6), shoulder, elbow and wrist, if the block has a closed form, and the determinant.

    ``out`` (k, 4) is in m, m^2, 1 and, for turning joints, m^3.
    """
    S, _, _ = sizes_of(block)
    factors_in(block, X, out, np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty((6, 6)))
