"""Forward kinematics: the poses at which the legs have given lengths, by Newton on the inverse kinematics."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.kernels.loading import load_newton
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses

TOLERANCE = 1e-13  # of the longest leg: a few roundings
ITERATIONS = 60


class ForwardStatus(IntEnum):
    """How a forward kinematics ended."""

    SOLVED = 1
    """The legs have their lengths."""
    SINGULAR = 2
    """It ran into a singular pose."""
    NOT_CONVERGED = 3
    """No pose found: none near the start, or none at all."""


@dataclass(frozen=True, eq=False)
class Forward:
    """Poses found for leg lengths.

    Attributes:
        poses: (k, 4, 4) poses of P in the base frame; where not solved, the last one tried.
        states: A ``ForwardStatus`` each (k,).
        errors: Largest error of a leg, m (k,).
        iterations: Newton steps taken (k,).
    """

    poses: Array
    states: NDArray[np.int8]
    errors: Array
    iterations: NDArray[np.int64]

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which were solved (k,)."""
        solved: NDArray[np.bool_] = self.states == ForwardStatus.SOLVED
        return solved

    @property
    def pose(self) -> Array:
        """The first, or only, pose (4, 4)."""
        pose: Array = self.poses[0]
        return pose

    @property
    def status(self) -> ForwardStatus:
        """How the first, or only, one ended."""
        return ForwardStatus(int(self.states[0]))


@checked
def forward(geometry: Geometry, lengths: ArrayLike, start: PoseLike | None = None) -> Forward:
    """The pose nearest to the start, in Newton's sense, at which the legs have these lengths.

    With fewer than six legs the lengths leave freedoms: steps are the shortest ones, a radian counting as a platform
    radius.

    Args:
        geometry: The platform.
        lengths: In m: (n,) for one pose, (k, n) for many.
        start: Where to start: one pose for all or one each. Default: level above the base, at the lengths' mean height.

    Raises:
        InvalidConfiguration: Lengths of the wrong shape or not above zero.
        InvalidTarget: The start is not a pose, or starts are not as many as the lengths.
    """
    d = as_lengths(geometry, lengths)
    T = _level(geometry, d) if start is None else as_poses(start)
    if len(T) not in (1, len(d)):
        raise InvalidConfiguration(f"{len(d)} sets of leg lengths need one start or {len(d)}, got {len(T)}")
    return newton(geometry, d, np.ascontiguousarray(np.broadcast_to(T, (len(d), 4, 4))).copy())


def newton(geometry: Geometry, d: Array, T: Array) -> Forward:
    """Newton from poses (k, 4, 4), in place, to leg lengths (k, n)."""
    b, m, _ = geometry.arrays
    iterations, errors, states = np.zeros(len(d), dtype=np.int64), np.zeros(len(d)), np.zeros(len(d), dtype=np.int8)
    tolerance = TOLERANCE * float(d.max(initial=0.0))
    load_newton().newton(b, m, d, geometry.platform_radius, tolerance, ITERATIONS, T, iterations, errors, states)
    return Forward(T, states, errors, iterations)


def as_lengths(geometry: Geometry, lengths: ArrayLike) -> Array:
    """Leg lengths (k, n) in m.

    Raises:
        InvalidConfiguration: Of the wrong shape, or not above zero.
    """
    try:
        d = np.array(lengths, dtype=float, ndmin=2, order="C")
    except (TypeError, ValueError, OverflowError):
        raise InvalidConfiguration(f"leg lengths are numbers in m, got {lengths!r}") from None
    if d.ndim != 2 or d.shape[1] != geometry.n:
        raise InvalidConfiguration(
            f"leg lengths have shape ({geometry.n},) or (k, {geometry.n}), got {np.shape(lengths)}"
        )
    if not (np.isfinite(d) & (d > 0.0)).all():
        raise InvalidConfiguration(f"leg lengths are above zero and finite, got {d[~(np.isfinite(d) & (d > 0.0))][0]}")
    return d


def _level(geometry: Geometry, d: Array) -> Array:
    """Level poses (k, 4, 4) over the base, where the mean square of the legs is right; else as high as the longest."""
    offset = geometry.m - geometry.b
    across = (offset[:, :2] ** 2).sum(axis=1).mean()
    square = (d**2).mean(axis=1) - across
    T = np.tile(np.eye(4), (len(d), 1, 1))
    T[:, 2, 3] = np.sqrt(np.where(square > 0.0, square, d.max(axis=1) ** 2)) - offset[:, 2].mean()
    return T
