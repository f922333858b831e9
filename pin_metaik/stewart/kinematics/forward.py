"""Forward kinematics: the poses at which the legs have given coordinates, by Newton on the inverse kinematics.

While the servos of a platform are held, its rods are legs of known lengths that begin at the known tips of its horns:
forward kinematics of servos is that of slides with other base joints (``held``), and has the same assemblies.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidConfiguration
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
    """Poses found for coordinates of the legs.

    Attributes:
        poses: (k, 4, 4) poses of P in the base frame; where not solved, the last one tried.
        states: (k,) a ``ForwardStatus`` for each.
        errors: Largest error of the length of a leg, or of a rod, m (k,).
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
def forward(geometry: Geometry, coordinates: ArrayLike, start: PoseLike | None = None) -> Forward:
    """A pose at which the legs have these lengths, or their servos these angles, by Newton's method from a start.

    The branch of a servo follows from the pose found; its angle does not determine it.

    With fewer than six legs the pose is not determined: each step is the shortest one, with a radian weighted as one
    platform radius.

    Args:
        geometry: The platform.
        coordinates: Lengths in m, or angles in rad: (n,) for one pose, (k, n) for many.
        start: Where to start: one pose for all or one each. Default: level above the base, at the links' mean height.

    Raises:
        InvalidConfiguration: Coordinates of the wrong shape or not finite, or lengths that are not above zero.
        InvalidTarget: The start is not a pose, or there are not as many starts as rows of coordinates.
    """
    q = as_coordinates(geometry, coordinates)
    T = level(geometry, q) if start is None else as_poses(start)
    if len(T) not in (1, len(q)):
        raise InvalidConfiguration(f"{len(q)} sets of {_words(geometry)} need one start or {len(q)}, got {len(T)}")
    return newton(geometry, q, np.ascontiguousarray(np.broadcast_to(T, (len(q), 4, 4))).copy())


def newton(geometry: Geometry, q: Array, T: Array) -> Forward:
    """Newton from poses (k, 4, 4), in place, to coordinates (k, n)."""
    held, rods = geometry.actuation.held(geometry.b, q)
    starts, d = np.array(held, order="C"), np.array(rods, order="C")  # writable, as the loop wants them
    iterations, errors, states = np.zeros(len(q), dtype=np.int64), np.zeros(len(q)), np.zeros(len(q), dtype=np.int8)
    tolerance = TOLERANCE * float(d.max(initial=0.0))
    platform_anchors, scale = geometry.arrays[1], geometry.platform_radius
    load_newton().newton(starts, platform_anchors, d, scale, tolerance, ITERATIONS, T, iterations, errors, states)
    return Forward(T, states, errors, iterations)


def as_coordinates(geometry: Geometry, coordinates: ArrayLike) -> Array:
    """Coordinates (k, n): lengths in m, or angles in rad.

    Raises:
        InvalidConfiguration: Of the wrong shape, not finite, or lengths that are not above zero.
    """
    try:
        q = np.array(coordinates, dtype=float, ndmin=2, order="C")
    except (TypeError, ValueError, OverflowError):
        raise InvalidConfiguration(f"{_words(geometry)} are numbers, got {coordinates!r}") from None
    if q.ndim != 2 or q.shape[1] != geometry.n:
        raise InvalidConfiguration(
            f"{_words(geometry)} have shape ({geometry.n},) or (k, {geometry.n}), got {np.shape(coordinates)}"
        )
    fine = geometry.actuation.can_be(q)
    if not fine.all():
        least = "above zero and " if geometry.servos is None else ""
        raise InvalidConfiguration(f"{_words(geometry)} are {least}finite, got {q[~fine][0]}")
    return q


def level(geometry: Geometry, q: Array) -> Array:
    """Level poses (k, 4, 4) over the base, where the mean square of the links is right; else as high as the longest."""
    starts, d = geometry.actuation.held(geometry.b, q)
    offset = geometry.m - starts  # (k or 1, n, 3)
    across = (offset[..., :2] ** 2).sum(axis=-1).mean(axis=-1)
    square = (d**2).mean(axis=1) - across
    T = np.tile(np.eye(4), (len(q), 1, 1))
    T[:, 2, 3] = np.sqrt(np.where(square > 0.0, square, d.max(axis=1) ** 2)) - offset[..., 2].mean(axis=-1)
    return T


def _words(geometry: Geometry) -> str:
    return geometry.actuation.words.coordinates
