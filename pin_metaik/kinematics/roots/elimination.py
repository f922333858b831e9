"""Elimination: five of six joint values of a closed loop follow from the roots of one determinant in the sixth.

The loop is R_a B_a R_b B_b R_c B_c R_d B_d R_e B_e R_f B_f = 1 with joints R about or along z and links B, one of which
holds the target. Six places to begin and two directions make twelve of it. The axis of f, a line along d through p, is
seen from c in two ways, by (c, d, e) and by (a, b): 14 equations in d, p, p.p, p.d, p x d and (p.p) d - 2 (p.d) p. Such
functions of a line are mapped among themselves by every rigid motion, linear in (cos, sin, 1) of a turn and in (t^2, t,
1) of a slide: so samples at three values of each joint give all coefficients. Eliminating the 8 products of a and b
leaves 6 equations in the products of c, d and e. With x = tan(d / 2) and y = tan(e / 2), or d and e themselves where
they slide, and the equations once more times x, they are M(c) v = 0 for the 12 products v = x^i y^j: det M(c) is a
trigonometric polynomial of degree 8. Its 16 zeros z = exp(i c) come from 24 samples.

Raghavan and Roth, "Inverse kinematics of the general 6R manipulator and related linkages", J. Mechanical Design 115,
1993; Manocha and Canny, "Efficient inverse kinematics for general 6R manipulators", IEEE Trans. Robotics and
Automation 10, 1994, for the determinant; Aberth, "Iteration methods for finding all zeros of a polynomial
simultaneously", Math. Comp. 27, 1973.

A root is a place to start Newton's method from. Which of the twelve loops have their roots apart from each other, and
which none at all because axes meet or are parallel, is seen when they are tried.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple, TypeAlias

import numpy as np

from pin_metaik.compiled import Floats, Ints, allocating, inline, shared
from pin_metaik.kinematics.kernel.closed_form import Vector
from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, SCALE, SHIFT
from pin_metaik.kinematics.roots.complex_arm import WORLD, ComplexArm, Complexes, carried, linked, reciprocal

Line: TypeAlias = tuple[Vector, Vector]  # a direction along it, and a point on it
Motion: TypeAlias = tuple[float, float, float]  # cosine and sine of a turn, length of a slide

LOOPS = 12
SAMPLES, DEGREE, ROOTS = 24, 8, 16
LEFT, RIGHT, ALL = 8, 27, 36  # products of a and b but for 1; of c, d and e; columns of the equations
ITERATIONS, CONVERGED = 60, 1e-22  # of Aberth's; squared relative step
ON_CIRCLE = 1e-9  # of |z| = 1: a real root


class EliminationScratch(NamedTuple):
    """Where one loop is worked on.

    Attributes:
        links: (6, 12) B of each joint.
        turns: (6,) 1 if it turns.
        rows: (6,) its row of the arm's joints.
        equations: (14, 36) by products of a and b (8), unused (1), by products of c, d and e (27); then triangular.
        reduced: (3, 6, 3, 3) by (cos c, sin c, 1), equation, power of x, power of y.
        real: (12, 12) M(c) at a sample ...
        complex: (12, 12) ... and at a root.
        swaps: (12,) of its rows.
        values: (24,) of the determinant.
        series: (9,) its Fourier coefficients.
        zeros: (16,) z.
        null: (12,) v.
        products: (8,) of a and b.
    """

    links: Floats
    turns: Ints
    rows: Ints
    equations: Floats
    reduced: Floats
    real: Floats
    complex: Complexes
    swaps: Ints
    values: Floats
    series: Complexes
    zeros: Complexes
    null: Complexes
    products: Complexes


@allocating
def elimination_scratch() -> EliminationScratch:
    """Room for one loop."""
    return EliminationScratch(
        np.empty((6, 12)),
        np.empty(6, np.int64),
        np.empty(6, np.int64),
        np.empty((14, ALL)),
        np.empty((3, 6, 3, 3)),
        np.empty((12, 12)),
        np.empty((12, 12), np.complex128),
        np.empty(12, np.int64),
        np.empty(SAMPLES),
        np.empty(DEGREE + 1, np.complex128),
        np.empty(ROOTS, np.complex128),
        np.empty(12, np.complex128),
        np.empty(LEFT, np.complex128),
    )


@inline
def compose(A: Floats, B: Floats, out: Floats) -> None:
    """Pose (12,) A B."""
    for i in range(3):
        for j in range(3):
            out[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j]
        out[9 + i] = A[3 * i] * B[9] + A[3 * i + 1] * B[10] + A[3 * i + 2] * B[11] + A[9 + i]


@inline
def invert(A: Floats, out: Floats) -> None:
    """Pose (12,) A^-1."""
    for i in range(3):
        for j in range(3):
            out[3 * i + j] = A[3 * j + i]
        out[9 + i] = -(A[i] * A[9] + A[3 + i] * A[10] + A[6 + i] * A[11])


@shared
def lay_loop(arm: ComplexArm, target: Floats, number: int, work: EliminationScratch) -> None:
    """Links, turns and rows of one of the twelve loops: of the arm from joint ``number`` on, from 6 on backwards.

    Backwards every link is its inverse, seen after half a turn about x: so that joints move as they do forwards.
    """
    shift, backwards = number % 6, number >= 6
    for i in range(6):
        place = (i + shift) % 6
        at = (4 - place) % 6 if backwards else place  # B of joint ``at`` leads from it to the next one
        link = work.links[i]
        if at < 5:
            for k in range(12):
                link[k] = arm.joints[at + 1, k]
        else:
            a, b = work.values[:12], work.values[12:24]
            invert(target, a)
            compose(arm.tip, a, b)
            compose(b, arm.joints[0], link)
        if backwards:
            a = work.values[:12]
            invert(link, a)
            for k in range(12):
                link[k] = a[k]
            for k in (1, 2, 3, 6, 10, 11):
                link[k] = -link[k]
        row = 5 - place if backwards else place
        work.rows[i], work.turns[i] = row, arm.wiring[row, ROTATES]


@inline
def functions(line: Line, out: Floats, column: int) -> None:
    """The 14 functions of a line."""
    d, p = line
    pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    pl = p[0] * d[0] + p[1] * d[1] + p[2] * d[2]
    for i in range(3):
        out[i, column], out[3 + i, column] = d[i], p[i]
        out[11 + i, column] = pp * d[i] - 2.0 * pl * p[i]
    out[6, column], out[7, column] = pp, pl
    out[8, column] = p[1] * d[2] - p[2] * d[1]
    out[9, column] = p[2] * d[0] - p[0] * d[2]
    out[10, column] = p[0] * d[1] - p[1] * d[0]


@inline
def sample(turns: int, k: int) -> Motion:
    """What a joint does at its sample k: a turn by 0, 90 and 180 degrees, or a slide by -1, 0 and 1."""
    if turns == 1:
        return (1.0, 0.0, 0.0) if k == 0 else (0.0, 1.0, 0.0) if k == 1 else (-1.0, 0.0, 0.0)
    return 1.0, 0.0, k - 1.0


@inline
def moved(motion: Motion, line: Line) -> Line:
    """A line that a joint moves, seen from before the joint."""
    c, s, t = motion
    d, p = line
    return (c * d[0] - s * d[1], s * d[0] + c * d[1], d[2]), (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2] + t)


@inline
def moved_back(motion: Motion, line: Line) -> Line:
    """A line seen from behind a joint."""
    c, s, t = motion
    d, p = line
    return (c * d[0] + s * d[1], c * d[1] - s * d[0], d[2]), (c * p[0] + s * p[1], c * p[1] - s * p[0], p[2] - t)


@inline
def through(B: Floats, line: Line) -> Line:
    """A line behind a link, seen from before it."""
    d, p = line
    return (
        (
            B[0] * d[0] + B[1] * d[1] + B[2] * d[2],
            B[3] * d[0] + B[4] * d[1] + B[5] * d[2],
            B[6] * d[0] + B[7] * d[1] + B[8] * d[2],
        ),
        (
            B[0] * p[0] + B[1] * p[1] + B[2] * p[2] + B[9],
            B[3] * p[0] + B[4] * p[1] + B[5] * p[2] + B[10],
            B[6] * p[0] + B[7] * p[1] + B[8] * p[2] + B[11],
        ),
    )


@inline
def back_through(B: Floats, line: Line) -> Line:
    """A line before a link, seen from behind it."""
    d, p = line
    x, y, z = p[0] - B[9], p[1] - B[10], p[2] - B[11]
    return (
        (
            B[0] * d[0] + B[3] * d[1] + B[6] * d[2],
            B[1] * d[0] + B[4] * d[1] + B[7] * d[2],
            B[2] * d[0] + B[5] * d[1] + B[8] * d[2],
        ),
        (
            B[0] * x + B[3] * y + B[6] * z,
            B[1] * x + B[4] * y + B[7] * z,
            B[2] * x + B[5] * y + B[8] * z,
        ),
    )


@inline
def to_coefficients(X: Floats, first: int, count: int, stride: int, turns: int) -> None:
    """Samples of one joint, in ``count`` columns from the first on, to what multiplies (cos, sin, 1) or (t^2, t, 1)."""
    for r in range(14):
        for k in range(count):
            if (k // stride) % 3 == 0:
                i, j, m = first + k, first + k + stride, first + k + 2 * stride
                a, b, c = X[r, i], X[r, j], X[r, m]
                mean = 0.5 * (a + c)
                if turns == 1:
                    X[r, i], X[r, j], X[r, m] = 0.5 * (a - c), b - mean, mean
                else:
                    X[r, i], X[r, j], X[r, m] = mean - b, 0.5 * (c - a), b


@shared
def lay_equations(work: EliminationScratch) -> None:
    """The 14 equations: what a and b give is equal to what c, d and e give."""
    B, turns, X = work.links, work.turns, work.equations
    axis = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    behind_e = through(B[4], axis)
    before_a = back_through(B[5], axis)
    for i in range(3):
        behind_d = through(B[3], moved(sample(turns[4], i), behind_e))
        behind_a = back_through(B[0], moved_back(sample(turns[0], i), before_a))
        for j in range(3):
            behind_c = through(B[2], moved(sample(turns[3], j), behind_d))
            functions(back_through(B[1], moved_back(sample(turns[1], j), behind_a)), X, 3 * i + j)
            for k in range(3):
                functions(moved(sample(turns[2], k), behind_c), X, 9 + 9 * k + 3 * j + i)
    to_coefficients(X, 9, 27, 1, turns[4])
    to_coefficients(X, 9, 27, 3, turns[3])
    to_coefficients(X, 9, 27, 9, turns[2])
    to_coefficients(X, 0, 9, 1, turns[1])
    to_coefficients(X, 0, 9, 3, turns[0])
    for r in range(14):
        X[r, ALL - 1] -= X[r, LEFT]  # of a and b the product that is 1, to that of c, d and e


@shared
def eliminate(X: Floats) -> None:
    """Householder's triangle for the products of a and b; the last six equations are left without them."""
    for k in range(LEFT):
        square = 0.0
        for r in range(k, 14):
            square += X[r, k] * X[r, k]
        size = math.sqrt(square)
        if size < 1e-14:
            continue
        first = X[k, k] + math.copysign(size, X[k, k])
        factor = 1.0 / (size * (size + abs(X[k, k])))
        for j in range(k + 1, ALL):
            h = first * X[k, j]
            for r in range(k + 1, 14):
                h += X[r, k] * X[r, j]
            h *= factor
            X[k, j] -= h * first
            for r in range(k + 1, 14):
                X[r, j] -= h * X[r, k]
        X[k, k] = -math.copysign(size, X[k, k])


