"""An arm of six coordinates in complex numbers: forward kinematics, and Newton's method on a pose.

A complex angle has a complex cosine and sine, so that a pose keeps ``R' R = 1`` without being real. A twist (6,) is the
linear velocity of the point at the world's origin, then the angular velocity. Lengths are in units of the arm's, so
that both count alike.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit, shared
from pin_metaik.kinematics.kernel.forward import FULL_TURN, copy
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE, SHIFT

Complexes = NDArray[np.complex128]
Frame: TypeAlias = tuple[complex, ...]  # twelve: rotation row by row, then translation

WORLD: Frame = (1 + 0j, 0j, 0j, 0j, 1 + 0j, 0j, 0j, 0j, 1 + 0j, 0j, 0j, 0j)
LOST = math.inf  # step of Newton's that leads nowhere
ARRIVED = 1e-7  # rad or lengths: last step at a root, where rounding keeps it from being shorter
SAME = 1e-6  # rad or lengths: two roots nearer than this are one
LEAST_PIVOT = 1e-8  # of the Jacobian at a root; one below it is a root of a curve of them


class ComplexArm(NamedTuple):
    """The joints of one tip.

    Attributes:
        joints: (S, 14) placement, scale and shift of each; see ``kernel.layout``.
        wiring: (S, 2) the coordinate it follows, and 1 if it turns.
        tip: (12,) placement of the tip in the last joint frame.
        periodic: (6,) 1 for a coordinate that a whole turn brings back.
    """

    joints: Floats
    wiring: Ints
    tip: Floats
    periodic: Ints


class ComplexScratch(NamedTuple):
    """Where one configuration is worked on.

    Attributes:
        pose: (12,) of the tip.
        twists: (6, 7) the twist of each coordinate, and in the last column what they shall add up to.
    """

    pose: Complexes
    twists: Complexes


@allocating
def complex_scratch() -> ComplexScratch:
    """Room for one configuration."""
    return ComplexScratch(np.empty(12, np.complex128), np.empty((6, 7), np.complex128))


@inline
def reciprocal(z: complex) -> complex:
    """1 / z; not finite where z is 0, which a division would raise an error for."""
    scale = 1.0 / (z.real * z.real + z.imag * z.imag)
    return complex(z.real * scale, -z.imag * scale)


@inline
def cosine_sine(x: complex) -> tuple[complex, complex]:
    """Cosine and sine of a complex angle."""
    c, s = math.cos(x.real), math.sin(x.real)
    grown = math.exp(x.imag)
    shrunk = 1.0 / grown
    cosh, sinh = 0.5 * (grown + shrunk), 0.5 * (grown - shrunk)
    return complex(c * cosh, -s * sinh), complex(s * cosh, c * sinh)


@inline
def linked(F: Frame, P: Floats) -> Frame:
    """A frame and a link (12,) behind it."""
    a, b, c, d, e, f, g, h, i, x, y, z = F
    return (
        a * P[0] + b * P[3] + c * P[6],
        a * P[1] + b * P[4] + c * P[7],
        a * P[2] + b * P[5] + c * P[8],
        d * P[0] + e * P[3] + f * P[6],
        d * P[1] + e * P[4] + f * P[7],
        d * P[2] + e * P[5] + f * P[8],
        g * P[0] + h * P[3] + i * P[6],
        g * P[1] + h * P[4] + i * P[7],
        g * P[2] + h * P[5] + i * P[8],
        x + a * P[9] + b * P[10] + c * P[11],
        y + d * P[9] + e * P[10] + f * P[11],
        z + g * P[9] + h * P[10] + i * P[11],
    )


@inline
def carried(F: Frame, turns: int, value: complex) -> Frame:
    """A frame that a joint turns about its own z, or slides along it."""
    a, b, c, d, e, f, g, h, i, x, y, z = F
    if turns == 1:
        cos, sin = cosine_sine(value)
        return (
            cos * a + sin * b,
            cos * b - sin * a,
            c,
            cos * d + sin * e,
            cos * e - sin * d,
            f,
            cos * g + sin * h,
            cos * h - sin * g,
            i,
            x,
            y,
            z,
        )
    return a, b, c, d, e, f, g, h, i, x + value * c, y + value * f, z + value * i


@shared
def place(arm: ComplexArm, x: Complexes, work: ComplexScratch) -> None:
    """Write the pose of the tip at coordinates x (6,), and the twist of each coordinate."""
    joints, wiring, J = arm.joints, arm.wiring, work.twists
    for r in range(6):
        for k in range(6):
            J[r, k] = 0.0
    F = WORLD
    for s in range(joints.shape[0]):
        F = linked(F, joints[s])
        c, f, i, px, py, pz = F[2], F[5], F[8], F[9], F[10], F[11]
        k, scale = wiring[s, COLUMN], joints[s, SCALE]
        if wiring[s, ROTATES] == 1:
            J[0, k] += scale * (py * i - pz * f)
            J[1, k] += scale * (pz * c - px * i)
            J[2, k] += scale * (px * f - py * c)
            J[3, k] += scale * c
            J[4, k] += scale * f
            J[5, k] += scale * i
        else:
            J[0, k] += scale * c
            J[1, k] += scale * f
            J[2, k] += scale * i
        F = carried(F, wiring[s, ROTATES], scale * x[k] + joints[s, SHIFT])
    F = linked(F, arm.tip)
    for k in range(12):
        work.pose[k] = F[k]


@shared
def aim(target: Complexes, work: ComplexScratch) -> None:
    """Write the twist that takes the pose to a target (12,) near by into the last column, to first order.

    That is of D = T F^-1: its translation, and the vector of its rotation's skew part.
    """
    F, T, J = work.pose, target, work.twists
    a, b = T[0] * F[0] + T[1] * F[1] + T[2] * F[2], T[0] * F[3] + T[1] * F[4] + T[2] * F[5]
    c = T[0] * F[6] + T[1] * F[7] + T[2] * F[8]
    d, e = T[3] * F[0] + T[4] * F[1] + T[5] * F[2], T[3] * F[3] + T[4] * F[4] + T[5] * F[5]
    f = T[3] * F[6] + T[4] * F[7] + T[5] * F[8]
    g, h = T[6] * F[0] + T[7] * F[1] + T[8] * F[2], T[6] * F[3] + T[7] * F[4] + T[8] * F[5]
    i = T[6] * F[6] + T[7] * F[7] + T[8] * F[8]
    J[0, 6] = T[9] - (a * F[9] + b * F[10] + c * F[11])
    J[1, 6] = T[10] - (d * F[9] + e * F[10] + f * F[11])
    J[2, 6] = T[11] - (g * F[9] + h * F[10] + i * F[11])
    J[3, 6], J[4, 6], J[5, 6] = 0.5 * (h - f), 0.5 * (c - g), 0.5 * (d - b)


@shared
def solve_twists(J: Complexes) -> bool:
    """Solve J[:, :6] dx = J[:, 6] in place, dx into the last column; False where J is singular."""
    for k in range(6):
        pivot, largest = k, 0.0
        for r in range(k, 6):
            size = J[r, k].real * J[r, k].real + J[r, k].imag * J[r, k].imag
            if size > largest:
                pivot, largest = r, size
        if largest < 1e-40:
            return False
        if pivot != k:
            for c in range(k, 7):
                J[k, c], J[pivot, c] = J[pivot, c], J[k, c]
        inverse = J[k, k].conjugate() / largest
        for r in range(k + 1, 6):
            factor = J[r, k] * inverse
            for c in range(k + 1, 7):
                J[r, c] -= factor * J[k, c]
        J[k, k] = inverse
    for k in range(5, -1, -1):
        for c in range(k + 1, 6):
            J[k, 6] -= J[k, c] * J[c, 6]
        J[k, 6] *= J[k, k]
    return True


@shared
def newton(
    arm: ComplexArm, target: Complexes, x: Complexes, most: int, close: float, work: ComplexScratch
) -> tuple[float, float, int]:
    """Newton's method from x (6,) in place, until a step is shorter than ``close``.

    Returns the lengths of the first step and of the last, rad or lengths, and evaluations. It ends, LOST, with a step
    longer than a radian, or hardly shorter than the one before, unless that was short.
    """
    first = last = LOST
    for k in range(most):
        place(arm, x, work)
        aim(target, work)
        if not solve_twists(work.twists):
            return first, LOST, k + 1
        size = 0.0
        for c in range(6):
            d = work.twists[c, 6]
            size = max(size, abs(d.real), abs(d.imag))
        if k == 0:
            first = size
        if k > 0 and size > close and size > 0.75 * last:
            return first, last if last < ARRIVED else LOST, k + 1
        if not size < 1.0:
            return first, LOST, k + 1
        for c in range(6):
            x[c] += work.twists[c, 6]
        last = size
        if size < close:
            return first, last, k + 1
    return first, last, most


@inline
def is_regular(work: ComplexScratch) -> bool:
    """Whether the Jacobian that ``solve_twists`` has taken apart, which leaves its inverse pivots, is not singular."""
    regular = True
    for k in range(6):
        inverse = complex(work.twists[k, k])
        regular = regular and inverse.real * inverse.real + inverse.imag * inverse.imag < LEAST_PIVOT**-2
    return regular


@inline
def is_among(arm: ComplexArm, x: Complexes, points: Complexes, count: int, apart: float) -> bool:
    """Whether x (6,) is one of the first points (m, 6), whole turns aside."""
    for k in range(count):
        far = 0.0
        for c in range(6):
            d = x[c] - points[k, c]
            turns = np.round(d.real / FULL_TURN) if arm.periodic[c] == 1 else 0.0
            far = max(far, abs(d.real - FULL_TURN * turns), abs(d.imag))
        if far < apart:
            return True
    return False


@inline
def added(arm: ComplexArm, x: Complexes, points: Complexes, count: int, apart: float) -> int:
    """How many points (m, 6) there are with x (6,), which is added if it is new and there is room."""
    if count == points.shape[0] or is_among(arm, x, points, count, apart):
        return count
    for c in range(6):
        points[count, c] = x[c]
    return count + 1


@jit("void(f8[:,::1], i8[:,::1], f8[::1], i8[::1], c16[::1], c16[::1])")
def complex_pose(joints: Floats, wiring: Ints, tip: Floats, periodic: Ints, x: Complexes, out: Complexes) -> None:
    """Pose (12,) of the tip at coordinates x (6,)."""
    work = complex_scratch()
    place(ComplexArm(joints, wiring, tip, periodic), x, work)
    copy(work.pose, out)
