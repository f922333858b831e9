"""The compiled loop of forward kinematics: Newton from many starts."""

from __future__ import annotations

import math

import numpy as np

from pin_metaik.compiled import Floats, Ints, inline, jit
from pin_metaik.stewart.kernels.judging import SINGULAR, reflect, turn

CONVERGED, STUCK, SPENT = 1, 2, 3  # ForwardStatus


@inline
def solve(J: Floats, diagonal: Floats, error: Floats, step: Floats) -> bool:
    """The shortest step (6,) with J step = error, from the reflections of J; False if J is singular."""
    n = J.shape[0]
    for i in range(n):
        if abs(diagonal[i]) < SINGULAR:
            return False
        total = error[i]
        for j in range(i):
            total -= J[i, j] * step[j]
        step[i] = total / diagonal[i]
    for i in range(n, 6):
        step[i] = 0.0
    for k in range(n - 1, -1, -1):  # Q' y: the reflections backwards
        dot, square = 0.0, 0.0
        for c in range(k, 6):
            dot += step[c] * J[k, c]
            square += J[k, c] * J[k, c]
        for c in range(k, 6):
            step[c] -= 2.0 * dot / square * J[k, c]
    return True


@inline
def rotate(pose: Floats, wx: float, wy: float, wz: float) -> None:
    """Turn the pose in place by the rotation vector w in the base frame: R <- exp(w) R (Rodrigues)."""
    angle = math.sqrt(wx * wx + wy * wy + wz * wz)
    if angle == 0.0:
        return
    wx, wy, wz = wx / angle, wy / angle, wz / angle
    cos, sin = math.cos(angle), math.sin(angle)
    for c in range(3):
        x, y, z = pose[0, c], pose[1, c], pose[2, c]
        along = (wx * x + wy * y + wz * z) * (1.0 - cos)
        pose[0, c] = cos * x + sin * (wy * z - wz * y) + along * wx
        pose[1, c] = cos * y + sin * (wz * x - wx * z) + along * wy
        pose[2, c] = cos * z + sin * (wx * y - wy * x) + along * wz


@jit("void(f8[:,:,::1], f8[:,::1], f8[:,::1], f8, f8, i8, f8[:,:,::1], i8[::1], f8[::1], i1[::1])")
def newton(
    base: Floats,
    platform_anchors: Floats,
    lengths: Floats,
    scale: float,
    tolerance: float,
    most: int,
    poses: Floats,
    iterations: Ints,
    errors: Floats,
    states: Ints,
) -> None:
    """Newton from poses (k, 4, 4), in place, to the leg lengths (k, n): the shortest step when legs are fewer than six.

    ``base`` (k, n, 3) is where the legs begin; the same for all if it is (1, n, 3).
    Lengths are dimensionless in J (rotations count ``scale`` metres a radian); steps are at most one radian long.
    """
    n = platform_anchors.shape[0]
    turned, J, diagonal, error, step = np.empty((n, 3)), np.empty((n, 6)), np.empty(n), np.empty(n), np.empty(6)
    for k in range(poses.shape[0]):
        pose, starts = poses[k], base[k if base.shape[0] > 1 else 0]
        states[k] = SPENT
        for iteration in range(most + 1):
            iterations[k] = iteration
            turn(pose, platform_anchors, turned)
            errors[k] = 0.0
            for i in range(n):
                x = pose[0, 3] + turned[i, 0] - starts[i, 0]
                y = pose[1, 3] + turned[i, 1] - starts[i, 1]
                z = pose[2, 3] + turned[i, 2] - starts[i, 2]
                d = math.sqrt(x * x + y * y + z * z)
                error[i] = lengths[k, i] - d
                errors[k] = max(errors[k], abs(error[i]))
                shrink = 1.0 / d if d > 0.0 else 0.0
                x, y, z = shrink * x, shrink * y, shrink * z
                J[i, 0], J[i, 1], J[i, 2] = x, y, z
                J[i, 3] = (turned[i, 1] * z - turned[i, 2] * y) / scale
                J[i, 4] = (turned[i, 2] * x - turned[i, 0] * z) / scale
                J[i, 5] = (turned[i, 0] * y - turned[i, 1] * x) / scale
            if errors[k] <= tolerance:
                states[k] = CONVERGED
                break
            if iteration == most:
                break
            reflect(J, diagonal)
            if not solve(J, diagonal, error, step):
                states[k] = STUCK
                break
            size = 0.0
            for c in range(6):
                size += step[c] * step[c]
            shrink = min(1.0, scale / math.sqrt(size))
            for c in range(3):
                pose[c, 3] += shrink * step[c]
            rotate(pose, shrink * step[3] / scale, shrink * step[4] / scale, shrink * step[5] / scale)
