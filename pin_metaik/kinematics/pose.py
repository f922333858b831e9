"""Poses as 4x4 matrices: what is accepted, and how far two of them are apart."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import InvalidTarget

ORTHONORMAL = 1e-6
"""How far R'R may be from the identity, and det R from 1, before a matrix is not taken for a rotation."""


def as_pose(pose: pin.SE3 | ArrayLike) -> NDArray[np.float64]:
    """A pose as a fresh, C-contiguous (4, 4) matrix.

    Args:
        pose: A ``pin.SE3`` or a 4x4 homogeneous matrix.

    Raises:
        InvalidTarget: If it is not finite, not 4x4, or its rotation is not orthonormal and right-handed.
    """
    if isinstance(pose, pin.SE3):
        matrix: NDArray[np.float64] = pose.homogeneous
    else:
        try:
            matrix = np.array(pose, dtype=np.float64, order="C")
        except (TypeError, ValueError):
            raise InvalidTarget(f"a pose is a pin.SE3 or a 4x4 matrix, got {type(pose).__name__}") from None
        if matrix.shape != (4, 4):
            raise InvalidTarget(f"a pose is a pin.SE3 or a 4x4 matrix, got shape {matrix.shape}")
    _refuse_non_pose(matrix)
    return np.ascontiguousarray(matrix)


def _refuse_non_pose(matrix: NDArray[np.float64]) -> None:
    # Plain floats: on sixteen numbers this is five times quicker than numpy's reductions.
    (a, b, c, x), (d, e, f, y), (g, h, i, z), bottom = matrix.tolist()
    if not math.isfinite(a + b + c + d + e + f + g + h + i + x + y + z):
        raise InvalidTarget(f"a pose has finite entries, got\n{matrix}")
    defect = max(
        abs(a * a + d * d + g * g - 1.0),
        abs(b * b + e * e + h * h - 1.0),
        abs(c * c + f * f + i * i - 1.0),
        abs(a * b + d * e + g * h),
        abs(a * c + d * f + g * i),
        abs(b * c + e * f + h * i),
    )
    if defect > ORTHONORMAL:
        raise InvalidTarget(f"the rotation of a pose is orthonormal; R'R is off by {defect:.3g} in\n{matrix}")
    if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0:
        raise InvalidTarget(f"the rotation of a pose is right-handed; this one mirrors (det R = -1):\n{matrix}")
    if bottom != [0.0, 0.0, 0.0, 1.0]:
        raise InvalidTarget(f"the last row of a pose is 0 0 0 1, got {bottom}")


def as_position(xyz: ArrayLike) -> NDArray[np.float64]:
    """A position as a fresh (3,) vector in metres.

    Raises:
        InvalidTarget: If it is not three finite numbers.
    """
    try:
        vector = np.array(xyz, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidTarget(f"a position is three numbers in metres, got {xyz!r}") from None
    if vector.shape != (3,):
        raise InvalidTarget(f"a position has shape (3,), got {vector.shape}")
    if not np.isfinite(vector).all():
        raise InvalidTarget(f"a position has finite entries, got {vector}")
    return vector


def rpy_matrix(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """Rotation Rz(yaw) Ry(pitch) Rx(roll), angles in radians (the URDF convention)."""
    matrix: NDArray[np.float64] = pin.rpy.rpyToMatrix(roll, pitch, yaw)
    return matrix