@inline
def by_powers(turns: int, a: float, b: float, c: float) -> Vector:
    """What multiplies 1, x and x^2, of what multiplies (cos, sin, 1), over 1 + x^2, or (t^2, t, 1)."""
    return (c + a, 2.0 * b, c - a) if turns == 1 else (c, b, a)


@shared
def reduce(work: EliminationScratch) -> None:
    """The six equations that are left by powers of x and y, each brought to one size."""
    X, G, turns = work.equations, work.reduced, work.turns
    for r in range(6):
        most = 0.0
        for c in range(3):
            for e in range(3):
                at = 9 + 9 * c + e
                X0, X1, X2 = X[LEFT + r, at], X[LEFT + r, at + 3], X[LEFT + r, at + 6]
                G[c, r, 0, e], G[c, r, 1, e], G[c, r, 2, e] = by_powers(turns[3], X0, X1, X2)
            for i in range(3):
                G0, G1, G2 = by_powers(turns[4], G[c, r, i, 0], G[c, r, i, 1], G[c, r, i, 2])
                G[c, r, i, 0], G[c, r, i, 1], G[c, r, i, 2] = G0, G1, G2
                most = max(most, abs(G0), abs(G1), abs(G2))
        if most > 0.0:
            for c in range(3):
                for i in range(3):
                    for j in range(3):
                        G[c, r, i, j] /= most


