"""The straight between two corners: full acceleration, perhaps full speed, full braking."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arrays import Array
from pin_metaik.mobile.motion.vehicle import Vehicle

ROUNDING = 1e-12  # m; as much too short counts as long enough


def straight_time(length: ArrayLike, v0: ArrayLike, v1: ArrayLike, vehicle: Vehicle) -> Array:
    """Least time in s for straights (...) in m from speed v0 to v1 (...) in m/s; inf where they are too short."""
    s, v0, v1 = (np.asarray(v, dtype=float) for v in (length, v0, v1))
    a = vehicle.a_max
    vp = np.minimum(vehicle.v_max, np.sqrt((v0**2 + v1**2) / 2 + a * np.maximum(s, 0)))
    coast = np.maximum(s - (2 * vp**2 - v0**2 - v1**2) / (2 * a), 0)
    T = (2 * vp - v0 - v1) / a + np.divide(coast, vp, out=np.zeros(np.broadcast(coast, vp).shape), where=vp > 0)
    return np.where(s >= np.abs(v1**2 - v0**2) / (2 * a) - ROUNDING, T, np.inf)


def straight_phases(length: float, v0: float, v1: float, vehicle: Vehicle) -> list[tuple[float, float]]:
    """Durations (s) and accelerations (m/s^2) of the quickest way from speed v0 to v1 on a straight long enough."""
    a = vehicle.a_max
    vp = min(vehicle.v_max, math.sqrt((v0**2 + v1**2) / 2 + a * max(length, 0.0)))
    vp = max(vp, v0, v1)
    coast = max(length - (2 * vp**2 - v0**2 - v1**2) / (2 * a), 0.0)
    phases = (((vp - v0) / a, a), (coast / vp if vp > 0 else 0.0, 0.0), ((vp - v1) / a, -a))
    return [(time, acceleration) for time, acceleration in phases if time > 0]
