"""Poses over time, and the legs along them: lengths, rates, limits, conditioning."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.optimize.settings import few, within
from pin_metaik.stewart.kinematics.conditioning import DEFAULT, Dexterity, characteristic_length, measure
from pin_metaik.stewart.kinematics.inverse import links_at
from pin_metaik.stewart.kinematics.jacobian import jacobian
from pin_metaik.stewart.kinematics.judging import judge_poses
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, one_pose
from pin_metaik.stewart.platform.states import PoseState


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Trajectory:
    """Poses of P in the base frame at ascending times.

    Attributes:
        times: (k,) in s, k >= 2.
        poses: (k, 4, 4).
        twists: Velocity of P in m/s and angular velocity in rad/s, both in the base frame (k, 6).

    Raises:
        InvalidTarget: Fewer than two poses, times that do not ascend, or not as many times and twists as poses.
    """

    times: Array
    poses: Array
    twists: Array

    def __post_init__(self) -> None:
        times, poses = np.array(self.times, dtype=float), as_poses(self.poses)
        if times.shape != (len(poses),) or len(times) < 2:
            raise InvalidTarget(
                f"a trajectory has two or more poses and a time each, got {len(poses)} and {times.shape}"
            )
        if not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
            raise InvalidTarget("the times of a trajectory ascend")
        twists = np.array(self.twists, dtype=float)
        if twists.shape != (len(poses), 6) or not np.isfinite(twists).all():
            raise InvalidTarget(f"twists are {len(poses)} rows of six finite numbers, got shape {twists.shape}")
        for name, value in (("times", times), ("poses", poses), ("twists", twists)):
            object.__setattr__(self, name, value)

    @classmethod
    @checked
    def through(cls, times: ArrayLike, poses: PoseLike) -> Trajectory:
        """A trajectory through poses (k, 4, 4) at times (k,) in s; twists are central differences of the poses.

        Raises:
            InvalidTarget: As for the class.
        """
        at, T = array("the times of a trajectory", times, "k", error=InvalidTarget), as_poses(poses)
        steady = len(T) > 1 and at.shape == (len(T),) and bool((np.diff(at) > 0.0).all())
        return cls(at, T, _differences(at, T) if steady else np.zeros((len(T), 6)))  # the class says what is wrong

    @checked
    def at(self, times: ArrayLike) -> Array:
        """Poses (j, 4, 4) at times (j,) in s, interpolated along straight lines and shortest rotations."""
        given = array(
            "times", np.atleast_1d(array("times", times, "...", error=InvalidTarget)), "j", error=InvalidTarget
        )
        t = np.clip(given, self.times[0], self.times[-1])
        after = np.clip(np.searchsorted(self.times, t, side="right"), 1, len(self.times) - 1)
        share = (t - self.times[after - 1]) / (self.times[after] - self.times[after - 1])
        poses = [
            between(self.poses[k - 1], self.poses[k], s) for k, s in zip(after.tolist(), share.tolist(), strict=True)
        ]
        return np.array(poses).reshape(-1, 4, 4)


@checked
def straight(start: PoseLike, end: PoseLike, seconds: float, samples: int = 101) -> Trajectory:
    """A trajectory from rest to rest along a straight line, turning about one axis, with a quintic time law.

    Args:
        start: First pose.
        end: Last pose.
        seconds: How long it takes.
        samples: How many poses.

    Raises:
        InvalidTarget: Not poses.
        InvalidSetting: No time, or fewer than two samples.
    """
    within("seconds", seconds, 1e-9)
    few("samples", samples, 2)
    first, last = one_pose(start), one_pose(end)
    u = np.linspace(0.0, 1.0, samples)
    s, s_dot = u**3 * (10 - 15 * u + 6 * u**2), 30 * (u - u**2) ** 2 / seconds
    turn = first[:3, :3] @ pin.log3(first[:3, :3].T @ last[:3, :3])  # rotation vector in the base frame
    twist = np.concatenate((last[:3, 3] - first[:3, 3], turn))
    return Trajectory(seconds * u, np.stack([between(first, last, share) for share in s]), s_dot[:, None] * twist)


def between(first: Array, last: Array, share: float) -> Array:
    """The pose (4, 4) at this share of the straight way from one to another."""
    pose = first + share * (last - first)
    pose[:3, :3] = first[:3, :3] @ pin.exp3(share * pin.log3(first[:3, :3].T @ last[:3, :3]))
    return pose


@dataclass(frozen=True, eq=False)
class Motion:
    """The legs along a trajectory.

    Attributes:
        geometry: The platform.
        trajectory: The poses over time.
        coordinates: Coordinates of the legs (k, n): lengths in m, or servo angles in rad, NaN where a rod does not
            reach.
        rates: Rates of the coordinates, m/s or rad/s (k, n).
        nu: Local conditioning index (k,); 0 where singular.
        states: (k,) a ``PoseState`` for each: whether the limits allow it, and on which side of a singularity it is.
        length: Characteristic length of nu, m.
        speed: Largest rate of a leg, m/s or rad/s; None if not limited.
    """

    geometry: Geometry
    trajectory: Trajectory
    coordinates: Array
    rates: Array
    nu: Array
    states: NDArray[np.int8]
    length: float
    speed: float | None = None

    @property
    def too_fast(self) -> NDArray[np.bool_]:
        """(k,) at which poses a leg is faster than its limit."""
        limit = np.inf if self.speed is None else self.speed
        fast: NDArray[np.bool_] = np.abs(self.rates).max(axis=1) > limit * (1.0 + 1e-12)
        return fast

    @property
    def fastest(self) -> float:
        """The greatest rate of a leg at the samples that are reached, m/s or rad/s; 0 if none is."""
        return float(np.abs(self.rates).max(initial=0.0, where=~np.isnan(self.rates)))

    @property
    def least_seconds(self) -> float | None:
        """Least duration of this path at which no leg is too fast at a sample, s; None without a limit on speed."""
        if self.speed is None:
            return None
        times = self.trajectory.times
        return float((times[-1] - times[0]) * self.fastest / self.speed)

    @property
    def reached(self) -> NDArray[np.bool_]:
        """(k,) which poses the limits allow."""
        reached: NDArray[np.bool_] = (self.states >= PoseState.POSITIVE) & (self.states <= PoseState.SINGULAR)
        return reached

    @property
    def lengths(self) -> Array:
        """Lengths of the legs, m (k, n): the coordinates of linear actuators."""
        return self.coordinates

    @property
    def stroke(self) -> Array:
        """Difference (n,) between the greatest and the least coordinate of each leg, m or rad."""
        stroke: Array = np.ptp(self.coordinates, axis=0)
        return stroke


@checked
def follow(
    geometry: Geometry, trajectory: Trajectory, limits: Limits | None = None, dexterity: Dexterity = DEFAULT
) -> Motion:
    """Move a platform along a trajectory: inverse kinematics, rates ``J (v, omega)``, nu and limits at every sample.

    Args:
        geometry: The platform.
        trajectory: The trajectory.
        limits: Limits of the legs; without them every pose is allowed.
        dexterity: How to measure nu.
    """
    T = trajectory.poses
    length = characteristic_length(geometry, T, dexterity)
    nu, states = measure(geometry, T, length, dexterity.norm)
    if limits is not None:
        states = judge_poses(geometry, limits, T)
    with np.errstate(invalid="ignore"):  # of a servo that does not reach
        rates = (jacobian(geometry, T) @ trajectory.twists[:, :, None])[..., 0]  # q_dot = J (v, omega)
    speed = None if limits is None else limits.speed
    return Motion(geometry, trajectory, links_at(geometry, T).coordinates, rates, nu, states, length, speed)


def _differences(times: Array, poses: Array) -> Array:
    """Twists (k, 6) between the neighbours of each pose; at both ends between it and its only neighbour."""
    k = np.arange(len(times))
    before, after = np.maximum(k - 1, 0), np.minimum(k + 1, len(times) - 1)
    turns = [
        poses[i, :3, :3] @ pin.log3(poses[i, :3, :3].T @ poses[j, :3, :3]) for i, j in zip(before, after, strict=True)
    ]
    moved = np.concatenate((poses[after, :3, 3] - poses[before, :3, 3], np.array(turns)), axis=1)
    twists: Array = moved / (times[after] - times[before])[:, None]
    return twists