@inline
def lay_matrix(G: Floats, c: complex, s: complex, M: Complexes | Floats) -> None:
    """M (12, 12) at a cosine and a sine, real or complex."""
    for r in range(6):
        for k in range(3):
            M[r, 9 + k] = 0.0
            M[6 + r, k] = 0.0
            for i in range(3):
                v = c * G[0, r, i, k] + s * G[1, r, i, k] + G[2, r, i, k]
                M[r, 3 * i + k] = v
                M[6 + r, 3 * i + 3 + k] = v


@shared
def determinant(M: Floats) -> float:
    """Of M (12, 12), which is overwritten."""
    det = 1.0
    for k in range(12):
        pivot, largest = k, abs(M[k, k])
        for r in range(k + 1, 12):
            if abs(M[r, k]) > largest:
                pivot, largest = r, abs(M[r, k])
        if largest == 0.0:
            return 0.0
        if pivot != k:
            det = -det
            for j in range(k, 12):
                M[k, j], M[pivot, j] = M[pivot, j], M[k, j]
        det *= M[k, k]
        inverse = 1.0 / M[k, k]
        for r in range(k + 1, 12):
            if M[r, k] != 0.0:
                factor = M[r, k] * inverse
                for j in range(k + 1, 12):
                    M[r, j] -= factor * M[k, j]
    return det


