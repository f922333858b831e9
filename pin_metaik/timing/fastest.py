"""The quickest motion along a curve within limits of speed and acceleration, by toppra."""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import need
from pin_metaik.timing.curve import JointCurve, roots
from pin_metaik.timing.limits import MotionLimits
from pin_metaik.timing.profile import SteppedProfile

PLACES, LEAST = 1000, 5  # of the grid in all, at least, and between two points
BEFORE = 1e-6  # of the way between two points


def fastest(curve: JointCurve, limits: MotionLimits) -> SteppedProfile:
    """The quickest profile that keeps speeds and accelerations (Pham and Pham 2018), from rest to rest.

    Toppra looks at the places of a grid; what lies between them is looked at here, exactly, and all is slowed down by
    the little that is needed for no joint to exceed its limits anywhere.

    Raises:
        MissingExtra: toppra is not installed.
        InvalidSetting: toppra finds no profile.
    """
    need("timing a path", "timing", "toppra")
    from toppra.algorithm import TOPPRA
    from toppra.constraint import JointAccelerationConstraint, JointVelocityConstraint

    logging.getLogger("toppra").setLevel(logging.ERROR)
    grid = _grid(curve)
    constraints = [
        JointVelocityConstraint(np.column_stack([-limits.velocity, limits.velocity])),
        JointAccelerationConstraint(np.column_stack([-limits.acceleration, limits.acceleration])),
    ]
    solver = TOPPRA(constraints, _Path(curve), gridpoints=grid, parametrizer="ParametrizeConstAccel")
    _, speeds, _ = solver.compute_parameterization(0.0, 0.0)
    if speeds is None or not np.isfinite(speeds).all():
        raise InvalidSetting("toppra finds no motion along this path within the limits")
    profile = SteppedProfile(grid, speeds)
    return profile.slowed(_excess(curve, profile, limits))


class _Path:
    """A curve as toppra takes it."""

    waypoints = None

    def __init__(self, curve: JointCurve) -> None:
        self._curve = curve
        self.dof = curve.pieces.shape[2]
        self.path_interval = np.array([0.0, curve.length])

    def __call__(self, s: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
        return self._curve(s, order)


def _grid(curve: JointCurve) -> NDArray[np.float64]:
    """Places with all points among them, evenly between two; and just before those where a second derivative jumps."""
    knots = curve.knots
    parts = max(LEAST, -(-PLACES // (len(knots) - 1)))
    inner = knots[:-1, None] + np.diff(knots)[:, None] * np.arange(parts) / parts
    before = knots[1:-1] - BEFORE * np.diff(knots)[:-1] if curve.bent else knots[:0]
    return np.sort(np.concatenate([inner.ravel(), before, knots[-1:]]))


def _excess(curve: JointCurve, profile: SteppedProfile, limits: MotionLimits) -> float:
    """How many times slower a profile must be for no speed and no acceleration to exceed its limit; at least 1.

    Between two places of the grid x'' = q''(s) v^2 + q'(s) a is a polynomial in s of degree 2, with v^2 = v0^2 + 2 a s;
    a speed q'(s) v is largest at one of the two, or where x'' = 0.
    """
    grid, a, square = profile.grid, profile.accelerations[:, None], np.square(profile.speeds[:-1, None])
    piece = np.searchsorted(curve.knots, grid[:-1], side="right") - 1
    along = (grid[:-1] - curve.knots[piece])[:, None]
    width = np.diff(grid)[:, None]
    third = 6.0 * curve.pieces[0, piece]
    second = 2.0 * curve.pieces[1, piece] + third * along
    first = curve.pieces[2, piece] + along * (2.0 * curve.pieces[1, piece] + 0.5 * third * along)
    c = 2.5 * third * a, third * square + 3.0 * second * a, second * square + first * a
    with np.errstate(all="ignore"):
        vertex = np.nan_to_num(-c[1] / (2.0 * c[0]), nan=0.0, posinf=0.0, neginf=0.0)
    at = np.stack([np.zeros_like(first), np.broadcast_to(width, first.shape), *roots(*c), vertex])
    at = np.clip(at, 0.0, width)
    speeds = (first + at * (second + 0.5 * third * at)) * np.sqrt(np.maximum(square + 2.0 * a * at, 0.0))
    accelerations = c[2] + at * (c[1] + c[0] * at)
    fastest, hardest = np.abs(speeds).max(axis=(0, 1)), np.abs(accelerations).max(axis=(0, 1))
    factor = max((fastest / limits.velocity).max(), np.sqrt((hardest / limits.acceleration).max()), 1.0)
    return float(factor * (1.0 + 1e-12))
