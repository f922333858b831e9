"""Poses of the moving platform: the frame at P, with the axes of the moving circle, seen from the base frame."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.kinematics.kernel.layout import ORTHONORMAL
from pin_metaik.kinematics.pose import as_pose, as_position, rpy_matrix

PoseLike: TypeAlias = pin.SE3 | ArrayLike


def pose_at(xyz: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """A pose (4, 4): P at xyz (m), turned by Rz(yaw) Ry(pitch) Rx(roll) with rpy in rad.

    Raises:
        InvalidTarget: Not three finite numbers each.
    """
    pose = np.eye(4)
    pose[:3, :3] = rpy_matrix(*as_position(rpy))
    pose[:3, 3] = as_position(xyz)
    return pose


def as_poses(poses: PoseLike) -> Array:
    """One pose or many as a fresh, C-contiguous array (k, 4, 4).

    Args:
        poses: A ``pin.SE3``, a matrix (4, 4), many (k, 4, 4), or a list of poses.

    Raises:
        InvalidTarget: If one of them is not a pose.
    """
    try:
        array = np.array(poses, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise InvalidTarget(f"poses are pin.SE3 or 4x4 matrices, got {type(poses).__name__}") from None
    if array.ndim == 2:
        array = array[None]
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise InvalidTarget(f"poses have shape (4, 4) or (k, 4, 4), got {np.shape(poses)}")
    R = array[:, :3, :3]
    with np.errstate(invalid="ignore", over="ignore"):
        crooked = np.abs(R.transpose(0, 2, 1) @ R - np.eye(3)).max(axis=(1, 2), initial=0.0) > ORTHONORMAL
        wrong = crooked | (np.linalg.det(R) < 0.0) | (array[:, 3] != [0.0, 0.0, 0.0, 1.0]).any(axis=1)
        wrong |= ~np.isfinite(array).all(axis=(1, 2))
    for k in np.flatnonzero(wrong)[:1]:
        as_pose(array[k])  # says what is wrong with it
    return array


def one_pose(pose: PoseLike) -> Array:
    """One pose (4, 4), or the first of many.

    Raises:
        InvalidTarget: A pose is malformed, or the list is empty.
    """
    poses = as_poses(pose)
    if not len(poses):
        raise InvalidTarget("a pose is a pin.SE3 or a 4x4 matrix, got no pose at all")
    return np.asarray(poses[0])


def is_many(poses: PoseLike) -> bool:
    """Whether these are poses, which get a list of answers, rather than one pose, which gets one."""
    return np.ndim(poses) == 3
