"""Poses as 4x4 matrices: the types accepted, and the distance between two poses."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array
from pin_metaik.errors import InvalidTarget
from pin_metaik.kinematics.kernel.layout import ORTHONORMAL


class Pose(NamedTuple):
    """A checked pose: as a ``pin.SE3`` of its own, and as the numbers R00 R01 R02 x, R10 R11 R12 y, R20 R21 R22 z."""

    placement: pin.SE3
    numbers: tuple[float, ...]


def as_pose(pose: pin.SE3 | ArrayLike) -> Pose:
    """A pose of the caller, checked.

    Args:
        pose: A ``pin.SE3`` or a 4x4 homogeneous matrix.

    Raises:
        InvalidTarget: If it is not finite, not 4x4, or its rotation is not orthonormal and right-handed.
    """
    placement = pin.SE3(pose) if isinstance(pose, pin.SE3) else _from_matrix(pose)
    # Plain floats: on a dozen numbers this is five times quicker than numpy's reductions.
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = placement.homogeneous.tolist()
    if not math.isfinite(a + b + c + d + e + f + g + h + i + x + y + z):
        raise InvalidTarget(f"a pose has finite entries, got\n{placement.homogeneous}")
    # Two rows of unit length and the third their cross product: orthonormal and right-handed.
    u, v, w = b * f - c * e - g, c * d - a * f - h, a * e - b * d - i
    if (
        abs(a * a + b * b + c * c - 1.0) > ORTHONORMAL
        or abs(d * d + e * e + f * f - 1.0) > ORTHONORMAL
        or u * u + v * v + w * w > ORTHONORMAL * ORTHONORMAL
    ):
        raise InvalidTarget(_complaint(placement.rotation))
    return Pose(placement, (a, b, c, x, d, e, f, y, g, h, i, z))


def _from_matrix(pose: ArrayLike) -> pin.SE3:
    matrix = array("a pose, a pin.SE3 or a 4x4 matrix,", pose, 4, 4, error=InvalidTarget)
    if matrix[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        raise InvalidTarget(f"the last row of a pose is 0 0 0 1, got {matrix[3]}")
    return pin.SE3(matrix[:3, :3], matrix[:3, 3])


def _complaint(rotation: NDArray[np.float64]) -> str:
    """The defect of a rotation matrix, in words."""
    defect = float(np.abs(rotation.T @ rotation - np.eye(3)).max())
    if defect > ORTHONORMAL:
        return f"the rotation of a pose is orthonormal; R'R is off by {defect:.3g} in\n{rotation}"
    return f"the rotation of a pose is right-handed; this one mirrors (det R = -1):\n{rotation}"


def as_position(xyz: ArrayLike) -> NDArray[np.float64]:
    """A position as a fresh (3,) vector in metres.

    Raises:
        InvalidTarget: If it is not three finite numbers.
    """
    return array("a position in metres", xyz, 3, error=InvalidTarget).copy()


def rpy_matrix(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """Rotation Rz(yaw) Ry(pitch) Rx(roll), angles in radians (the URDF convention)."""
    matrix: NDArray[np.float64] = pin.rpy.rpyToMatrix(roll, pitch, yaw)
    return matrix
