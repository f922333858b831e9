"""Forward kinematics: the poses at which the legs have given lengths, by Newton on the inverse kinematics."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidConfiguration, InvalidGeometry, InvalidSetting
from pin_metaik.optimize.space import Array
from pin_metaik.randomness import as_generator
from pin_metaik.stewart.geometry import MOST_LEGS, Geometry
from pin_metaik.stewart.loading import load_newton
from pin_metaik.stewart.poses import PoseLike, as_poses

TOLERANCE = 1e-13  # of the longest leg: a few roundings
ITERATIONS = 60
MOST = 40  # assemblies six legs can have (Ronga and Vust 1995), unless the platform can move with its legs held
BATCH = 256  # random starts at a time when all assemblies are looked for
PATIENCE = 4  # batches that must bring nothing new
SAME = 1e-6  # two poses nearer than this, in rad and in platform radii, are one


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
    d = _lengths(geometry, lengths)
    T = _level(geometry, d) if start is None else as_poses(start)
    if len(T) not in (1, len(d)):
        raise InvalidConfiguration(f"{len(d)} sets of leg lengths need one start or {len(d)}, got {len(T)}")
    return _newton(geometry, d, np.ascontiguousarray(np.broadcast_to(T, (len(d), 4, 4))).copy())


@checked
def all_forward(geometry: Geometry, lengths: ArrayLike, rng: int | np.random.Generator | None = 0) -> Array:
    """Every pose found (s, 4, 4) at which six legs have these lengths, highest first; s is 0 ... 40.

    Newton from random starts, until four batches of them in a row bring nothing new. A platform whose joints lie in
    planes has a mirror image below the base for every assembly above it.

    Args:
        geometry: A platform with six legs.
        lengths: (6,) in m.
        rng: Seed or generator of the starts; the same seed gives the same poses.

    Raises:
        InvalidConfiguration: Lengths of the wrong shape or not above zero.
        InvalidSetting: Fewer than six legs: their poses are not separate.
        InvalidGeometry: A singular mechanism: its platform moves while the legs are held.
    """
    if geometry.n < MOST_LEGS:
        raise InvalidSetting(f"{geometry.n} legs leave {MOST_LEGS - geometry.n} freedoms: their poses are not separate")
    d = _lengths(geometry, lengths)
    if len(d) != 1:
        raise InvalidConfiguration(f"all assemblies are found for one set of leg lengths, got {len(d)}")
    generator = as_generator(rng)
    found = np.empty((0, 4, 4))
    barren = 0
    while barren < PATIENCE:
        result = _newton(geometry, np.repeat(d, BATCH, axis=0), _random(geometry, d, generator))
        fresh = [found]
        for pose in result.poses[result.solved]:
            if not _known(pose, np.concatenate(fresh), geometry.platform_radius):
                fresh.append(pose[None])
        if sum(map(len, fresh)) > MOST or (result.states == ForwardStatus.SINGULAR).all():
            raise InvalidGeometry("this mechanism is singular: its platform moves while these legs are held")
        barren = barren + 1 if len(fresh) == 1 else 0
        found = np.concatenate(fresh)
    return found[np.lexsort((found[:, 0, 3], found[:, 1, 3], -found[:, 2, 3].round(9)))]


def _newton(geometry: Geometry, d: Array, T: Array) -> Forward:
    b, m, _ = geometry.arrays
    iterations, errors, states = np.zeros(len(d), dtype=np.int64), np.zeros(len(d)), np.zeros(len(d), dtype=np.int8)
    tolerance = TOLERANCE * float(d.max(initial=0.0))
    load_newton().newton(b, m, d, geometry.platform_radius, tolerance, ITERATIONS, T, iterations, errors, states)
    return Forward(T, states, errors, iterations)


def _lengths(geometry: Geometry, lengths: ArrayLike) -> Array:
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


def _random(geometry: Geometry, d: Array, rng: np.random.Generator) -> Array:
    """Random poses (BATCH, 4, 4) in the ball that the longest leg sweeps, in any orientation."""
    T = np.tile(np.eye(4), (BATCH, 1, 1))
    quaternions = rng.standard_normal((BATCH, 4))
    for k, quaternion in enumerate(quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)):
        T[k, :3, :3] = pin.Quaternion(quaternion).matrix()
    reach = d.max() + np.linalg.norm(geometry.m, axis=1).max()
    T[:, :3, 3] = geometry.b.mean(axis=0) + rng.uniform(-reach, reach, (BATCH, 3))
    return T


def _known(pose: Array, poses: Array, size: float) -> bool:
    """Whether a pose is among these (s, 4, 4): matrix entries differ by the angle at most."""
    near = (np.abs(poses[:, :3, :3] - pose[:3, :3]) < SAME).all(axis=(1, 2))
    near &= (np.abs(poses[:, :3, 3] - pose[:3, 3]) < SAME * size).all(axis=1)
    return bool(near.any())
