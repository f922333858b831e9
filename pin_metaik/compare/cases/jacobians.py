"""Jacobians of many configurations at once, for cases that search special configurations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.kernel.layout import SCALE, SHIFT


def jacobians(chain: Chain, X: NDArray[np.float64]) -> NDArray[np.float64]:
    """Jacobians (k, 6, n) of the chain's frame at coordinates X (k, n), linear part first, in world axes."""
    joints, wiring, _, tips = chain.paths.arrays
    R, p = np.broadcast_to(np.eye(3), (len(X), 3, 3)), np.zeros((len(X), 3))
    axes, points = [], []
    for row, (column, rotates) in zip(joints, wiring, strict=True):
        R, p = R @ row[:9].reshape(3, 3), p + R @ row[9:12]
        axes.append(row[SCALE] * R[:, :, 2])
        points.append(p)
        x = row[SCALE] * X[:, column] + row[SHIFT]
        if rotates:
            turn = np.zeros((len(X), 3, 3))
            turn[:, 0, 0] = turn[:, 1, 1] = np.cos(x)
            turn[:, 1, 0] = np.sin(x)
            turn[:, 0, 1] = -turn[:, 1, 0]
            turn[:, 2, 2] = 1.0
            R = R @ turn
        else:
            p = p + x[:, None] * R[:, :, 2]
    tip = p + R @ tips[0, 9:]
    J = np.zeros((len(X), 6, chain.n))
    for axis, point, (column, rotates) in zip(axes, points, wiring, strict=True):
        J[:, :3, column] += np.cross(axis, tip - point) if rotates else axis
        J[:, 3:, column] += axis if rotates else 0.0
    return J
