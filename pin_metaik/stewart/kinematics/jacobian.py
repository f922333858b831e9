"""The Jacobian, Eq. 4-7: rates of the legs from the velocity of the platform."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.kinematics.conditioning import DEFAULT, Dexterity, characteristic_length
from pin_metaik.stewart.kinematics.inverse import leg_vectors
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many


@checked
def jacobian(geometry: Geometry, poses: PoseLike) -> Array:
    """J (k, n, 6) with ``d_dot = J (v, omega)``, Eq. 4; (n, 6) for a single pose.

    v is the velocity of P and omega the angular velocity, both in the base frame; m/s and rad/s give m/s. Row i is
    ``[z_i, R m_i x z_i]`` with the unit leg z_i; zeros for a leg of no length, which has no direction.

    Raises:
        InvalidTarget: Not poses.
    """
    T = as_poses(poses)
    v = leg_vectors(geometry, T)  # (k, n, 3)
    d = np.linalg.norm(v, axis=-1, keepdims=True)
    z = np.divide(v, d, out=np.zeros_like(v), where=d > 0.0)
    Rm = geometry.m @ T[:, :3, :3].transpose(0, 2, 1)
    J = np.concatenate((z, np.cross(Rm, z)), axis=-1)
    return J if is_many(poses) else J[0]


@checked
def homogenised(geometry: Geometry, poses: PoseLike, dexterity: Dexterity = DEFAULT) -> Array:
    """``J_h = [J1, J2 / L]``, Eq. 7: dimensionless, (k, n, 6) or (n, 6).

    Raises:
        InvalidTarget: Not poses.
    """
    J = jacobian(geometry, poses)
    J[..., 3:] /= characteristic_length(geometry, poses, dexterity)
    return J
