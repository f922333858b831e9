"""Following configurations of an arm while its pose moves from one where they are known to another.

The pose moves along a screw: T(s) = exp(s V) T(0), so that dx/ds = J(x)^-1 V with a twist V that does not change. In
complex numbers a screw drawn at random meets no singularity; then the configurations of one pose become those of the
other, each one of them (Sommese and Wampler 2005, 7.1).
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, jit, shared
from pin_metaik.kinematics.roots.complex_arm import (
    ComplexArm,
    Complexes,
    ComplexScratch,
    complex_scratch,
    cosine_sine,
    newton,
    place,
    reciprocal,
    solve_twists,
)
from pin_metaik.kinematics.roots.real import UNBOUNDED

STEADY = 1e-2  # rad or lengths: a step along a path that Newton's method corrects by more is taken shorter
ON_PATH, EXACT = 1e-6, 1e-12  # last correction on the way, and at its end
FIRST, SHORTEST = 0.05, 1e-7  # steps in s; one shorter ends a path in a singularity, or at infinity
STEPS = 400
STAGES, LAST = 4, 6  # evaluations of a step, and at most to correct the last one
STEP = STAGES + LAST


class PathScratch(NamedTuple):
    """Where one path is followed.

    Attributes:
        twist: (6,) V of the screw.
        target: (12,) the pose at s.
        trial: (6,) the end of a step.
        slopes: (4, 6) dx/ds at the four places of a step.
    """

    twist: Complexes
    target: Complexes
    trial: Complexes
    slopes: Complexes


@allocating
def path_scratch() -> PathScratch:
    """Room for one path."""
    c = np.complex128
    return PathScratch(np.empty(6, c), np.empty(12, c), np.empty(6, c), np.empty((4, 6), c))


@inline
def series(t: complex) -> tuple[complex, complex, complex]:
    """sin t / t, (1 - cos t) / t^2 and (t - sin t) / t^3."""
    z = t * t
    if abs(z.real) + abs(z.imag) < 1e-4:
        return (
            1.0 - z / 6.0 * (1.0 - z / 20.0),
            0.5 - z / 24.0 * (1.0 - z / 30.0),
            1.0 / 6.0 - z / 120.0 * (1.0 - z / 42.0),
        )
    cos, sin = cosine_sine(t)
    A, inverse = sin * reciprocal(t), reciprocal(z)
    return A, (1.0 - cos) * inverse, (1.0 - A) * inverse


@shared
def screw_between(start: Complexes, end: Complexes, twist: Complexes) -> None:
    """The twist V (6,) with exp(V) start = end, both poses (12,)."""
    S, E = start, end
    a, b = E[0] * S[0] + E[1] * S[1] + E[2] * S[2], E[0] * S[3] + E[1] * S[4] + E[2] * S[5]
    c = E[0] * S[6] + E[1] * S[7] + E[2] * S[8]
    d, e = E[3] * S[0] + E[4] * S[1] + E[5] * S[2], E[3] * S[3] + E[4] * S[4] + E[5] * S[5]
    f = E[3] * S[6] + E[4] * S[7] + E[5] * S[8]
    g, h = E[6] * S[0] + E[7] * S[1] + E[8] * S[2], E[6] * S[3] + E[7] * S[4] + E[8] * S[5]
    i = E[6] * S[6] + E[7] * S[7] + E[8] * S[8]
    t = cmath.acos(0.5 * (a + e + i - 1.0))
    A, B, _ = series(t)
    half = 0.5 * reciprocal(A)
    wx, wy, wz = half * (h - f), half * (c - g), half * (d - b)
    px = E[9] - (a * S[9] + b * S[10] + c * S[11])
    py = E[10] - (d * S[9] + e * S[10] + f * S[11])
    pz = E[11] - (g * S[9] + h * S[10] + i * S[11])
    # The inverse of what takes v to the translation of exp(V): 1 - w / 2 + (1 - A / 2B) / t^2 w^2.
    z = t * t
    K = (1.0 - 0.5 * A * reciprocal(B)) * reciprocal(z) if abs(z.real) + abs(z.imag) > 1e-4 else 1.0 / 12.0 + z / 720.0
    cx, cy, cz = wy * pz - wz * py, wz * px - wx * pz, wx * py - wy * px
    twist[0] = px - 0.5 * cx + K * (wy * cz - wz * cy)
    twist[1] = py - 0.5 * cy + K * (wz * cx - wx * cz)
    twist[2] = pz - 0.5 * cz + K * (wx * cy - wy * cx)
    twist[3], twist[4], twist[5] = wx, wy, wz


@shared
def screwed(twist: Complexes, s: float, start: Complexes, out: Complexes) -> None:
    """The pose (12,) exp(s V) start."""
    vx, vy, vz, wx, wy, wz = s * twist[0], s * twist[1], s * twist[2], s * twist[3], s * twist[4], s * twist[5]
    A, B, C = series(cmath.sqrt(wx * wx + wy * wy + wz * wz))
    xx, yy, zz, xy, xz, yz = wx * wx, wy * wy, wz * wz, wx * wy, wx * wz, wy * wz
    R00, R01, R02 = 1.0 - B * (yy + zz), B * xy - A * wz, B * xz + A * wy
    R10, R11, R12 = B * xy + A * wz, 1.0 - B * (xx + zz), B * yz - A * wx
    R20, R21, R22 = B * xz - A * wy, B * yz + A * wx, 1.0 - B * (xx + yy)
    cx, cy, cz = wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx
    for k in range(4):
        a, b, c = (start[k], start[3 + k], start[6 + k]) if k < 3 else (start[9], start[10], start[11])
        x, y, z = R00 * a + R01 * b + R02 * c, R10 * a + R11 * b + R12 * c, R20 * a + R21 * b + R22 * c
        if k < 3:
            out[k], out[3 + k], out[6 + k] = x, y, z
        else:
            out[9] = x + vx + B * cx + C * (wy * cz - wz * cy)
            out[10] = y + vy + B * cy + C * (wz * cx - wx * cz)
            out[11] = z + vz + B * cz + C * (wx * cy - wy * cx)


@inline
def rate(arm: ComplexArm, x: Complexes, twist: Complexes, out: Complexes, work: ComplexScratch) -> bool:
    """dx/ds (6,) at x; False in a singularity."""
    place(arm, x, work)
    for r in range(6):
        work.twists[r, 6] = twist[r]
    regular = solve_twists(work.twists)
    for c in range(6):
        out[c] = work.twists[c, 6]
    return regular


@shared
def follow(
    arm: ComplexArm, start: Complexes, x: Complexes, path: PathScratch, most: int, work: ComplexScratch
) -> tuple[float, int]:
    """Follow x (6,) in place from the pose ``start`` (12,) along the path's twist, as far as it leads.

    It ends early where another step might take more than ``most`` evaluations in all.

    Returns s there, which is 1 at the end, and evaluations. Steps are those of Runge and Kutta, each put back onto the
    path by Newton's method.
    """
    twist, target, trial, slopes = path.twist, path.target, path.trial, path.slopes
    s, h, spent = 0.0, FIRST, 0
    for _ in range(STEPS):
        if spent + STEP > most:
            break
        last_step = h >= 1.0 - s
        h = 1.0 - s if last_step else h
        regular = rate(arm, x, twist, slopes[0], work)
        for stage in range(1, 4):
            share = h if stage == 3 else 0.5 * h
            for c in range(6):
                trial[c] = x[c] + share * slopes[stage - 1, c]
            regular = regular and rate(arm, trial, twist, slopes[stage], work)
        spent += STAGES
        first = last = math.inf
        if regular:
            for c in range(6):
                trial[c] = x[c] + h / 6.0 * (slopes[0, c] + 2.0 * slopes[1, c] + 2.0 * slopes[2, c] + slopes[3, c])
            screwed(twist, s + h, start, target)
            first, last, more = newton(
                arm, target, trial, LAST if last_step else 3, EXACT if last_step else ON_PATH, work
            )
            spent += more
        if first < STEADY and last < ON_PATH:
            for c in range(6):
                x[c] = trial[c]
            if last_step:
                return 1.0, spent
            s += h
            h *= min(3.0, max(0.5, 0.8 * (STEADY / max(first, 1e-9)) ** 0.25))
        else:
            h *= 0.3
            if h < SHORTEST:
                break
    return s, spent


@shared
def follow_each(
    arm: ComplexArm,
    start: Complexes,
    end: Complexes,
    points: Complexes,
    arrived: Ints,
    path: PathScratch,
    most: int,
    work: ComplexScratch,
) -> int:
    """``follow_all`` in room that was made for it, within ``most`` evaluations."""
    spent = 0
    screw_between(start, end, path.twist)
    for k in range(points.shape[0]):
        s, more = follow(arm, start, points[k], path, most - spent, work)
        arrived[k] = 1 if s == 1.0 else 0
        spent += more
    return spent


@jit("i8(f8[:,::1], i8[:,::1], f8[::1], i8[::1], c16[::1], c16[::1], c16[:,::1], i8[::1])")
def follow_all(
    joints: Floats,
    wiring: Ints,
    tip: Floats,
    periodic: Ints,
    start: Complexes,
    end: Complexes,
    points: Complexes,
    arrived: Ints,
) -> int:
    """Follow configurations (k, 6) in place from the pose ``start`` (12,) to ``end``; ``arrived`` (k,) gets 1 or 0.

    Returns the evaluations.
    """
    arm = ComplexArm(joints, wiring, tip, periodic)
    return follow_each(arm, start, end, points, arrived, path_scratch(), UNBOUNDED, complex_scratch())
