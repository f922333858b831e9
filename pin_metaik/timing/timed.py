"""Timed paths: motions along a path within the limits of the joints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, instance
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidConfiguration, InvalidSetting
from pin_metaik.figures import picture_file, save_picture
from pin_metaik.kinematics import Chain
from pin_metaik.optimize.settings import within
from pin_metaik.output import write_table
from pin_metaik.plain import fields_of
from pin_metaik.ros import LAST_STAMP, header, message_file, time, write_message
from pin_metaik.timing.curve import JointCurve
from pin_metaik.timing.fastest import fastest
from pin_metaik.timing.limits import MotionLimits, Share
from pin_metaik.timing.profile import Profile
from pin_metaik.timing.smooth import smooth

EVERY = 0.01  # s
MANY = 1_000_000  # samples of one call
NUDGE = 1e-5  # s, of the difference that tip speeds are
MESSAGE = "trajectory_msgs/JointTrajectory"


@dataclass(frozen=True, eq=False)
class TimedSamples:
    """A motion at k times.

    Attributes:
        t: (k,) s.
        q: (k, nq) configurations.
        x: (k, n) the chain's coordinates, rad or m; those of continuous joints run on through whole turns.
        v: (k, n) their speeds, rad/s or m/s.
        a: (k, n) their accelerations, rad/s^2 or m/s^2.
        tip_speed: (k, T) speed of each frame's origin in the world, m/s.
    """

    t: Array
    q: Array
    x: Array
    v: Array
    a: Array
    tip_speed: Array


@dataclass(frozen=True, eq=False)
class TimedPath:
    """A motion of a chain along configurations, from rest to rest.

    Between the configurations every joint follows a cubic spline; the frame then deviates from the straight line
    between its targets, the less the more configurations there are.

    Attributes:
        chain: The chain.
        limits: Limits that the motion keeps at every instant, not only at samples.
        curve: The coordinates along the path.
        profile: Position along the curve over time.
        base: (nq,) configuration with the values of the joints outside the chain.
    """

    chain: Chain
    limits: MotionLimits
    curve: JointCurve = field(repr=False)
    profile: Profile = field(repr=False)
    base: NDArray[np.float64] = field(repr=False)

    @property
    def duration(self) -> float:
        """Duration of the motion, s."""
        return self.profile.duration

    @checked
    def sample(self, every: float = EVERY) -> TimedSamples:
        """The motion at times from 0 on, and at its end.

        Args:
            every: Time between two samples, s; the last one may come sooner.

        Raises:
            InvalidSetting: If ``every`` is not above 0, or more than a million samples would be needed.
        """
        if not every > 0.0 or self.duration > MANY * every:
            raise InvalidSetting(
                f"every is above 0 s and makes at most {MANY:,} samples of {self.duration:g} s, got {every!r}"
            )
        count = math.ceil(self.duration / every * (1.0 - 1e-12))
        return self.at(np.append(every * np.arange(count), self.duration))

    @checked
    def at(self, t: ArrayLike) -> TimedSamples:
        """The motion at times t (k,), s; before its start and after its end it is at rest.

        Raises:
            InvalidSetting: If ``t`` is not a row of finite numbers.
        """
        times = array("t", t, "k")
        s, ds, dds = self.profile.at(np.clip(times, 0.0, self.duration))
        slope = self.curve(s, 1)
        x, v, a = self.curve(s), slope * ds[:, None], self.curve(s, 2) * np.square(ds)[:, None] + slope * dds[:, None]
        standing = (times < 0.0) | (times > self.duration)
        v[standing] = a[standing] = 0.0
        x = np.minimum(np.maximum(x, self.chain.limits.lower), self.chain.limits.upper)
        ahead, behind = (self.chain.poses(x + NUDGE * side * v)[..., :3, 3] for side in (1.0, -1.0))
        tip_speed = np.linalg.norm(ahead - behind, axis=2) / (2.0 * NUDGE)
        return TimedSamples(times, self.chain.q(x, self.base), x, v, a, tip_speed)

    def as_dict(self, every: float = EVERY) -> dict[str, Any]:
        """The samples as plain values, for JSON: lengths in m, angles in rad, times in s."""
        rows = fields_of(self.sample(every), "t", "q", "x", "v", "a", "tip_speed")
        return {"duration": self.duration, "joints": list(self.chain.names), "frames": list(self.chain.frames), **rows}

    @checked
    def write_csv(self, file: str | Path, every: float = EVERY) -> None:
        """Write the samples as CSV: time, coordinates, speeds and accelerations of the joints, speeds of the frames.

        Args:
            file: Where to.
            every: Between two samples, s.

        Raises:
            CannotWrite: The file cannot be written.
            InvalidSetting: See ``sample``.
        """
        one = self.sample(every)
        names = "t", *self._columns()
        write_table(file, names, np.column_stack([one.t, one.x, one.v, one.a, one.tip_speed]))

    def _columns(self) -> Iterator[str]:
        """Names of the columns after the time: the joint and the unit."""
        for power in ("", "/s", "/s^2"):
            for name, rotates in zip(self.chain.names, self.chain.limits.rotates.tolist(), strict=True):
                yield f"{name} {'rad' if rotates else 'm'}{power}"
        for frame in self.chain.frames:
            yield f"{frame} m/s"

    @checked
    def joint_trajectory(self, every: float = EVERY, *, frame: str = "", stamp: float = 0.0) -> dict[str, Any]:
        """The samples as the plain values of a ``trajectory_msgs/JointTrajectory``.

        Args:
            every: Between two points, s.
            frame: ``frame_id`` of the header.
            stamp: Time at which it begins, s since the ROS epoch; 0, which controllers take as: at once.

        Raises:
            InvalidSetting: A stamp below zero; see ``sample``.
        """
        within("stamp", stamp, 0, LAST_STAMP)
        one = self.sample(every)
        rows = zip(one.t.tolist(), one.x.tolist(), one.v.tolist(), one.a.tolist(), strict=True)
        return {
            "header": header(frame, stamp),
            "joint_names": list(self.chain.names),
            "points": [
                {"positions": x, "velocities": v, "accelerations": a, "effort": [], "time_from_start": time(t)}
                for t, x, v, a in rows
            ],
        }

    @checked
    def write_joint_trajectory(
        self, file: str | Path, every: float = EVERY, *, frame: str = "", stamp: float = 0.0
    ) -> None:
        """Write a ``trajectory_msgs/JointTrajectory``: ``.yaml`` or ``.json``; see ``joint_trajectory``.

        Raises:
            InvalidSetting: Another suffix; see ``joint_trajectory``.
            CannotWrite: The file cannot be written.
            MissingExtra: YAML is wanted and PyYAML is not installed.
        """
        where = message_file(file, MESSAGE)
        write_message(where, self.joint_trajectory(every, frame=frame, stamp=stamp))

    @checked
    def plot(self, file: str | Path) -> None:
        """Plot coordinates, speeds and accelerations with their limits, and the speeds of the frames, over time.

        Args:
            file: The file; its suffix gives the format (``.png``, ``.svg``, ``.pdf``).

        Raises:
            MissingExtra: matplotlib is not installed.
            InvalidSetting: Another suffix.
            CannotWrite: The file cannot be written.
        """
        from pin_metaik.timing.plots import draw_timed

        save_picture(draw_timed(self), picture_file(file))

    def __repr__(self) -> str:
        return f"TimedPath({self.duration:.3f} s along {len(self.curve.knots)} configurations of {self.chain!r})"


@checked
def time_path(
    chain: Chain, q: ArrayLike, *, velocity: Share = None, acceleration: Share = None, jerk: Share = None
) -> TimedPath:
    """Give a path times, so that the joints keep their limits at every time.

    Without ``jerk`` it is the quickest motion along the spline through the configurations, by toppra: at every time
    some joint is at a limit of speed or acceleration, and accelerations jump. With ``jerk`` accelerations change no
    faster than that, by ruckig: gentler on gears and controllers, and slower, as where the path bends most decides how
    fast all of it is gone along.

    Args:
        chain: The chain.
        q: (k, nq) configurations, k > 1; continuous joints go the shorter way from one to the next. Joints outside the
            chain stay as in the first one.
        velocity: rad/s or m/s, one number or (n,) one a joint; default: the model's.
        acceleration: rad/s^2 or m/s^2; default: full speed within 0.2 s, see ``MotionLimits.of``.
        jerk: rad/s^3 or m/s^3; default: not limited.

    Raises:
        InvalidConfiguration: If ``q`` are not configurations of the model.
        InvalidSetting: If a limit is not above 0, all configurations are one, or there is no motion within the limits.
        MissingExtra: toppra (without jerk) or ruckig (with) is not installed.
    """
    instance(Chain, chain=chain)
    limits = MotionLimits.of(chain, velocity, acceleration, jerk)
    rows = array("q", q, "k", chain.model.nq, error=InvalidConfiguration)
    if len(rows) < 2:
        raise InvalidConfiguration(f"a path has at least two configurations, got {len(rows)}")
    x = chain.x(rows)
    x = x[0] + np.concatenate([np.zeros((1, chain.n)), np.cumsum(chain.limits.way(x[:-1], x[1:]), axis=0)])
    curve = JointCurve.through(x, chain.limits, limits.velocity)
    profile = fastest(curve, limits) if limits.jerk is None else smooth(curve, limits)
    return TimedPath(chain, limits, curve, profile, rows[0])
