"""The compiled loops over populations, and what they are made of: forward kinematics, errors and their Jacobian.

Compiling a single forward kinematics gains nothing over Pinocchio (0.8 us); compiling whole loops does, because the
call from Python (1-3 us) is then paid once.

Arrays every kernel takes (made by ``Chain`` and ``IKProblem``; S joints on all paths, T tips, n coordinates):

* ``joints`` (S, 14): placement of the joint frame, turned so that its axis is z, in the joint frame before it (rotation
  row by row, then translation), then the scale and shift of its coordinate: angle or travel = scale x + shift.
* ``wiring`` (S, 2): column of x that the joint follows, and 1 if it rotates, 0 if it slides.
* ``ends`` (T + 1,): joints ``ends[t]:ends[t + 1]`` lead from the world to tip t; paths may share columns.
* ``tips`` (T, 12): placement of each tip in its last joint frame.
* ``tasks`` (T, 26): the world in the target frame (12), slack per axis (6), weight per axis (6), tolerances (m, rad).
  Where the slack of position or of orientation is below 0, it is minus the radius of a ball for the three axes at once.
* ``rows`` (m, 2): which (tip, axis) pairs count: slack finite.

Seen from the target frame, a solved tip stands at the identity: position error p, orientation error log(R), and no
target left to subtract. ``x`` is (n,), a population ``X`` is (k, n).
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, Singles, exact, inline, jit, shared

TURN = 2.0 * np.pi
PATHS = "f8[:,::1], i8[:,::1], i8[::1], f8[:,::1]"  # joints, wiring, ends, tips


@inline
def copy(source: Floats | Singles, target: Floats) -> None:
    """Copy (n,) numbers; an assignment of slices compiles for two seconds longer, for the message it might raise."""
    for i in range(target.shape[0]):
        target[i] = source[i]


@inline
def nearest_turn(x: float, x0: float, lower: float, upper: float) -> float:
    """The angle moved by the whole turns that bring it nearest to x0 between the bounds; below them if none does."""
    turns = np.round((x0 - x) / TURN)
    turns = min(max(turns, np.ceil((lower - x) / TURN)), np.floor((upper - x) / TURN))
    return float(x + TURN * turns)


@exact
def cos_sin(x: float) -> tuple[float, float]:
    """Cosine and sine to 2e-16 for |x| < 1e5: Cody-Waite reduction, minimax polynomials; half the time of libm's."""
    k = np.floor(x * 0.63661977236758134308 + 0.5)
    r = (x - k * 1.5707963267341256) - k * 6.0771005065061922e-11
    z = r * r
    s = z * (2.75573136213857245213e-6 + z * (-2.50507477628578072866e-8 + z * 1.58962301576546568060e-10))
    s = r + r * z * (
        -1.66666666666666307295e-1 + z * (8.33333333332211858878e-3 + z * (-1.98412698295895385996e-4 + s))
    )
    c = z * (-2.75573141792967388112e-7 + z * (2.08757008419747316778e-9 + z * -1.13585365213876817300e-11))
    c = z * (-1.38888888888730564116e-3 + z * (2.48015872888517045348e-5 + c))
    c = 1.0 - 0.5 * z + z * z * (4.16666666666665929218e-2 + c)
    quarter = np.int64(k) & 3
    if quarter & 1:
        s, c = c, s
    if quarter & 2:
        s = -s
    if (quarter + 1) & 2:
        c = -c
    return c, s


