"""The Jacobian, Eq. 4-7: rates of the legs from the velocity of the platform; and its two kinds of singularities."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.stewart.kinematics.conditioning import DEFAULT, Dexterity, characteristic_length
from pin_metaik.stewart.kinematics.inverse import links_at
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many


@checked
def velocity_equation(geometry: Geometry, poses: PoseLike) -> tuple[Array, Array]:
    """A (k, n, 6) and B (k, n) with ``A (v, omega) = B q_dot`` (Gosselin and Angeles 1990); without k for one pose.

    Row i of A is ``[z_i, R m_i x z_i]`` with the unit vector z_i of the link: A (v, omega) is the rate at which the
    platform would stretch the link, B q_dot the rate at which its actuator moves along it. B is 1 for a linear
    actuator, and for a servo its horn times the transmission. Where an entry of B is 0, the leg is in a singularity of
    the first kind: seen along the axis, its rod is in line with its horn, where both branches meet and the platform
    cannot move further. Where det A = 0, the platform is in a singularity of the second kind: it can move while all
    actuators are held. NaN in B for a rod that does not reach.

    Raises:
        InvalidTarget: Not poses.
    """
    A, B = _equation(geometry, as_poses(poses))
    return (A, B) if is_many(poses) else (A[0], B[0])


def _equation(geometry: Geometry, T: Array) -> tuple[Array, Array]:
    """A (k, n, 6) and B (k, n) at poses (k, 4, 4)."""
    links = links_at(geometry, T)
    v = links.vectors  # (k, n, 3)
    d = np.linalg.norm(v, axis=-1, keepdims=True)
    z = np.divide(v, d, out=np.zeros_like(v), where=d > 0.0)
    Rm = geometry.m @ T[:, :3, :3].transpose(0, 2, 1)
    return np.concatenate((z, np.cross(Rm, z)), axis=-1), links.pushes


@checked
def jacobian(geometry: Geometry, poses: PoseLike) -> Array:
    """J (k, n, 6) with ``q_dot = J (v, omega)``, Eq. 4; (n, 6) for a single pose.

    v is the velocity of P and omega the angular velocity, both in the base frame, in m/s and rad/s. With linear
    actuators q_dot are the rates of their lengths, in m/s: row i is ``[z_i, R m_i x z_i]`` with the unit vector z_i of
    the leg; zeros for a leg of length zero. With servos they are the rates of their angles, in rad/s; infinite where a
    rod is in line with its horn, NaN where it does not reach.

    Raises:
        InvalidTarget: Not poses.
    """
    A, B = _equation(geometry, as_poses(poses))
    with np.errstate(divide="ignore", invalid="ignore"):
        J: Array = A / B[..., None]
    return J if is_many(poses) else J[0]


@checked
def transmission(geometry: Geometry, poses: PoseLike) -> Array:
    """Transmission of each servo to its rod, 0 to 1, (k, n); (n,) for one pose. Linear actuators always have 1.

    It is the cosine of the angle between the rod and the direction in which the tip of its horn moves: at 1 the horn
    pushes straight along its rod, at 0 the leg is in a singularity of the first kind. NaN for a rod that does not
    reach.

    Raises:
        InvalidTarget: Not poses.
    """
    shares = links_at(geometry, as_poses(poses)).transmission
    return shares if is_many(poses) else shares[0]


@checked
def homogenised(geometry: Geometry, poses: PoseLike, dexterity: Dexterity = DEFAULT) -> Array:
    """``J_h = [J1, J2 / L]``, Eq. 7: dimensionless, (k, n, 6) or (n, 6).

    Raises:
        InvalidTarget: Not poses.
    """
    J = jacobian(geometry, poses)
    J[..., 3:] /= characteristic_length(geometry, poses, dexterity)
    return J
