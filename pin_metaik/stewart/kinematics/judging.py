"""Judging poses: which the limits allow, on which side of a singularity they are, and how dexterous they are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.kernels.loading import load_judging
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits, limit_row, servo_rows
from pin_metaik.stewart.platform.poses import PoseLike, as_poses

UNLIMITED = (0.0, np.inf, -1.0, -1.0, 0.0)


class Arguments(NamedTuple):
    """A platform and its limits as the compiled loops take them; see ``kernels.judging``."""

    base: Array
    arms: Array
    sockets: Array
    limits: Array
    servos: Array | None
    pairs: NDArray[np.int64]


def arguments_of(geometry: Geometry, limits: Limits | None) -> Arguments:
    """The arguments of the loops; without limits every pose is allowed that the legs can reach.

    Raises:
        InvalidGeometry: Limits of another kind of legs, or a home that gives a joint no axis.
    """
    base, arms, pairs = geometry.arrays
    servos = servo_rows(geometry, limits)
    if limits is None:
        return Arguments(base, arms, np.zeros((2, geometry.n, 3)), np.array(UNLIMITED), servos, pairs)
    return Arguments(base, arms, limits.sockets(geometry), limit_row(limits, geometry), servos, pairs)


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
        InvalidGeometry: Limits of another kind of legs, or a home that gives a joint no axis.
    """
    return judged(geometry, limits, as_poses(poses), geometry.platform_radius, 0)[0]