@shared
def spectrum(work: EliminationScratch) -> bool:
    """Fourier coefficients of det M(c), greatest sample 1; False where it is zero throughout."""
    f, h = work.values, work.series
    most = 0.0
    for k in range(SAMPLES):
        c = 2.0 * math.pi * k / SAMPLES
        lay_matrix(work.reduced, math.cos(c), math.sin(c), work.real)
        f[k] = determinant(work.real)
        most = max(most, abs(f[k]))
    if not 0.0 < most < math.inf:
        return False
    for j in range(DEGREE + 1):
        h[j] = complex(0.0, 0.0)
        for k in range(SAMPLES):
            t = -2.0 * math.pi * ((j * k) % SAMPLES) / SAMPLES
            h[j] += f[k] / (most * SAMPLES) * complex(math.cos(t), math.sin(t))
    return True


@inline
def coefficient(h: Complexes, j: int) -> complex:
    """Of z^j of the polynomial of degree 16 that has the zeros of the trigonometric one."""
    return complex(h[j - DEGREE]) if j >= DEGREE else complex(h[DEGREE - j].conjugate())


@inline
def newton_step(h: Complexes, x: complex) -> complex:
    """p / p' at x; beyond the unit circle by the polynomial with its coefficients reversed."""
    n, derivative = ROOTS, complex(0.0, 0.0)
    if x.real * x.real + x.imag * x.imag <= 1.0:
        p = coefficient(h, n)
        for j in range(n - 1, -1, -1):
            derivative = derivative * x + p
            p = p * x + coefficient(h, j)
        return p * reciprocal(derivative) if derivative != 0.0 else complex(0.1, 0.0)
    y = reciprocal(x)
    p = coefficient(h, 0)
    for j in range(1, n + 1):
        derivative = derivative * y + p
        p = p * y + coefficient(h, j)
    rest = n * p - y * derivative
    return x * p * reciprocal(rest) if rest != 0.0 else complex(0.1, 0.0)


