"""Goals: how far a tip is from its target, and the derivative of that by the coordinates.

Errors are of T_target^-1 T_tip, the pose of the tip in the target frame: its position p and its rotation vector
log(R); both are zero at a solution.
"""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, exact, inline, jit, separate
from pin_metaik.kinematics.kernel.forward import copy, forward, sizes_of, unpack
from pin_metaik.kinematics.kernel.layout import (
    ALIGNED,
    AXIS,
    COLUMN,
    NEAR,
    POSE,
    ROTATES,
    SCALE,
    SLACK,
    TIP,
    TURN,
    TURN_SLACK,
    TURN_WEIGHT,
    WEIGHT,
    Arm,
)
from pin_metaik.kinematics.kernel.scratch import Scratch, scratch_for


@inline
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
def residual(goal: Floats, error: Floats, r: Floats) -> tuple[float, float]:
    """Weighted error beyond the slack, r (6,); returns the squares of its size in m and in rad, unweighted."""
    position = orientation = 0.0
    for j in range(6):
        slack = goal[SLACK + j]
        beyond = max(error[j] - slack, 0.0) + min(error[j] + slack, 0.0)
        if j < TURN:
            position += beyond * beyond
        else:
            orientation += beyond * beyond
        r[j] = goal[WEIGHT + j] * beyond
    return position, orientation


@inline
def beyond_ball(goal: Floats, error: Floats, part: int, r: Floats, J: Floats) -> float:
    """Weighted position (part 0) or orientation (part 3) beyond its ball, into r (6,); returns its size, squared.

    J (n, 6), the Jacobian of the error, becomes that of what is beyond: along the ball it shrinks by as much.
    """
    x, y, z = error[part], error[part + 1], error[part + 2]
    square = x * x + y * y + z * z
    size = math.sqrt(square)
    outside = max(size + goal[SLACK + part], 0.0)
    scale = outside / size if outside > 0.0 else 0.0
    for j in range(part, part + 3):
        r[j] = scale * goal[WEIGHT + j] * error[j]
    for c in range(J.shape[0]):
        outward = 0.0
        if outside > 0.0:
            outward = (1.0 - scale) * (x * J[c, part] + y * J[c, part + 1] + z * J[c, part + 2]) / square
        for j in range(part, part + 3):
            J[c, j] = scale * J[c, j] + outward * error[j]
    return float(outside * outside)