@shared
def forward(
    joints: Floats,
    wiring: Ints,
    first: int,
    last: int,
    tip: Floats,
    start: Floats,
    x: Floats,
    axes: Floats,
    origins: Floats,
    pose: Floats,
) -> None:
    """Pose (12,) of one tip, and axis and origin (S, 3) of each joint on its path, in the frame of ``start``."""
    a, b, c, d, e, f, g, h, i = start[0], start[1], start[2], start[3], start[4], start[5], start[6], start[7], start[8]
    px, py, pz = start[9], start[10], start[11]
    for s in range(first, last):
        P = joints[s]
        px += a * P[9] + b * P[10] + c * P[11]
        py += d * P[9] + e * P[10] + f * P[11]
        pz += g * P[9] + h * P[10] + i * P[11]
        ux, vx, c = a * P[0] + b * P[3] + c * P[6], a * P[1] + b * P[4] + c * P[7], a * P[2] + b * P[5] + c * P[8]
        uy, vy, f = d * P[0] + e * P[3] + f * P[6], d * P[1] + e * P[4] + f * P[7], d * P[2] + e * P[5] + f * P[8]
        uz, vz, i = g * P[0] + h * P[3] + i * P[6], g * P[1] + h * P[4] + i * P[7], g * P[2] + h * P[5] + i * P[8]
        axes[s, 0], axes[s, 1], axes[s, 2] = c, f, i
        origins[s, 0], origins[s, 1], origins[s, 2] = px, py, pz
        value = P[12] * x[wiring[s, 0]] + P[13]
        if wiring[s, 1] == 1:
            cos, sin = cos_sin(value)
            a, b = cos * ux + sin * vx, cos * vx - sin * ux
            d, e = cos * uy + sin * vy, cos * vy - sin * uy
            g, h = cos * uz + sin * vz, cos * vz - sin * uz
        else:
            a, b, d, e, g, h = ux, vx, uy, vy, uz, vz
            px, py, pz = px + value * c, py + value * f, pz + value * i
    P = tip
    pose[0], pose[1], pose[2] = (
        a * P[0] + b * P[3] + c * P[6],
        a * P[1] + b * P[4] + c * P[7],
        a * P[2] + b * P[5] + c * P[8],
    )
    pose[3], pose[4], pose[5] = (
        d * P[0] + e * P[3] + f * P[6],
        d * P[1] + e * P[4] + f * P[7],
        d * P[2] + e * P[5] + f * P[8],
    )
    pose[6], pose[7], pose[8] = (
        g * P[0] + h * P[3] + i * P[6],
        g * P[1] + h * P[4] + i * P[7],
        g * P[2] + h * P[5] + i * P[8],
    )
    pose[9] = px + a * P[9] + b * P[10] + c * P[11]
    pose[10] = py + d * P[9] + e * P[10] + f * P[11]
    pose[11] = pz + g * P[9] + h * P[10] + i * P[11]


@shared
def pose_error(pose: Floats, error: Floats) -> None:
    """Translation and rotation vector (6,) of a pose; exact near 0 and, through the symmetric part, near pi."""
    error[0], error[1], error[2] = pose[9], pose[10], pose[11]
    wx, wy, wz = 0.5 * (pose[7] - pose[5]), 0.5 * (pose[2] - pose[6]), 0.5 * (pose[3] - pose[1])
    sin = math.sqrt(wx * wx + wy * wy + wz * wz)
    cos = 0.5 * (pose[0] + pose[4] + pose[8] - 1.0)
    angle = math.atan2(sin, cos)
    if sin > 1e-4 or cos > 0.0:
        scale = angle / sin if sin > 1e-8 else 1.0
        error[3], error[4], error[5] = scale * wx, scale * wy, scale * wz
        return
    # Near pi: R + R' + (1 - tr R) I = 2 (1 - cos) n n'; take its largest column, signed by the skew part.
    t = 1.0 - (pose[0] + pose[4] + pose[8])
    nx, ny, nz = 2.0 * pose[0] + t, pose[1] + pose[3], pose[2] + pose[6]
    if pose[4] > pose[0] and pose[4] >= pose[8]:
        nx, ny, nz = pose[1] + pose[3], 2.0 * pose[4] + t, pose[5] + pose[7]
    elif pose[8] > pose[0]:
        nx, ny, nz = pose[2] + pose[6], pose[5] + pose[7], 2.0 * pose[8] + t
    scale = angle / math.sqrt(nx * nx + ny * ny + nz * nz)
    if nx * wx + ny * wy + nz * wz < 0.0:
        scale = -scale
    error[3], error[4], error[5] = scale * nx, scale * ny, scale * nz


@inline
def residual(task: Floats, error: Floats, r: Floats) -> tuple[float, float]:
    """Weighted error beyond the slack, r (6,); returns the squares of its size in m and in rad, unweighted."""
    position = orientation = 0.0
    for j in range(6):
        slack = task[12 + j]
        beyond = max(error[j] - slack, 0.0) + min(error[j] + slack, 0.0)
        if j < 3:
            position += beyond * beyond
        else:
            orientation += beyond * beyond
        r[j] = task[18 + j] * beyond
    return position, orientation


