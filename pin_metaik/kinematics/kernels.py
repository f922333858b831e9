"""The compiled loops: poses of a population, costs of a population, damped least squares with restarts.

Compiling a single forward kinematics gains nothing over Pinocchio (0.8 us);
compiling whole loops does, because the call from Python (1-3 us) is then paid once.

Arrays every kernel takes (made by ``Chain`` and ``IKProblem``; S joints on all paths, T tips, n coordinates):

* ``joints`` (S, 14): placement of the joint frame, turned so that its axis is z, in the joint frame before it (rotation
  row by row, then translation), then the scale and shift of its coordinate: angle or travel = scale x + shift.
* ``wiring`` (S, 2): column of x that the joint follows, and 1 if it rotates, 0 if it slides.
* ``ends`` (T + 1,): joints ``ends[t]:ends[t + 1]`` lead from the world to tip t; paths may share columns.
* ``tips`` (T, 12): placement of each tip in its last joint frame.
* ``tasks`` (T, 26): the world in the target frame (12), slack per axis (6), weight per axis (6), tolerances (m, rad).
* ``rows`` (m, 2): which (tip, axis) pairs count: weight above zero and slack finite.

Seen from the target frame, a solved tip stands at the identity: position error p, orientation error log(R), and no
target left to subtract. ``x`` is (n,), a population ``X`` is (k, n).
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit

PATHS = "f8[:,::1], i8[:,::1], i8[::1], f8[:,::1]"  # joints, wiring, ends, tips
TASKS = "f8[:,::1], i8[:,::1]"  # tasks, rows

PATIENCE = 5  # iterations that must bring ...
PROGRESS = 0.7  # ... the error below this share of what it was, or the start is given up
DAMPING_FLOOR = 1e-9  # what is left of the damping at a solution
POLISH = 2  # further steps once the tolerance is met, while each gains a decade


@inline
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
            cos, sin = math.cos(value), math.sin(value)
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


@inline
def log_rotation(pose: Floats, out: Floats) -> float:
    """Rotation vector of the pose's rotation; exact near 0 and, through the symmetric part, near pi."""
    wx, wy, wz = 0.5 * (pose[7] - pose[5]), 0.5 * (pose[2] - pose[6]), 0.5 * (pose[3] - pose[1])
    sin = math.sqrt(wx * wx + wy * wy + wz * wz)
    cos = 0.5 * (pose[0] + pose[4] + pose[8] - 1.0)
    angle = math.atan2(sin, cos)
    if sin > 1e-4 or cos > 0.0:
        scale = angle / sin if sin > 1e-8 else 1.0
        out[0], out[1], out[2] = scale * wx, scale * wy, scale * wz
        return angle
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
    out[0], out[1], out[2] = scale * nx, scale * ny, scale * nz
    return angle


@inline
def residual(task: Floats, pose: Floats, phi: Floats, error: Floats) -> tuple[float, float]:
    """Write a tip's weighted error beyond its slack (6,); return its size in m and in rad, unweighted."""
    error[0], error[1], error[2] = pose[9], pose[10], pose[11]
    error[3], error[4], error[5] = phi[0], phi[1], phi[2]
    position = orientation = 0.0
    for j in range(6):
        slack = task[12 + j]
        beyond = 0.0
        if error[j] > slack:
            beyond = error[j] - slack
        elif error[j] < -slack:
            beyond = error[j] + slack
        if j < 3:
            position += beyond * beyond
        else:
            orientation += beyond * beyond
        error[j] = task[18 + j] * beyond
    return math.sqrt(position), math.sqrt(orientation)


@inline
def jacobian(
    joints: Floats,
    wiring: Ints,
    first: int,
    last: int,
    task: Floats,
    pose: Floats,
    axes: Floats,
    origins: Floats,
    phi: Floats,
    columns: Floats,
) -> None:
    """Add one tip's weighted error Jacobian to ``columns`` (n, 6): row c is d(error)/d(x_c)."""
    px, py, pz = pose[9], pose[10], pose[11]
    fx, fy, fz = phi[0], phi[1], phi[2]
    square = fx * fx + fy * fy + fz * fz
    k = 1.0 / 12.0
    if square > 1e-6:
        half = 0.5 * math.sqrt(square)
        k = (1.0 - half * math.cos(half) / math.sin(half)) / square
    for s in range(first, last):
        c, scale = wiring[s, 0], joints[s, 12]
        zx, zy, zz = scale * axes[s, 0], scale * axes[s, 1], scale * axes[s, 2]
        if wiring[s, 1] == 1:
            dx, dy, dz = px - origins[s, 0], py - origins[s, 1], pz - origins[s, 2]
            columns[c, 0] += task[18] * (zy * dz - zz * dy)
            columns[c, 1] += task[19] * (zz * dx - zx * dz)
            columns[c, 2] += task[20] * (zx * dy - zy * dx)
            ux, uy, uz = fy * zz - fz * zy, fz * zx - fx * zz, fx * zy - fy * zx
            columns[c, 3] += task[21] * (zx - 0.5 * ux + k * (fy * uz - fz * uy))
            columns[c, 4] += task[22] * (zy - 0.5 * uy + k * (fz * ux - fx * uz))
            columns[c, 5] += task[23] * (zz - 0.5 * uz + k * (fx * uy - fy * ux))
        else:
            columns[c, 0] += task[18] * zx
            columns[c, 1] += task[19] * zy
            columns[c, 2] += task[20] * zz