@shared
def aberth(h: Complexes, z: Complexes) -> None:
    """All zeros z (16,) at once; they come as z and 1 / conj(z)."""
    for k in range(ROOTS):
        t = 2.0 * math.pi * (k + 0.3) / ROOTS
        z[k] = (1.0 if k % 2 else 0.8) * complex(math.cos(t), math.sin(t))
    for _ in range(ITERATIONS):
        most = 0.0
        for k in range(ROOTS):
            x = complex(z[k])
            w = newton_step(h, x)
            pushed = complex(0.0, 0.0)
            for j in range(ROOTS):
                if j != k and z[j] != x:
                    pushed += reciprocal(x - z[j])
            q = 1.0 - w * pushed
            step = w * reciprocal(q) if q != 0.0 else w
            z[k] = x - step
            square = step.real * step.real + step.imag * step.imag
            most = max(most, square / max(x.real * x.real + x.imag * x.imag, 1e-6))
        if most < CONVERGED:
            break


@shared
def null_vector(M: Complexes, swaps: Ints, v: Complexes) -> None:
    """What M (12, 12) nearly maps to zero: two steps of inverse iteration. M is overwritten."""
    for k in range(12):
        pivot, largest = k, -1.0
        for r in range(k, 12):
            size = M[r, k].real * M[r, k].real + M[r, k].imag * M[r, k].imag
            if size > largest:
                pivot, largest = r, size
        swaps[k] = pivot
        if pivot != k:
            for j in range(12):
                M[k, j], M[pivot, j] = M[pivot, j], M[k, j]
        if largest < 1e-36:
            M[k, k] = complex(1e-18, 0.0)
        inverse = reciprocal(complex(M[k, k]))
        for r in range(k + 1, 12):
            if M[r, k] != 0.0:
                M[r, k] *= inverse
                for j in range(k + 1, 12):
                    M[r, j] -= M[r, k] * M[k, j]
    for i in range(12):
        v[i] = 1.0 + 0.1 * ((7 * i) % 5)
    for again in range(2):
        if again == 1:
            for k in range(12):
                v[k], v[swaps[k]] = v[swaps[k]], v[k]
                for r in range(k + 1, 12):
                    v[r] -= M[r, k] * v[k]
        largest = 0.0
        for k in range(11, -1, -1):
            for j in range(k + 1, 12):
                v[k] -= M[k, j] * v[j]
            v[k] *= reciprocal(complex(M[k, k]))
            largest = max(largest, abs(v[k].real), abs(v[k].imag))
        for k in range(12):
            v[k] *= 1.0 / largest


@inline
def angle_of(c: complex, s: complex) -> complex:
    """The complex angle with this cosine and sine."""
    u, w = c + 1j * s, c - 1j * s
    u_square, w_square = u.real * u.real + u.imag * u.imag, w.real * w.real + w.imag * w.imag
    if not u_square + w_square > 0.0:
        return complex(0.0, 0.0)
    return -1j * cmath.log(u) if u_square > w_square else 1j * cmath.log(w)


@inline
def value_of(turns: int, p: complex, q: complex) -> tuple[complex, complex, complex]:
    """A joint's value with x = p / q, and the two functions of it: cosine and sine, or square and value."""
    if turns == 1:
        n = reciprocal(p * p + q * q)
        c, s = (q * q - p * p) * n, 2.0 * p * q * n
        return angle_of(c, s), c, s
    t = p * reciprocal(q)
    return t, t * t, t