@inline
def jacobian(
    joints: Floats,
    wiring: Ints,
    first: int,
    last: int,
    goal: Floats,
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
        row = J[wiring[s, COLUMN]]
        scale = joints[s, SCALE]
        zx, zy, zz = scale * axes[s, 0], scale * axes[s, 1], scale * axes[s, 2]
        if wiring[s, ROTATES] == 1:
            dx, dy, dz = px - origins[s, 0], py - origins[s, 1], pz - origins[s, 2]
            row[0] += goal[WEIGHT] * (zy * dz - zz * dy)
            row[1] += goal[WEIGHT + 1] * (zz * dx - zx * dz)
            row[2] += goal[WEIGHT + 2] * (zx * dy - zy * dx)
            if rotated:
                ux, uy, uz = fy * zz - fz * zy, fz * zx - fx * zz, fx * zy - fy * zx
                zx += k * (fy * uz - fz * uy) - 0.5 * ux
                zy += k * (fz * ux - fx * uz) - 0.5 * uy
                zz += k * (fx * uy - fy * ux) - 0.5 * uz
            row[3] += goal[TURN_WEIGHT] * zx
            row[4] += goal[TURN_WEIGHT + 1] * zy
            row[5] += goal[TURN_WEIGHT + 2] * zz
        else:
            row[0] += goal[WEIGHT] * zx
            row[1] += goal[WEIGHT + 1] * zy
            row[2] += goal[WEIGHT + 2] * zz


@inline
def have_balls(goals: Floats) -> bool:
    """Whether a tolerance is aimed at as a ball."""
    found = False
    for t in range(goals.shape[0]):
        found = found or goals[t, SLACK] < 0.0 or goals[t, TURN_SLACK] < 0.0
    return found


@inline
def evaluate_with(arm: Arm, goals: Floats, rows: Ints, x: Floats, work: Scratch, balls: bool) -> tuple[float, bool]:
    """``evaluate``; ``balls`` is a constant, so that what has none does not pay for them."""
    joints, wiring, ends, tips = arm
    axes, origins, pose, error, r6, J6 = work.axes, work.origins, work.pose, work.error, work.r6, work.J6
    r, J = work.r, work.J
    m = 0
    square = 0.0
    solved = True
    for t in range(tips.shape[0]):
        goal = goals[t]
        forward(joints, wiring, ends[t], ends[t + 1], tips[t], goal[:POSE], x, axes, origins, pose)
        pose_error(pose, error)
        position, orientation = residual(goal, error, r6)
        J6[:, :] = 0.0
        rotated = goal[TURN_SLACK] > 0.0 or goal[TURN_SLACK + 1] > 0.0 or goal[TURN_SLACK + 2] > 0.0
        rotated = rotated or (balls and goal[TURN_SLACK] < 0.0)
        jacobian(joints, wiring, ends[t], ends[t + 1], goal, pose, axes, origins, error, rotated, J6)
        if balls and goal[SLACK] < 0.0:
            position = beyond_ball(goal, error, 0, r6, J6)
        if balls and goal[TURN_SLACK] < 0.0:
            orientation = beyond_ball(goal, error, TURN, r6, J6)
        solved = solved and position <= goal[NEAR] * goal[NEAR] and orientation <= goal[ALIGNED] * goal[ALIGNED]
        while m < rows.shape[0] and rows[m, TIP] == t:
            j = rows[m, AXIS]
            r[m] = r6[j]
            square += r6[j] * r6[j]
            counts = r6[j] != 0.0 or goal[SLACK + j] == 0.0 or (balls and goal[SLACK + j] < 0.0)
            for c in range(J6.shape[0]):
                J[c, m] = J6[c, j] if counts else 0.0
            m += 1
    return square, solved


@inline
def evaluate_balls(arm: Arm, goals: Floats, rows: Ints, x: Floats, work: Scratch) -> tuple[float, bool]:
    """``evaluate`` where a tolerance is aimed at as a ball."""
    return evaluate_with(arm, goals, rows, x, work, True)


def evaluate_in(arm: Arm, goals: Floats, rows: Ints, x: Floats, work: Scratch, balls: bool) -> tuple[float, bool]:
    """Residual r (m,) and Jacobian by coordinate J (n, m) of several tips, or of one with free axes, slack or balls.

    Returns |r|^2 and whether every tip is in tolerance.
    """
    return evaluate_balls(arm, goals, rows, x, work) if balls else evaluate_with(arm, goals, rows, x, work, False)


evaluate, evaluate_apart = inline(evaluate_in), separate(evaluate_in)


@inline
def evaluate_pose(arm: Arm, goal: Floats, x: Floats, work: Scratch) -> tuple[float, bool]:
    """The same for one tip's whole pose without slack: what almost everybody asks for, at half the time."""
    joints, wiring, ends, tips = arm
    axes, origins, pose, error, r, J = work.axes, work.origins, work.pose, work.error, work.r, work.J
    forward(joints, wiring, ends[0], ends[1], tips[0], goal[:POSE], x, axes, origins, pose)
    pose_error(pose, error)
    position, orientation = residual(goal, error, r)
    J[:, :] = 0.0
    jacobian(joints, wiring, ends[0], ends[1], goal, pose, axes, origins, error, False, J)
    square = 0.0
    for j in range(6):
        square += r[j] * r[j]
    return square, position <= goal[NEAR] * goal[NEAR] and orientation <= goal[ALIGNED] * goal[ALIGNED]


@exact
def added(total: float, a: float, b: float) -> float:
    """total + a + b, in this order."""
    return total + a + b


@inline
def cost_all(block: Floats, goals: Floats, X: Floats, out: Floats, work: Scratch, no_jacobian: Floats) -> None:
    """``costs`` in room that was made for it."""
    joints, wiring, ends, tips = unpack(block).arm
    axes, origins, pose, error, r = work.axes, work.origins, work.pose, work.error, work.r
    for k in range(X.shape[0]):
        total = 0.0
        for t in range(tips.shape[0]):
            goal = goals[t]
            forward(joints, wiring, ends[t], ends[t + 1], tips[t], goal[:POSE], X[k], axes, origins, pose)
            pose_error(pose, error)
            residual(goal, error, r)
            if goal[SLACK] < 0.0:
                beyond_ball(goal, error, 0, r, no_jacobian)
            if goal[TURN_SLACK] < 0.0:
                beyond_ball(goal, error, TURN, r, no_jacobian)
            distance = math.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2)
            total = added(total, distance, math.sqrt(r[3] ** 2 + r[4] ** 2 + r[5] ** 2))
        out[k] = total


@jit("void(f8[::1], f8[:,::1], f8[:,::1], f8[::1])")
def costs(block: Floats, goals: Floats, X: Floats, out: Floats) -> None:
    """Cost (k,) of a population X (k, n): weighted distance in m plus weighted angle in rad, summed over the tips."""
    S, n, _ = sizes_of(block)
    cost_all(block, goals, X, out, scratch_for(n, None, S), np.empty((0, 6)))


@inline
def linearize_in(
    block: Floats, goals: Floats, rows: Ints, x: Floats, r: Floats, J: Floats, work: Scratch
) -> tuple[float, bool]:
    """``linearize`` in room that was made for it."""
    square, met = evaluate_apart(unpack(block).arm, goals, rows, x, work, have_balls(goals))
    copy(work.r, r)
    for c in range(x.shape[0]):
        copy(work.J[c], J[c])
    return square, met


@jit("Tuple((f8, b1))(f8[::1], f8[:,::1], i8[:,::1], f8[::1], f8[::1], f8[:,::1])")
def linearize(block: Floats, goals: Floats, rows: Ints, x: Floats, r: Floats, J: Floats) -> tuple[float, bool]:
    """Weighted residual r (m,) and Jacobian by coordinate J (n, m) at x; also |r|^2 and whether all is in tolerance."""
    S, n, _ = sizes_of(block)
    return linearize_in(block, goals, rows, x, r, J, scratch_for(n, rows, S))
