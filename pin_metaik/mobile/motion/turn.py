"""The turn at a corner, in closed form: constant speed, and a turning rate that rises, stays and falls.

The robot leaves the incoming line a tangent length ``alpha = v g(theta)`` before the corner and meets the outgoing one
as far behind it. Its curve is a piece of clothoid, perhaps an arc, and the clothoid backwards: curvature is continuous.
With a synchro-drive everything scales with the speed v, so ``g`` and ``e`` say all about the shape, and the time does
not depend on v. A differential drive turns the more slowly the faster it drives, so its curves at higher speeds have
longer arcs; what follows holds at each speed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fresnel

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.motion.vehicle import Vehicle


def lead_time(theta: ArrayLike, vehicle: Vehicle, v: ArrayLike = 0.0) -> Array:
    """``g(theta)`` in s: at speed v the turn begins ``v g`` before the corner and ends as far behind it.

    Args:
        theta: Angles (...) between the two lines, 0 to below pi, in rad.
        vehicle: The robot.
        v: Speeds (...), m/s; they matter to a differential drive only.

    Raises:
        InvalidGeometry: An angle outside [0, pi): a robot that turns back on the spot has no corner to round.
    """
    return _shape(theta, vehicle, v)[0]


def cut_time(theta: ArrayLike, vehicle: Vehicle, v: ArrayLike = 0.0) -> Array:
    """``e(theta)`` in s: at speed v the middle of the curve is ``v e`` from the corner.

    Args:
        theta: Angles (...), 0 to below pi, in rad.
        vehicle: The robot.
        v: Speeds (...), m/s; they matter to a differential drive only.

    Raises:
        InvalidGeometry: An angle outside [0, pi).
    """
    return _shape(theta, vehicle, v)[1]


def turn_time(theta: ArrayLike, vehicle: Vehicle, v: ArrayLike = 0.0) -> Array:
    """Time in s to turn through angles theta (...) in rad at speeds v (...), default on the spot."""
    turn = np.abs(np.asarray(theta, dtype=float))
    v_s, a_s = vehicle.omega_at(v), vehicle.alpha_max
    return np.asarray(np.where(turn <= v_s**2 / a_s, 2 * np.sqrt(turn / a_s), turn / v_s + v_s / a_s))


def turn_phases(theta: float, vehicle: Vehicle, v: float = 0.0) -> list[tuple[float, float]]:
    """Durations (s) and angular accelerations (rad/s^2) that turn through theta (rad) at v, to the left above zero."""
    omega = float(vehicle.omega_at(v))
    half = min(abs(theta) / 2, omega**2 / vehicle.alpha_max / 2)
    rise = math.sqrt(2 * half / vehicle.alpha_max)
    steady = (abs(theta) - 2 * half) / omega
    alpha = math.copysign(vehicle.alpha_max, theta)
    return [(time, a) for time, a in ((rise, alpha), (steady, 0.0), (rise, -alpha)) if time > 0]


def turn_shape(theta: float, vehicle: Vehicle, v: float = 0.0, count: int = 257) -> Array:
    """Points (count, 2) of the curve at speed v, per m/s: the corner at the origin, coming along x, turning left.

    It is v times as large. With an odd count the point nearest to the corner is among them.
    """
    g = float(lead_time(theta, vehicle, v))
    phases = turn_phases(theta, vehicle, v)
    t = np.linspace(0, sum(duration for duration, _ in phases), count)
    z = np.full(count, complex(-g, 0.0))
    heading = omega = 0.0
    for duration, alpha in phases:
        z += clothoid(heading, omega, alpha, np.clip(t, 0, duration))
        heading += omega * duration + alpha * duration**2 / 2
        omega += alpha * duration
        t = t - duration
    return np.column_stack((z.real, z.imag))


def clothoid(theta: ArrayLike, omega: ArrayLike, alpha: ArrayLike, t: ArrayLike) -> np.ndarray:
    """``integral of exp(i (theta + omega s + alpha s^2 / 2)) ds`` from 0 to t: the way of a robot at speed 1.

    Args:
        theta: Heading at the beginning (...), rad.
        omega: Turning rate at the beginning (...), rad/s.
        alpha: Angular acceleration (...), rad/s^2.
        t: Time (...), s.

    Returns:
        Displacements x + i y (...), complex, in m for a speed of 1 m/s.
    """
    shape = np.broadcast(theta, omega, alpha, t).shape
    theta, omega, alpha, t = (np.broadcast_to(v, shape).ravel() for v in (theta, omega, alpha, t))
    bends, arcs = alpha != 0, (alpha == 0) & (omega != 0)
    z = t * np.exp(1j * theta)
    w = omega[arcs]
    z[arcs] = np.exp(1j * theta[arcs]) * (np.exp(1j * w * t[arcs]) - 1) / (1j * w)
    w, a = omega[bends], alpha[bends]
    k = np.sqrt(np.pi / np.abs(a))
    S0, C0 = fresnel(w / a / k)  # the square completed: alpha/2 (s + omega/alpha)^2
    S1, C1 = fresnel((t[bends] + w / a) / k)
    phase = theta[bends] - w**2 / (2 * a)
    z[bends] = k * np.exp(1j * phase) * ((C1 - C0) + 1j * np.sign(a) * (S1 - S0))
    return z.reshape(shape)


def _shape(theta: ArrayLike, vehicle: Vehicle, v: ArrayLike) -> tuple[Array, Array]:
    """g and e (...), by Fresnel integrals of the rising half of the turn."""
    theta = np.asarray(theta, dtype=float)
    if not np.all((theta >= 0) & (theta < np.pi)):
        raise InvalidGeometry(
            f"a turn is an angle from 0 to below pi (180 degrees), got {theta}: the robot can turn back on the spot"
        )
    v_s, a_s = vehicle.omega_at(v), vehicle.alpha_max
    h = theta / 2
    th1 = np.minimum(h, v_s**2 / (2 * a_s))
    t1 = np.sqrt(2 * th1 / a_s)
    k = math.sqrt(math.pi / a_s)
    S, C = fresnel(t1 / k)
    Cs, Ss = k * C, k * S
    g = Cs + np.tan(h) * Ss + np.sin(h - th1) / (v_s * np.cos(h))
    sagitta = np.sin(h) * Cs - np.cos(h) * Ss + (1 - np.cos(h - th1)) / v_s
    return g, g * np.sin(h) - sagitta