@inline
def cholesky_solve(H: Floats, y: Floats, m: int) -> None:
    """Solve H y = y in place; H (m, m) is positive definite and is overwritten by its factor."""
    for j in range(m):
        d = H[j, j]
        for k in range(j):
            d -= H[j, k] * H[j, k]
        d = 1.0 / math.sqrt(d)
        H[j, j] = d
        for i in range(j + 1, m):
            v = H[i, j]
            for k in range(j):
                v -= H[i, k] * H[j, k]
            H[i, j] = v * d
    for i in range(m):
        v = y[i]
        for k in range(i):
            v -= H[i, k] * y[k]
        y[i] = v * H[i, i]
    for i in range(m - 1, -1, -1):
        v = y[i]
        for k in range(i + 1, m):
            v -= H[k, i] * y[k]
        y[i] = v * H[i, i]


@inline
def evaluate(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    x: Floats,
    axes: Floats,
    origins: Floats,
    pose: Floats,
    phi: Floats,
    error: Floats,
    columns: Floats,
    r: Floats,
    J: Floats,
) -> tuple[float, bool]:
    """Residual r (m,) and its Jacobian by coordinate J (n, m); returns |r|^2 and whether every tip is in tolerance."""
    m = 0
    square = 0.0
    solved = True
    for t in range(tips.shape[0]):
        task = tasks[t]
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], task[:12], x, axes, origins, pose)
        log_rotation(pose, phi)
        position, orientation = residual(task, pose, phi, error)
        solved = solved and position <= task[24] and orientation <= task[25]
        columns[:, :] = 0.0
        jacobian(joints, wiring, ends[t], ends[t + 1], task, pose, axes, origins, phi, columns)
        while m < rows.shape[0] and rows[m, 0] == t:
            j = rows[m, 1]
            r[m] = error[j]
            square += error[j] * error[j]
            held = error[j] != 0.0 or task[12 + j] == 0.0
            for c in range(columns.shape[0]):
                J[c, m] = columns[c, j] if held else 0.0
            m += 1
    return square, solved


@inline
def step(x: Floats, lower: Floats, upper: Floats, r: Floats, J: Floats, damping: float, H: Floats, y: Floats) -> None:
    """Damped least-squares step dx = -J' (J J' + damping I)^-1 r over the joints that their limits leave free."""
    n, m = J.shape
    for a in range(m):
        for b in range(a):
            H[a, b] = 0.0
        H[a, a] = damping
        y[a] = r[a]
    for c in range(n):
        slope = 0.0
        for a in range(m):
            slope += J[c, a] * r[a]
        if (slope > 0.0 and x[c] <= lower[c]) or (slope < 0.0 and x[c] >= upper[c]):
            J[c, :] = 0.0  # at its limit and pushed outward
            continue
        for a in range(m):
            v = J[c, a]
            for b in range(a + 1):
                H[a, b] += v * J[c, b]
    cholesky_solve(H, y, m)
    for c in range(n):
        v = 0.0
        for a in range(m):
            v += J[c, a] * y[a]
        x[c] = min(max(x[c] - v, lower[c]), upper[c])


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
    axes, origins, pose, phi, error = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(3), np.empty(6)
    for k in range(X.shape[0]):
        total = 0.0
        for t in range(tips.shape[0]):
            task = tasks[t]
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], task[:12], X[k], axes, origins, pose)
            log_rotation(pose, phi)
            residual(task, pose, phi, error)
            total += math.sqrt(error[0] ** 2 + error[1] ** 2 + error[2] ** 2)
            total += math.sqrt(error[3] ** 2 + error[4] ** 2 + error[5] ** 2)
        out[k] = total


@jit(f"UniTuple(i8, 2)({PATHS}, {TASKS}, f8[::1], f8[::1], f8[:,::1], f8, i8, i8, f8[::1])")
def descend(
    joints: Floats,
    wiring: Ints,
    ends: Ints,
    tips: Floats,
    tasks: Floats,
    rows: Ints,
    lower: Floats,
    upper: Floats,
    starts: Floats,
    damping: float,
    per_start: int,
    evaluations: int,
    best: Floats,
) -> tuple[int, int]:
    """Damped least squares from one start after the other until one reaches the tolerance or the evaluations are spent.

    Returns the evaluations spent and the index of the start that solved it, or -1; ``best`` (n,) gets the coordinates.
    """
    n, m, S = lower.shape[0], rows.shape[0], joints.shape[0]
    axes, origins, pose, phi, error = np.empty((S, 3)), np.empty((S, 3)), np.empty(12), np.empty(3), np.empty(6)
    columns, r, J, H, y = np.empty((n, 6)), np.empty(m), np.empty((n, m)), np.empty((m, m)), np.empty(m)
    x = np.empty(n)
    spent = 0
    least = np.inf
    for k in range(starts.shape[0]):
        x[:] = starts[k]
        mark = np.inf
        found = False
        polish = POLISH
        for i in range(per_start):
            if spent >= evaluations:
                break
            square, solved = evaluate(
                joints, wiring, ends, tips, tasks, rows, x, axes, origins, pose, phi, error, columns, r, J
            )
            spent += 1
            if found and not (solved and square < 0.01 * least):
                return spent, k
            if square < least or solved:
                least = square
                best[:] = x
            if solved:
                polish = polish - 1 if found else POLISH
                found = True
                if polish == 0 or square == 0.0:
                    return spent, k
            elif i % PATIENCE == PATIENCE - 1:
                if square > PROGRESS * PROGRESS * mark:
                    break
                mark = square
            elif i == 0:
                mark = square
            step(x, lower, upper, r, J, damping * square + DAMPING_FLOOR, H, y)
        if found:
            return spent, k
        if spent >= evaluations:
            break
    return spent, -1
