"""The compiled loops: poses judged against the limits and measured, and distances between legs.

Arrays every kernel takes (made by ``Geometry`` and its limits; n legs):

* ``base``, ``platform_anchors`` (n, 3): b_i in the base frame, m_i in the platform frame.
* ``joint_axes`` (2, n, 3): unit axes of the base joints (base frame) and of the platform joints (platform frame).
* ``servos`` (n, 15): what moves the legs, see ``closing``; None for slides. With servos, links are rods that begin at
  the tips of horns, and so do the axes of their joints.
* ``limits`` (5,): shortest and longest leg, cosine of the largest angle at the base and at the platform joint, least
  distance between legs; -1 is no limit on an angle, 0 none on the distance.
* ``pairs`` (p, 2): legs that share no joint.
* ``scale``: characteristic length L. ``norm``: 0 the weighted Frobenius norm, 1 the 2-norm.

A pose's ``state`` is a number of ``PoseState``; its ``nu`` is 1 / kappa, in 0 ... 1, and 0 where it is singular.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit, separate, shared
from pin_metaik.stewart.kernels.closing import close

SINGULAR = 1e-9
"""Below this nu a pose is singular: rounding leaves 1e-16, designs worth building have more than 1e-3."""

# PoseState, and what happens after the limits are met
POSITIVE, NEGATIVE, DEGENERATE = 1, 2, 3
TOO_SHORT, TOO_LONG, BASE_ANGLE, PLATFORM_ANGLE, TOO_CLOSE = 4, 5, 6, 7, 8

SWEEPS = 30  # of the Jacobi rotations; six are usual
ORTHOGONAL = 1e-15


@shared
def reflect(J: Floats, diagonal: Floats) -> float:
    """Turn J (n, 6) into L Q in place by Householder reflections; return the sign of det J (n = 6), 0 if it is 0.

    Afterwards ``diagonal`` and the entries left of it hold L, the rows from the diagonal on the vectors of the
    reflections.
    """
    n = J.shape[0]
    sign: float = 1.0
    for k in range(n):
        square = 0.0
        for c in range(k, 6):
            square += J[k, c] * J[k, c]
        norm = math.sqrt(square)
        if norm == 0.0:
            diagonal[k] = 0.0
            sign = 0.0
            continue
        alpha = norm if J[k, k] < 0.0 else -norm
        if alpha > 0.0:
            sign = -sign
        J[k, k] -= alpha
        weight = 1.0 / (norm * abs(J[k, k]))  # 2 / v'v
        for i in range(k + 1, n):
            dot = 0.0
            for c in range(k, 6):
                dot += J[i, c] * J[k, c]
            dot *= weight
            for c in range(k, 6):
                J[i, c] -= dot * J[k, c]
        diagonal[k] = alpha
    return sign


@inline
def frobenius(J: Floats, diagonal: Floats, column: Floats) -> float:
    """nu = n / sqrt(tr(J J') tr((J J')^-1)), Eq. 8-9 with n = I / 6, from L."""
    n = J.shape[0]
    direct, inverse, least = 0.0, 0.0, math.inf
    for i in range(n):
        direct += diagonal[i] * diagonal[i]
        least = min(least, abs(diagonal[i]))
        for j in range(i):
            direct += J[i, j] * J[i, j]
    if least * n < SINGULAR * math.sqrt(direct) or direct == 0.0:
        return 0.0
    for j in range(n):  # columns of L^-1
        column[j] = 1.0 / diagonal[j]
        inverse += column[j] * column[j]
        for i in range(j + 1, n):
            total = 0.0
            for k in range(j, i):
                total += J[i, k] * column[k]
            column[i] = -total / diagonal[i]
            inverse += column[i] * column[i]
    return float(n / math.sqrt(direct * inverse))


@inline
def spectral(J: Floats, diagonal: Floats, W: Floats) -> float:
    """nu = smallest by largest singular value of L: its rows are rotated pairwise until they are orthogonal."""
    n = J.shape[0]
    for i in range(n):
        for j in range(n):
            W[i, j] = J[i, j] if j < i else diagonal[i] if i == j else 0.0
    for _ in range(SWEEPS):
        rotated = False
        for p in range(n - 1):
            for q in range(p + 1, n):
                a, b, c = 0.0, 0.0, 0.0
                for k in range(n):
                    a += W[p, k] * W[p, k]
                    b += W[q, k] * W[q, k]
                    c += W[p, k] * W[q, k]
                if abs(c) <= ORTHOGONAL * math.sqrt(a * b):
                    continue
                rotated = True
                zeta = (b - a) / (2.0 * c)
                t = math.copysign(1.0, zeta) / (abs(zeta) + math.sqrt(1.0 + zeta * zeta))
                cos = 1.0 / math.sqrt(1.0 + t * t)
                sin = cos * t
                for k in range(n):
                    x, y = W[p, k], W[q, k]
                    W[p, k] = cos * x - sin * y
                    W[q, k] = sin * x + cos * y
        if not rotated:
            break
    least, most = math.inf, 0.0
    for p in range(n):
        square = 0.0
        for k in range(n):
            square += W[p, k] * W[p, k]
        least, most = min(least, square), max(most, square)
    return math.sqrt(least / most) if most > 0.0 else 0.0


@separate
def measure(
    legs: Floats, divisors: Floats, turned: Floats, scale: float, norm: int, work: Floats
) -> tuple[float, float]:
    """The nu of a pose and the sign of det J, from its links (n, 3), what they are divided by and R m_i (n, 3).

    Divided by its length a link becomes the row of a slide; see ``closing`` for that of a servo.
    ``work`` is (2 n + 2, 6): room for J, a diagonal, a column and the rotated rows.
    """
    n = legs.shape[0]
    J, diagonal, column = work[:n], work[n], work[n + 1]
    for i in range(n):
        shrink = 1.0 / divisors[i] if divisors[i] > 0.0 else 0.0  # a leg of no length has no direction
        zx, zy, zz = shrink * legs[i, 0], shrink * legs[i, 1], shrink * legs[i, 2]
        x, y, z = turned[i, 0] / scale, turned[i, 1] / scale, turned[i, 2] / scale
        J[i, 0], J[i, 1], J[i, 2] = zx, zy, zz
        J[i, 3], J[i, 4], J[i, 5] = y * zz - z * zy, z * zx - x * zz, x * zy - y * zx  # R m x z
    sign = reflect(J, diagonal) if n == 6 else max(abs(reflect(J, diagonal)), 1.0)  # fewer legs have no det
    nu = frobenius(J, diagonal, column) if norm == 0 else spectral(J, diagonal, work[n + 2 :])
    return (nu, sign) if nu >= SINGULAR else (0.0, sign)


@shared
def segment_distance(b: Floats, v: Floats, i: int, j: int) -> float:
    """Least distance between the segments b_i + s v_i and b_j + t v_j, 0 <= s, t <= 1 (Ericson 2005, 5.1.9)."""
    rx, ry, rz = b[i, 0] - b[j, 0], b[i, 1] - b[j, 1], b[i, 2] - b[j, 2]
    a = v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1] + v[i, 2] * v[i, 2]
    e = v[j, 0] * v[j, 0] + v[j, 1] * v[j, 1] + v[j, 2] * v[j, 2]
    d = v[i, 0] * v[j, 0] + v[i, 1] * v[j, 1] + v[i, 2] * v[j, 2]
    c = v[i, 0] * rx + v[i, 1] * ry + v[i, 2] * rz
    f = v[j, 0] * rx + v[j, 1] * ry + v[j, 2] * rz
    least = math.inf
    # Inside both, then each end of one against the other: parallel legs are nearest at an end.
    for case in range(5):
        s, t = 0.0, 0.0
        if case == 0:
            denominator = a * e - d * d
            if denominator <= 1e-14 * a * e:
                continue
            s, t = (d * f - c * e) / denominator, (a * f - d * c) / denominator
            if s < 0.0 or s > 1.0 or t < 0.0 or t > 1.0:
                continue
        elif case <= 2:
            s = case - 1.0
            t = min(max((d * s + f) / e, 0.0), 1.0) if e > 0.0 else 0.0
        else:
            t = case - 3.0
            s = min(max((d * t - c) / a, 0.0), 1.0) if a > 0.0 else 0.0
        x = rx + s * v[i, 0] - t * v[j, 0]
        y = ry + s * v[i, 1] - t * v[j, 1]
        z = rz + s * v[i, 2] - t * v[j, 2]
        least = min(least, x * x + y * y + z * z)
        if case == 0:
            break
    return math.sqrt(least)


@shared
def judge(
    base: Floats,
    turned: Floats,
    joint_axes: Floats,
    turned_joint_axes: Floats,
    limits: Floats,
    pairs: Ints,
    legs: Floats,
    lengths: Floats,
    divisors: Floats,
    scale: float,
    norm: int,
    work: Floats,
) -> tuple[int, float]:
    """State and nu of a pose that the legs can reach; the state names the first limit that is not met.

    ``base`` and ``joint_axes`` (n, 3) are where the links begin and the axes of their joints there.
    """
    if limits[2] > -1.0 or limits[3] > -1.0:
        for i in range(base.shape[0]):
            low, high = 0.0, 0.0
            for c in range(3):
                low += legs[i, c] * joint_axes[i, c]
                high -= legs[i, c] * turned_joint_axes[i, c]
            if low < limits[2] * lengths[i]:
                return BASE_ANGLE, 0.0
            if high < limits[3] * lengths[i]:
                return PLATFORM_ANGLE, 0.0
    if limits[4] > 0.0:
        for p in range(pairs.shape[0]):
            if segment_distance(base, legs, pairs[p, 0], pairs[p, 1]) < limits[4]:
                return TOO_CLOSE, 0.0
    nu, sign = measure(legs, divisors, turned, scale, norm, work)
    return (DEGENERATE, 0.0) if nu == 0.0 else (POSITIVE if sign > 0.0 else NEGATIVE, nu)


@inline
def reach(
    base: Floats,
    joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    legs: Floats,
    starts: Floats,
    axes: Floats,
    lengths: Floats,
    divisors: Floats,
) -> int:
    """State of a pose by its legs (n, 3) alone; if they reach, then the links and all that ``judge`` wants."""
    for i in range(base.shape[0]):
        if servos is None:
            square = legs[i, 0] * legs[i, 0] + legs[i, 1] * legs[i, 1] + legs[i, 2] * legs[i, 2]
            lengths[i] = math.sqrt(square)
            if lengths[i] < limits[0]:
                return TOO_SHORT
            if lengths[i] > limits[1]:
                return TOO_LONG
        else:
            state = close(i, base, servos, joint_axes, legs, starts, axes, lengths, divisors)
            if state != POSITIVE:
                return state
    return POSITIVE


@jit(
    "void(f8[:,::1], f8[:,:,::1], f8[:,:,::1], f8[:,:,::1], f8[::1], f8[:,::1]?, i8[:,::1], f8[::1], f8[::1], f8[::1],"
    " f8, i8, i1[:,:,:,::1], f8[:,:,:,::1])"
)
def survey(
    base: Floats,
    turned: Floats,
    joint_axes: Floats,
    turned_joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    pairs: Ints,
    xs: Floats,
    ys: Floats,
    zs: Floats,
    scale: float,
    norm: int,
    states: Ints,
    nus: Floats,
) -> None:
    """States and nu (x, y, z, o) over a grid of positions, in o orientations.

    ``turned`` (o, n, 3) is R m_i, ``turned_sockets`` (o, n, 3) the axes of the platform joints turned likewise. Most
    positions fail at the first legs, and with slides cost 10 ns: the squares along x and y are summed once a column.
    """
    n = base.shape[0]
    legs, lengths, across, work = np.empty((n, 3)), np.empty(n), np.empty(n), np.empty((2 * n + 2, 6))
    starts, axes, divisors = base, joint_axes[0], lengths
    if servos is not None:
        starts, axes, divisors = np.empty((n, 3)), np.empty((n, 3)), np.empty(n)
    shortest, longest = limits[0] * limits[0], limits[1] * limits[1]
    for ix in range(xs.shape[0]):
        for iy in range(ys.shape[0]):
            for o in range(turned.shape[0]):
                for i in range(n):
                    legs[i, 0] = xs[ix] + turned[o, i, 0] - base[i, 0]
                    legs[i, 1] = ys[iy] + turned[o, i, 1] - base[i, 1]
                    across[i] = legs[i, 0] * legs[i, 0] + legs[i, 1] * legs[i, 1]
                for iz in range(zs.shape[0]):
                    state, nu = POSITIVE, 0.0
                    if servos is None:
                        for i in range(n):
                            legs[i, 2] = zs[iz] + turned[o, i, 2] - base[i, 2]
                            lengths[i] = across[i] + legs[i, 2] * legs[i, 2]
                            if lengths[i] < shortest:
                                state = TOO_SHORT
                                break
                            if lengths[i] > longest:
                                state = TOO_LONG
                                break
                        if state == POSITIVE:
                            for i in range(n):
                                lengths[i] = math.sqrt(lengths[i])
                    else:
                        for i in range(n):
                            legs[i, 0] = xs[ix] + turned[o, i, 0] - base[i, 0]
                            legs[i, 1] = ys[iy] + turned[o, i, 1] - base[i, 1]
                            legs[i, 2] = zs[iz] + turned[o, i, 2] - base[i, 2]
                        state = reach(base, joint_axes[0], limits, servos, legs, starts, axes, lengths, divisors)
                    if state == POSITIVE:
                        state, nu = judge(
                            starts,
                            turned[o],
                            axes,
                            turned_joint_axes[o],
                            limits,
                            pairs,
                            legs,
                            lengths,
                            divisors,
                            scale,
                            norm,
                            work,
                        )
                    states[ix, iy, iz, o], nus[ix, iy, iz, o] = state, nu


@inline
def turn(pose: Floats, points: Floats, out: Floats) -> None:
    """R p for points (n, 3)."""
    for i in range(points.shape[0]):
        for r in range(3):
            out[i, r] = pose[r, 0] * points[i, 0] + pose[r, 1] * points[i, 1] + pose[r, 2] * points[i, 2]


@jit("void(f8[:,::1], f8[:,::1], f8[:,:,::1], f8[::1], f8[:,::1]?, i8[:,::1], f8[:,:,::1], f8, i8, i1[::1], f8[::1])")
def judge_poses(
    base: Floats,
    platform_anchors: Floats,
    joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    pairs: Ints,
    poses: Floats,
    scale: float,
    norm: int,
    states: Ints,
    nus: Floats,
) -> None:
    """States and nu (k,) of poses (k, 4, 4)."""
    n = base.shape[0]
    legs, lengths, work = np.empty((n, 3)), np.empty(n), np.empty((2 * n + 2, 6))
    turned, turned_joint_axes = np.empty((n, 3)), np.empty((n, 3))
    starts, axes, divisors = base, joint_axes[0], lengths
    if servos is not None:
        starts, axes, divisors = np.empty((n, 3)), np.empty((n, 3)), np.empty(n)
    for k in range(poses.shape[0]):
        turn(poses[k], platform_anchors, turned)
        turn(poses[k], joint_axes[1], turned_joint_axes)
        for i in range(n):
            for c in range(3):
                legs[i, c] = poses[k, c, 3] + turned[i, c] - base[i, c]
        nus[k] = 0.0
        states[k] = reach(base, joint_axes[0], limits, servos, legs, starts, axes, lengths, divisors)
        if states[k] == POSITIVE:
            states[k], nus[k] = judge(
                starts, turned, axes, turned_joint_axes, limits, pairs, legs, lengths, divisors, scale, norm, work
            )


@jit("void(f8[:,::1], f8[:,::1], f8[:,:,::1], f8[::1], f8[:,::1]?, i8[:,::1], f8[:,:,::1], f8[:,::1])")
def distances(
    base: Floats,
    platform_anchors: Floats,
    joint_axes: Floats,
    limits: Floats,
    servos: Floats | None,
    pairs: Ints,
    poses: Floats,
    out: Floats,
) -> None:
    """Distances (k, p) between the axes of pairs of links (p, 2) at poses (k, 4, 4); NaN where a rod does not reach."""
    n = base.shape[0]
    legs, lengths = np.empty((n, 3)), np.empty(n)
    starts, axes, divisors = base, joint_axes[0], lengths
    if servos is not None:
        starts, axes, divisors = np.empty((n, 3)), np.empty((n, 3)), np.empty(n)
    for k in range(poses.shape[0]):
        turn(poses[k], platform_anchors, legs)
        for i in range(n):
            for c in range(3):
                legs[i, c] += poses[k, c, 3] - base[i, c]
        reached = reach(base, joint_axes[0], limits, servos, legs, starts, axes, lengths, divisors) == POSITIVE
        for p in range(pairs.shape[0]):
            out[k, p] = segment_distance(starts, legs, pairs[p, 0], pairs[p, 1]) if reached else math.nan
