"""The compiled loop that follows the complex assemblies of a platform while its dimensions change.

A pose is a pair of quaternions (q, g), up to a common factor: q turns, and ``p = 2 vec(g q*) / q'q`` with ``q'g = 0``
(Study 1891). That makes the equation of leg i, ``|p + R m - b|^2 = d^2``, one of second degree (Wampler 1996)::

    g'g + (m - b)'w - (m + b)'c - b'R m / 2 + (m'm + b'b - d^2) / 4 q'q = 0
    w = q0 gv - g0 qv,   c = qv x gv,   R m = (q0^2 - qv'qv) m + 2 qv (qv'm) + 2 q0 qv x m

Lengths are taken from the ends of the first leg, so that b and m are zero for it and its equation is
``g'g = d^2 / 4 q'q``; subtracted from the others, it leaves nothing in them that is not small where q is, far from the
base. Six of them and ``q'g = 0`` have at most 40 separate solutions with ``q'q != 0``, real and complex together; those
with ``q'q = 0`` are at infinity. When b, m and d^2 go straight from complex numbers drawn at random to those of a
platform, the solutions move along smooth paths, and every separate assembly of the platform is the end of one of them
(Sommese and Wampler 2005, 7.1).

``u`` (8,) is (q0, qv, g0, gv) of length 1; ``legs`` (6, 7) holds b, m and d^2 of each leg; b = m = 0 for the first.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compiled import Floats, Ints, inline, jit, shared

Complexes = NDArray[np.complex128]

ARRIVED, STALLED = 1, 2

NEWTON = 4  # corrections at most after every step
CLOSE = 1e-11  # last correction of a point that lies on its path
SHORTEST = 1e-9  # step in t: from there on a path ends in a singular point, or at infinity
LONGEST = 0.1
STEPS = 4000


@inline
def legs_at(start: Complexes, rates: Complexes, t: float, legs: Complexes) -> None:
    """Dimensions on the straight way from the start on."""
    for i in range(6):
        for c in range(7):
            legs[i, c] = start[i, c] + t * rates[i, c]


@shared
def linearize(legs: Complexes, patch: Complexes, u: Complexes, J: Complexes) -> None:
    """The derivative J (8, 8) of the equations by u; they are J u / 2 themselves, but for the last.

    The last row is that of ``patch* u = 1``, which settles the common factor.
    """
    q0, qx, qy, qz, g0, gx, gy, gz = u[0], u[1], u[2], u[3], u[4], u[5], u[6], u[7]
    s = legs[0, 6]
    for i in range(1, 6):
        bx, by, bz = legs[i, 0], legs[i, 1], legs[i, 2]
        mx, my, mz = legs[i, 3], legs[i, 4], legs[i, 5]
        bm = bx * mx + by * my + bz * mz
        e = 0.5 * (bx * bx + by * by + bz * bz + mx * mx + my * my + mz * mz - legs[i, 6] + s)  # twice a quarter
        ax, ay, az = mx - bx, my - by, mz - bz
        sx, sy, sz = mx + bx, my + by, mz + bz
        nx, ny, nz = my * bz - mz * by, mz * bx - mx * bz, mx * by - my * bx
        qm, qb = qx * mx + qy * my + qz * mz, qx * bx + qy * by + qz * bz
        e_plus, e_minus = e + bm, e - bm
        J[i, 0] = ax * gx + ay * gy + az * gz + e_minus * q0 - (qx * nx + qy * ny + qz * nz)
        J[i, 1] = e_plus * qx - g0 * ax - (gy * sz - gz * sy) - bx * qm - mx * qb - q0 * nx
        J[i, 2] = e_plus * qy - g0 * ay - (gz * sx - gx * sz) - by * qm - my * qb - q0 * ny
        J[i, 3] = e_plus * qz - g0 * az - (gx * sy - gy * sx) - bz * qm - mz * qb - q0 * nz
        J[i, 4] = -(qx * ax + qy * ay + qz * az)
        J[i, 5] = q0 * ax - (sy * qz - sz * qy)
        J[i, 6] = q0 * ay - (sz * qx - sx * qz)
        J[i, 7] = q0 * az - (sx * qy - sy * qx)
    for c in range(4):
        J[0, c], J[0, c + 4] = -0.5 * s * u[c], 2.0 * u[c + 4]
        J[6, c], J[6, c + 4] = u[c + 4], u[c]
    for c in range(8):
        J[7, c] = patch[c].conjugate()


@shared
def drift(legs: Complexes, rates: Complexes, u: Complexes, out: Complexes) -> None:
    """The derivative (8,) of the equations by t, while the dimensions change at these rates (6, 7)."""
    q0, qx, qy, qz, g0, gx, gy, gz = u[0], u[1], u[2], u[3], u[4], u[5], u[6], u[7]
    wx, wy, wz = q0 * gx - g0 * qx, q0 * gy - g0 * qy, q0 * gz - g0 * qz
    cx, cy, cz = qy * gz - qz * gy, qz * gx - qx * gz, qx * gy - qy * gx
    v = qx * qx + qy * qy + qz * qz
    N, D = q0 * q0 + v, q0 * q0 - v
    out[0] = -0.25 * rates[0, 6] * N
    for i in range(1, 6):
        bx, by, bz, mx, my, mz = legs[i, 0], legs[i, 1], legs[i, 2], legs[i, 3], legs[i, 4], legs[i, 5]
        Bx, By, Bz, Mx, My, Mz = rates[i, 0], rates[i, 1], rates[i, 2], rates[i, 3], rates[i, 4], rates[i, 5]
        e = 0.5 * (bx * Bx + by * By + bz * Bz + mx * Mx + my * My + mz * Mz) + 0.25 * (rates[0, 6] - rates[i, 6])
        dot = bx * Mx + by * My + bz * Mz + Bx * mx + By * my + Bz * mz
        qm, qb = qx * mx + qy * my + qz * mz, qx * bx + qy * by + qz * bz
        qM, qB = qx * Mx + qy * My + qz * Mz, qx * Bx + qy * By + qz * Bz
        nx = my * Bz - mz * By + My * bz - Mz * by
        ny = mz * Bx - mx * Bz + Mz * bx - Mx * bz
        nz = mx * By - my * Bx + Mx * by - My * bx
        out[i] = (Mx - Bx) * wx + (My - By) * wy + (Mz - Bz) * wz - (Mx + Bx) * cx - (My + By) * cy - (Mz + Bz) * cz
        out[i] += e * N - 0.5 * D * dot - (qB * qm + qb * qM) - q0 * (qx * nx + qy * ny + qz * nz)
    out[6], out[7] = 0.0, 0.0


@shared
def solve(J: Complexes, x: Complexes) -> bool:
    """Solve J x = x in place by elimination, rows brought to one size and pivoted; False where J is singular."""
    for i in range(8):
        largest = 0.0
        for c in range(8):
            largest = max(largest, abs(J[i, c].real), abs(J[i, c].imag))
        if largest == 0.0:
            return False
        for c in range(8):
            J[i, c] /= largest
        x[i] /= largest
    for k in range(8):
        pivot, largest = k, 0.0
        for i in range(k, 8):
            size = J[i, k].real * J[i, k].real + J[i, k].imag * J[i, k].imag
            if size > largest:
                pivot, largest = i, size
        if largest < 1e-40:
            return False
        if pivot != k:
            for c in range(k, 8):
                J[k, c], J[pivot, c] = J[pivot, c], J[k, c]
            x[k], x[pivot] = x[pivot], x[k]
        inverse = J[k, k].conjugate() / largest
        for i in range(k + 1, 8):
            factor = J[i, k] * inverse
            for c in range(k + 1, 8):
                J[i, c] -= factor * J[k, c]
            x[i] -= factor * x[k]
        J[k, k] = inverse
    for k in range(7, -1, -1):
        for c in range(k + 1, 8):
            x[k] -= J[k, c] * x[c]
        x[k] *= J[k, k]
    return True


@shared
def tangent(
    start: Complexes,
    rates: Complexes,
    t: float,
    u: Complexes,
    patch: Complexes,
    legs: Complexes,
    J: Complexes,
    out: Complexes,
) -> bool:
    """The derivative (8,) of u by t along its path; ``legs`` and J are room."""
    legs_at(start, rates, t, legs)
    linearize(legs, patch, u, J)
    drift(legs, rates, u, out)
    for c in range(8):
        out[c] = -out[c]
    return solve(J, out)


@shared
def correct(legs: Complexes, patch: Complexes, u: Complexes, J: Complexes, step: Complexes, steady: float) -> bool:
    """Newton from u in place; False unless its first step is shorter than ``steady`` and its last close to none."""
    last = math.inf
    for iteration in range(NEWTON):
        linearize(legs, patch, u, J)
        for i in range(8):
            step[i] = 0.0
            for c in range(8):
                step[i] -= J[i, c] * u[c]
            step[i] *= 0.5
        step[7] = 1.0 + 2.0 * step[7]
        if not solve(J, step):
            return False
        size = 0.0
        for c in range(8):
            size += step[c].real * step[c].real + step[c].imag * step[c].imag
        size = math.sqrt(size)
        if (iteration == 0 and size > steady) or size > 0.5 * last + CLOSE:
            return False
        for c in range(8):
            u[c] += step[c]
        last = size
        if size < CLOSE:
            return True
    return False


@inline
def normalize(u: Complexes) -> None:
    """Divide u by its length."""
    square = 0.0
    for c in range(8):
        square += u[c].real * u[c].real + u[c].imag * u[c].imag
    for c in range(8):
        u[c] /= math.sqrt(square)


@jit("void(c16[:,::1], c16[:,::1], f8, c16[:,::1], f8[::1], i8[::1])")
def follow(start: Complexes, end: Complexes, steady: float, points: Complexes, times: Floats, states: Ints) -> None:
    """Follow solutions (k, 8) in place from the legs (6, 7) at the start to those at the end.

    A step is taken when Newton corrects it by less than ``steady`` at first: what is shorter confuses fewer paths. A
    path that cannot go on ends in ``STALLED`` at a time below 1.
    """
    rates = end - start
    legs, J = np.empty((6, 7), dtype=np.complex128), np.empty((8, 8), dtype=np.complex128)
    patch, trial, step = (
        np.empty(8, dtype=np.complex128),
        np.empty(8, dtype=np.complex128),
        np.empty(8, dtype=np.complex128),
    )
    slopes = np.empty((4, 8), dtype=np.complex128)
    for k in range(points.shape[0]):
        u = points[k]
        normalize(u)
        t, h = 0.0, 0.01
        states[k] = STALLED
        for _ in range(STEPS):
            for c in range(8):
                patch[c] = u[c]
            h = min(h, LONGEST, 1.0 - t)
            good = tangent(start, rates, t, u, patch, legs, J, slopes[0])
            for stage in range(1, 4):
                share = h if stage == 3 else 0.5 * h
                for c in range(8):
                    trial[c] = u[c] + share * slopes[stage - 1, c]
                good = good and tangent(start, rates, t + share, trial, patch, legs, J, slopes[stage])
            for c in range(8):
                trial[c] = u[c] + h / 6.0 * (slopes[0, c] + 2.0 * slopes[1, c] + 2.0 * slopes[2, c] + slopes[3, c])
            if good:
                legs_at(start, rates, t + h, legs)
                good = correct(legs, patch, trial, J, step, steady)
            if good:
                t = 1.0 if h >= 1.0 - t else t + h
                for c in range(8):
                    u[c] = trial[c]
                normalize(u)
                h *= 1.5
                if t == 1.0:
                    states[k] = ARRIVED
                    break
            else:
                h *= 0.4
                if h < SHORTEST:
                    break
        times[k] = t
