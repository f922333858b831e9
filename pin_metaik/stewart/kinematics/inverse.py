"""Inverse kinematics, Eq. 1-2: how long each leg is at a pose, or where its servo stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.stewart.platform.actuation import Links
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many
from pin_metaik.stewart.platform.servo_legs import ServoLegs


@checked
def inverse(geometry: Geometry, poses: PoseLike, branches: int | tuple[int, ...] | None = None) -> Links:
    """Inverse kinematics in closed form: the coordinate of every leg, and where its link is.

    Args:
        geometry: The platform.
        poses: ``pin.SE3`` or (4, 4) for one pose, (k, 4, 4) or a list for many.
        branches: Branches of servos instead of the geometry's own: 1 or -1, for all legs or for each.

    Returns:
        The legs, with a row for each pose; ``reached`` says at which poses every rod reaches its platform joint, and
        ``missing`` by how much it does not.

    Raises:
        InvalidTarget: Not poses.
        InvalidSetting: Branches for linear actuators, which have none.
        InvalidGeometry: Branches other than 1 and -1, or not one for each leg.
    """
    actuation = geometry.actuation
    if branches is not None:
        if geometry.servos is None:
            raise InvalidSetting("linear actuators have no branches; servos have two each")
        actuation = ServoLegs(replace(geometry.servos, branches=branches))
    return actuation.links(geometry.b, vectors_at(geometry, as_poses(poses)))


def links_at(geometry: Geometry, T: Array) -> Links:
    """The legs at poses (k, 4, 4) that are known to be poses."""
    return geometry.actuation.links(geometry.b, vectors_at(geometry, T))


def vectors_at(geometry: Geometry, T: Array) -> Array:
    """v_i = P + R m_i - b_i at poses (k, 4, 4) that are known to be poses: (k, n, 3)."""
    R, P = T[:, :3, :3], T[:, None, :3, 3]
    v: Array = P + geometry.m @ R.transpose(0, 2, 1) - geometry.b
    return v


@checked
def leg_vectors(geometry: Geometry, poses: PoseLike) -> Array:
    """Vectors of the legs from base to platform joint, in the base frame, m: (k, n, 3); with servos, from the shaft.

    Raises:
        InvalidTarget: Not poses.
    """
    return vectors_at(geometry, as_poses(poses))


@checked
def leg_lengths(geometry: Geometry, poses: PoseLike) -> Array:
    """Lengths d_i = |v_i| of the legs, m: (k, n); (n,) for a single pose. With servos, from the shaft; see ``inverse``.

    Args:
        geometry: The platform.
        poses: ``pin.SE3`` or (4, 4) for one pose, (k, 4, 4) or a list for many.

    Raises:
        InvalidTarget: Not poses.
    """
    lengths: Array = np.linalg.norm(leg_vectors(geometry, poses), axis=-1)
    return lengths if is_many(poses) else lengths[0]
