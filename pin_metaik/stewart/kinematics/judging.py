"""Judging poses: which the limits allow, on which side of a singularity they are, and how dexterous they are."""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.stewart.kernels.loading import load_judging
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits, lengths
from pin_metaik.stewart.platform.poses import PoseLike, as_poses

UNLIMITED = (0.0, np.inf, -1.0, -1.0, 0.0)
NO_LIMIT = -2.0  # cosine that no angle of a servo is below, however it is rounded


class Arguments(NamedTuple):
    """A platform and its limits as the compiled loops take them; see ``kernels.judging``."""

    base: Array
    platform_anchors: Array
    joint_axes: Array
    limits: Array
    servos: Array | None
    pairs: NDArray[np.int64]


def arguments_of(geometry: Geometry, limits: Limits | None) -> Arguments:
    """The arguments of the loops; without limits every pose is allowed that the legs can reach.

    Raises:
        InvalidGeometry: Limits of the other kind of legs, or a ``home`` at which a joint has no axis.
    """
    base, platform_anchors, pairs = geometry.arrays
    servos = _servo_rows(geometry, limits)
    if limits is None:
        return Arguments(base, platform_anchors, np.zeros((2, geometry.n, 3)), np.array(UNLIMITED), servos, pairs)
    return Arguments(base, platform_anchors, limits.joint_axes(geometry), _limits_row(geometry, limits), servos, pairs)


def judged(
    geometry: Geometry, limits: Limits | None, T: Array, length: float, norm: int
) -> tuple[NDArray[np.int8], Array]:
    """``PoseState`` and nu (k,) of poses (k, 4, 4), for a characteristic length and the code of a norm."""
    states, nu = np.empty(len(T), dtype=np.int8), np.empty(len(T))
    load_judging().judge_poses(*arguments_of(geometry, limits), T, length, norm, states, nu)
    return states, nu


@checked
def judge_poses(geometry: Geometry, limits: Limits, poses: PoseLike) -> NDArray[np.int8]:
    """A ``PoseState`` (k,) for each of the poses.

    Raises:
        InvalidTarget: Not poses.
        InvalidGeometry: Limits of the other kind of legs, or a ``home`` at which a joint has no axis.
    """
    return judged(geometry, limits, as_poses(poses), geometry.platform_radius, 0)[0]


def _limits_row(geometry: Geometry, limits: Limits) -> Array:
    """The limits (5,) as the compiled loops take them."""
    angles = [cos(angle) if angle < pi else -1.0 for angle in (limits.base_angle, limits.platform_angle)]
    return np.array([*lengths(limits, geometry), *angles, limits.distance])


def _servo_rows(geometry: Geometry, limits: Limits | None) -> Array | None:
    """Servos and the angles they may have as the compiled loops take them (n, 15); None for slides.

    After ``Servos.rows``: cosine and sine of the middle of these angles, and the cosine of half their range.
    """
    if geometry.servos is None:
        return None
    low, high = (-pi, pi) if limits is None else limits.span
    half = 0.5 * (high - low)
    middle = 0.5 * (low + high)
    ends = [cos(middle), sin(middle), cos(half) if half < pi else NO_LIMIT]
    return np.ascontiguousarray(np.column_stack((geometry.servos.rows, np.tile(ends, (geometry.n, 1)))))
