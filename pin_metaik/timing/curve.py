"""A smooth curve through configurations, and the largest values of its derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.kinematics import Limits

APART = 1e-9  # s at full speed; points nearer to each other than this are one
ROOM = 1e-9  # rad or m beyond a limit that is rounding


@dataclass(frozen=True, eq=False)
class JointCurve:
    """A piecewise cubic curve x(s) of n joint coordinates, 0 <= s <= length.

    Attributes:
        knots: (k,) the places s of the points; s counts seconds, as if all joints could go at full speed throughout.
        pieces: (4, k - 1, n) coefficients of (s - knot)^3, ..., 1.
        bent: The joints whose second derivative jumps at the points.
    """

    knots: NDArray[np.float64]
    pieces: NDArray[np.float64]
    bent: tuple[int, ...] = ()

    @staticmethod
    def through(x: NDArray[np.float64], limits: Limits, speeds: NDArray[np.float64]) -> JointCurve:
        """The curve through points x (p, n): a cubic spline, whose second derivatives are continuous.

        A joint that would leave its limits between the points has monotone pieces instead (Fritsch and Carlson 1980):
        they stay in the range of their two points, and only first derivatives are continuous.

        Args:
            x: The points; those that repeat the one before are left out.
            limits: Of the joints.
            speeds: (n,) their greatest speeds, which say how far apart points are.

        Raises:
            InvalidSetting: All points are one.
        """
        from scipy.interpolate import CubicSpline, PchipInterpolator

        lengths = np.linalg.norm(np.diff(x, axis=0) / speeds, axis=1)
        kept = np.concatenate([[True], lengths > APART])
        if not kept[1:].any():
            raise InvalidSetting("a timed path leads from one configuration to another; all of these are the same")
        knots, points = np.concatenate([[0.0], np.cumsum(lengths[kept[1:]])]), x[kept]
        pieces = CubicSpline(knots, points).c
        values = _values(pieces, np.diff(knots))
        leaving = (values.min(axis=(0, 1)) < limits.lower - ROOM) | (values.max(axis=(0, 1)) > limits.upper + ROOM)
        if leaving.any():
            pieces[..., leaving] = PchipInterpolator(knots, points[:, leaving]).c
        return JointCurve(knots, pieces, tuple(np.flatnonzero(leaving).tolist()))

    @property
    def length(self) -> float:
        """Where it ends, s."""
        return float(self.knots[-1])

    def __call__(self, s: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
        """Points, or derivatives by s of an order up to 3, (..., n) at places s (...)."""
        piece = np.clip(np.searchsorted(self.knots, s, side="right") - 1, 0, len(self.knots) - 2)
        c = self.derivative(order)[:, piece]
        along = (np.asarray(s) - self.knots[piece])[..., None]
        value: NDArray[np.float64] = c[0]
        for one in c[1:]:
            value = value * along + one
        return value

    def derivative(self, order: int) -> NDArray[np.float64]:
        """Coefficients (4 - order, k - 1, n) of a derivative."""
        c = self.pieces
        for _ in range(order):
            c = c[:-1] * np.arange(len(c) - 1, 0, -1)[:, None, None]
        return c

    def largest(self, order: int) -> NDArray[np.float64]:
        """The largest absolute value (n,) of a derivative by s, of order 1 to 3."""
        values: NDArray[np.float64] = np.abs(_values(self.derivative(order), np.diff(self.knots))).max(axis=(0, 1))
        return values


def _values(c: NDArray[np.float64], widths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (e, k, n) of polynomials (degree + 1, k, n) on [0, width], with the least and the largest among them."""
    width = widths[:, None]
    slope = np.zeros((3, *c.shape[1:]))
    degree = len(c) - 1
    for i in range(degree):
        slope[3 - degree + i] = c[i] * (degree - i)
    at = np.stack([np.zeros(c.shape[1:]), np.broadcast_to(width, c.shape[1:]), *np.clip(roots(*slope), 0.0, width)])
    values = np.broadcast_to(c[0], at.shape)
    for one in c[1:]:
        values = values * at + one
    return values


def roots(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> NDArray[np.float64]:
    """The real roots (2, ...) of a x^2 + b x + c, without loss of digits; 0 where there is none."""
    with np.errstate(all="ignore"):
        half = -0.5 * (b + np.copysign(np.sqrt(b * b - 4.0 * a * c), b))
        both = np.stack([half / a, c / half])
    both[~np.isfinite(both)] = 0.0
    return both