@shared
def values_of(z: complex, work: EliminationScratch, values: Complexes) -> None:
    """All six joint values, in the order of the loop, of a root z and its null vector."""
    v, X, turns, m = work.null, work.equations, work.turns, work.products
    k, largest = 0, -1.0
    for i in range(12):
        size = v[i].real * v[i].real + v[i].imag * v[i].imag
        if size > largest:
            k, largest = i, size
    p, q = (v[k], v[k - 3]) if k >= 3 else (v[k + 3], v[k])
    values[3], d0, d1 = value_of(turns[3], p, q)
    p, q = (v[k], v[k - 1]) if k % 3 > 0 else (v[k + 1], v[k])
    values[4], e0, e1 = value_of(turns[4], p, q)
    values[2] = -1j * cmath.log(z)
    c0, c1 = 0.5 * (z + reciprocal(z)), -0.5j * (z - reciprocal(z))
    for r in range(LEFT - 1, -1, -1):
        m[r] = complex(0.0, 0.0)
        for i in range(3):
            for j in range(3):
                at = 9 + 9 * i + 3 * j
                part = (e0 * X[r, at] + e1 * X[r, at + 1] + X[r, at + 2]) * (d0 if j == 0 else d1 if j == 1 else 1.0)
                m[r] += part * (c0 if i == 0 else c1 if i == 1 else 1.0)
        for j in range(r + 1, LEFT):
            m[r] -= X[r, j] * m[j]
        m[r] = m[r] * (1.0 / X[r, r]) if abs(X[r, r]) > 1e-12 else complex(0.0, 0.0)
    # The products are numbered 3 a + b, and the third function of each is 1.
    values[0] = angle_of(m[2], m[5]) if turns[0] == 1 else m[5]
    values[1] = angle_of(m[6], m[7]) if turns[1] == 1 else m[7]
    values[5] = last_value(work, values)


@inline
def last_value(work: EliminationScratch, values: Complexes) -> complex:
    """What the first five values leave to the last joint: R_f^-1 = B_f R_a B_a ... R_e B_e."""
    F = linked(WORLD, work.links[5])
    for s in range(5):
        F = linked(carried(F, work.turns[s], values[s]), work.links[s])
    return angle_of(0.5 * (F[0] + F[4]), 0.5 * (F[1] - F[3])) if work.turns[5] == 1 else -F[11]


@shared
def find_zeros(arm: ComplexArm, target: Floats, number: int, work: EliminationScratch) -> bool:
    """Write the zeros of one loop's determinant; False if it has none, as where its joint c slides."""
    lay_loop(arm, target, number, work)
    if work.turns[2] == 0:
        return False
    lay_equations(work)
    eliminate(work.equations)
    reduce(work)
    if not spectrum(work):
        return False
    aberth(work.series, work.zeros)
    return True


@shared
def coordinates_of(arm: ComplexArm, z: complex, work: EliminationScratch, values: Complexes, x: Complexes) -> bool:
    """Coordinates x (6,) of a zero; False if they are no numbers. ``values`` (6,) is room."""
    c, s = 0.5 * (z + reciprocal(z)), -0.5j * (z - reciprocal(z))
    if abs(z.real * z.real + z.imag * z.imag - 1.0) < ON_CIRCLE:
        c, s = complex(c.real, 0.0), complex(s.real, 0.0)
    lay_matrix(work.reduced, c, s, work.complex)
    null_vector(work.complex, work.swaps, work.null)
    values_of(z, work, values)
    finite = True
    for i in range(6):
        row = work.rows[i]
        value = (values[i] - arm.joints[row, SHIFT]) * (1.0 / arm.joints[row, SCALE])
        x[arm.wiring[row, COLUMN]] = value
        finite = finite and math.isfinite(value.real) and abs(value.imag) < 30.0
    return finite
