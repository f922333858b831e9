"""Inverse kinematics, Eq. 1-2: how long each leg is at a pose."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many


@checked
def leg_vectors(geometry: Geometry, poses: PoseLike) -> Array:
    """Legs from base to platform joint, in the base frame, m: (k, n, 3).

    Raises:
        InvalidTarget: Not poses.
    """
    T = as_poses(poses)  # (k, 4, 4)
    R, P = T[:, :3, :3], T[:, None, :3, 3]
    v: Array = P + geometry.m @ R.transpose(0, 2, 1) - geometry.b  # v_i = P + R m_i - b_i
    return v


@checked
def leg_lengths(geometry: Geometry, poses: PoseLike) -> Array:
    """Lengths d_i = |v_i| of the legs, m: (k, n); (n,) for a single pose.

    Args:
        geometry: The platform.
        poses: ``pin.SE3`` or (4, 4) for one pose, (k, 4, 4) or a list for many.

    Raises:
        InvalidTarget: Not poses.
    """
    lengths: Array = np.linalg.norm(leg_vectors(geometry, poses), axis=-1)
    return lengths if is_many(poses) else lengths[0]