@shared
def beyond_ball(task: Floats, error: Floats, part: int, r: Floats, J: Floats) -> float:
    """Weighted position (part 0) or orientation (part 3) beyond its ball, into r (6,); returns its size, squared.

    J (n, 6), the Jacobian of the error, becomes that of what is beyond: along the ball it shrinks by as much.
    """
    x, y, z = error[part], error[part + 1], error[part + 2]
    square = x * x + y * y + z * z
    size = math.sqrt(square)
    outside = max(size + task[12 + part], 0.0)
    scale = outside / size if outside > 0.0 else 0.0
    for j in range(part, part + 3):
        r[j] = scale * task[18 + j] * error[j]
    for c in range(J.shape[0]):
        outward = 0.0
        if outside > 0.0:
            outward = (1.0 - scale) * (x * J[c, part] + y * J[c, part + 1] + z * J[c, part + 2]) / square
        for j in range(part, part + 3):
            J[c, j] = scale * J[c, j] + outward * error[j]
    return float(outside * outside)


@shared
def jacobian(
    joints: Floats,
    wiring: Ints,
    first: int,
    last: int,
    task: Floats,
    pose: Floats,
    axes: Floats,
    origins: Floats,
    error: Floats,
    rotated: bool,
    J: Floats,
) -> None:
    """Add one tip's weighted Jacobian to J (n, 6): row c is d(error)/d(x_c).

    The rotation rows are angular velocity; with ``rotated`` they are d log(R) = Jl^-1(log R) omega instead, which
    differs far from the target and matters when some axes of rotation are free.
    """
    px, py, pz = pose[9], pose[10], pose[11]
    fx, fy, fz = error[3], error[4], error[5]
    k = 1.0 / 12.0
    if rotated:
        square = fx * fx + fy * fy + fz * fz
        if square > 1e-6:
            half = 0.5 * math.sqrt(square)
            k = (1.0 - half * math.cos(half) / math.sin(half)) / square
    for s in range(first, last):
        row = J[wiring[s, 0]]
        scale = joints[s, 12]
        zx, zy, zz = scale * axes[s, 0], scale * axes[s, 1], scale * axes[s, 2]
        if wiring[s, 1] == 1:
            dx, dy, dz = px - origins[s, 0], py - origins[s, 1], pz - origins[s, 2]
            row[0] += task[18] * (zy * dz - zz * dy)
            row[1] += task[19] * (zz * dx - zx * dz)
            row[2] += task[20] * (zx * dy - zy * dx)
            if rotated:
                ux, uy, uz = fy * zz - fz * zy, fz * zx - fx * zz, fx * zy - fy * zx
                zx += k * (fy * uz - fz * uy) - 0.5 * ux
                zy += k * (fz * ux - fx * uz) - 0.5 * uy
                zz += k * (fx * uy - fy * ux) - 0.5 * uz
            row[3] += task[21] * zx
            row[4] += task[22] * zy
            row[5] += task[23] * zz
        else:
            row[0] += task[18] * zx
            row[1] += task[19] * zy
            row[2] += task[20] * zz


@jit(f"void({PATHS}, f8[:,::1], f8[:,:,::1])")
def poses(joints: Floats, wiring: Ints, ends: Ints, tips: Floats, X: Floats, out: Floats) -> None:
    """World poses (k, T, 12) of every tip for a population X (k, n)."""
    S = joints.shape[0]
    axes, origins = np.empty((S, 3)), np.empty((S, 3))
    world = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    for k in range(X.shape[0]):
        for t in range(tips.shape[0]):
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], world, X[k], axes, origins, out[k, t])


@jit(f"void({PATHS}, f8[:,::1], f8[:,::1], f8[::1])")
def costs(joints: Floats, wiring: Ints, ends: Ints, tips: Floats, tasks: Floats, X: Floats, out: Floats) -> None:
    """Cost (k,) of a population X (k, n): weighted distance in m plus weighted angle in rad, summed over the tips."""
    S = joints.shape[0]
    axes, origins, pose, error, r = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(6), np.empty(6)
    no_jacobian = np.empty((0, 6))
    for k in range(X.shape[0]):
        total = 0.0
        for t in range(tips.shape[0]):
            task = tasks[t]
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], task[:12], X[k], axes, origins, pose)
            pose_error(pose, error)
            residual(task, error, r)
            if task[12] < 0.0:
                beyond_ball(task, error, 0, r, no_jacobian)
            if task[15] < 0.0:
                beyond_ball(task, error, 3, r, no_jacobian)
            total += math.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2) + math.sqrt(r[3] ** 2 + r[4] ** 2 + r[5] ** 2)
        out[k] = total
