"""How many of some approximate roots are proved to be roots, and separate.

Six joints have at most 16 separate configurations for a pose, real and complex (Primrose 1986; Lee and Liang 1988): a
fact about the arm's map from configurations to poses, whose every fibre has at most as many isolated points as the map
has degree. As many proved ones leave no room for another, nor for a curve of them.

With the twist xi_s of each joint at x, the pose at x + d is a product of exp(xi_s d_s) times the pose at x. Its second
derivative is at most X^2 exp(X r) where all |d_s| <= r, X being the sum of the norms of xi_s as 4x4 matrices. So where
A inverts the first one, Newton's method, simplified, maps the ball of radius r = 1 / (8 |A| X^2) into itself and
contracts it, provided that the error e at x has |A| |e| <= r / 2: there is one root in it, and a simple one
(Kantorovich 1948).
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit, shared
from pin_metaik.kinematics.kernel.forward import copy
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE, SHIFT
from pin_metaik.kinematics.roots.complex_arm import (
    SAME,
    WORLD,
    ComplexArm,
    Complexes,
    ComplexScratch,
    aim,
    carried,
    complex_scratch,
    is_among,
    linked,
    place,
    reciprocal,
)

ROUNDING = 1e-14  # of a pose, by the sum of the condition numbers of its factors
SOUND = 1e-4  # how far the computed inverse may be from one


@inline
def square(z: complex) -> float:
    """|z|^2."""
    return z.real * z.real + z.imag * z.imag


@shared
def invert(A: Complexes) -> bool:
    """A (6, 12) holds a matrix and room for its inverse (Gauss and Jordan); False where it is singular."""
    for i in range(6):
        for j in range(6):
            A[i, 6 + j] = 1.0 if i == j else 0.0
    for k in range(6):
        pivot, largest = k, 0.0
        for r in range(k, 6):
            if square(A[r, k]) > largest:
                pivot, largest = r, square(A[r, k])
        if largest == 0.0:
            return False
        for j in range(12):
            A[k, j], A[pivot, j] = A[pivot, j], A[k, j]
        scale = reciprocal(complex(A[k, k]))
        for j in range(12):
            A[k, j] *= scale
        for r in range(6):
            if r != k:
                factor = complex(A[r, k])
                for j in range(12):
                    A[r, j] -= factor * A[k, j]
    return True


@shared
def condition(arm: ComplexArm, x: Complexes) -> float:
    """Sum of |P| |P^-1| over the frames P of all joints, as 4x4 matrices: what rounding errors grow by."""
    F, total = WORLD, 1.0
    for s in range(arm.joints.shape[0]):
        F = linked(F, arm.joints[s])
        F = carried(F, arm.wiring[s, ROTATES], arm.joints[s, SCALE] * x[arm.wiring[s, COLUMN]] + arm.joints[s, SHIFT])
        turn = 1.0
        for k in range(9):
            turn += square(F[k])
        forth = square(F[9]) + square(F[10]) + square(F[11])
        back = 0.0
        for k in range(3):
            back += square(F[k] * F[9] + F[3 + k] * F[10] + F[6 + k] * F[11])
        total += math.sqrt((turn + forth) * (turn + back))
    return total


@shared
def is_simple_root(arm: ComplexArm, target: Complexes, x: Complexes, A: Complexes, work: ComplexScratch) -> bool:
    """Whether it is proved that there is one root within SAME / 4 of x (6,), and a simple one; A (6, 12) is room."""
    place(arm, x, work)
    aim(target, work)
    J = work.twists
    X = error = 0.0
    for c in range(6):
        speed = turning = 0.0
        for r in range(3):
            speed += square(J[r, c])
            turning += square(J[3 + r, c])
        X += math.sqrt(speed + 2.0 * turning)
        error += square(J[c, 6])
        for r in range(6):
            A[r, c] = J[r, c]
    P, T = work.pose, target
    size = (1.0 + square(P[9]) + square(P[10]) + square(P[11])) * (1.0 + square(T[9]) + square(T[10]) + square(T[11]))
    rounding = ROUNDING * size * condition(arm, x)
    error = math.sqrt(error) + rounding
    if not invert(A):
        return False
    norm = 0.0
    for r in range(6):
        row = 0.0
        for c in range(6):
            row += square(A[r, 6 + c])
        norm = max(norm, math.sqrt(row))
    radius = 1.0 / (8.0 * norm * X * X)
    return norm * X * (error + rounding) < SOUND and norm * error <= min(0.5 * radius, 0.25 * SAME)


@shared
def count_simple(arm: ComplexArm, target: Complexes, points: Complexes, A: Complexes, work: ComplexScratch) -> int:
    """``simple_roots`` in room that was made for it."""
    count = 0
    for k in range(points.shape[0]):
        if is_simple_root(arm, target, points[k], A, work) and not is_among(arm, points[k], points, k, SAME):
            count += 1
    return count


@jit("i8(f8[:,::1], i8[:,::1], f8[::1], i8[::1], f8[::1], c16[:,::1])")
def simple_roots(joints: Floats, wiring: Ints, tip: Floats, periodic: Ints, target: Floats, points: Complexes) -> int:
    """How many of the points (k, 6) are proved to be simple roots for a pose (12,), no two of them the same."""
    pose, A = np.empty(12, np.complex128), np.empty((6, 12), np.complex128)
    copy(target, pose)
    return count_simple(ComplexArm(joints, wiring, tip, periodic), pose, points, A, complex_scratch())
