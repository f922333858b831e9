"""A trajectory: where the robot is at any time, exact, and as arrays to plot, to send and to save."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path as File
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.motion.turn import clothoid
from pin_metaik.mobile.paths.path import write_table
from pin_metaik.optimize.settings import MANY
from pin_metaik.output import writable

SAMPLES = 0.02  # s


class Phase(NamedTuple):
    """A stretch of time with constant accelerations, of which one at most is not zero while the robot moves.

    Attributes:
        duration: s.
        a: Acceleration, m/s^2; zero in a curve.
        alpha: Angular acceleration, rad/s^2; zero on a straight.
        omega: Turning rate at the beginning, rad/s; zero on a straight.
    """

    duration: float
    a: float = 0.0
    alpha: float = 0.0
    omega: float = 0.0

    @property
    def straight(self) -> bool:
        """Whether it does not turn."""
        return self.alpha == 0.0 and self.omega == 0.0


@dataclass(frozen=True, eq=False)
class Samples:
    """States over time, each (n,); accelerations hold from their row to the next.

    Attributes:
        t: Time, s.
        x: Position, m.
        y: Position, m.
        heading: Direction of travel, rad, without jumps.
        v: Speed, m/s.
        omega: Turning rate, rad/s.
        a: Acceleration, m/s^2.
        alpha: Angular acceleration, rad/s^2.
    """

    t: Array
    x: Array
    y: Array
    heading: Array
    v: Array
    omega: Array
    a: Array
    alpha: Array

    @property
    def table(self) -> Array:
        """The states as columns (n, 8), in the order above."""
        return np.column_stack([getattr(self, field.name) for field in fields(self)])

    @property
    def xy(self) -> Array:
        """Positions (n, 2)."""
        return np.column_stack((self.x, self.y))


@checked
class Trajectory:
    """A synchro-drive robot's motion as a list of phases, from rest at a pose.

    Attributes:
        phases: What it does, one after the other.
        start: Pose (x, y, heading) in m and rad.
        duration: Of the whole, s.
    """

    def __init__(self, phases: Sequence[Phase], start: tuple[float, float, float]) -> None:
        array("phases", [tuple(phase) for phase in phases] or np.empty((0, 4)), "p", 4)
        array("start", start, 3)
        self.phases = tuple(phases)
        self.start = start
        self._begins = np.cumsum([0.0, *(phase.duration for phase in phases)])
        self.duration = float(self._begins[-1])
        states = [np.array([*start, 0.0])]  # x, y, heading, v at the beginning of each phase
        for phase in self.phases:
            states.append(np.concatenate(_moved(states[-1][None], np.array([phase]), phase.duration)))
        self._states = np.array(states)

    @property
    def end(self) -> tuple[float, float, float]:
        """Pose (x, y, heading) at the end, in m and rad."""
        x, y, heading, _ = self._states[-1].tolist()
        return x, y, heading

    @property
    def boundaries(self) -> Array:
        """Times (p + 1,) in s at which phases begin and the last ends."""
        return self._begins.copy()

    @checked
    def at(self, t: ArrayLike) -> Samples:
        """States at times t (n,) in s, by the closed form; before the start and after the end it stands still."""
        times = np.clip(np.atleast_1d(array("t", t, "...")).ravel(), 0.0, self.duration)
        if not self.phases:
            x, y, heading = (np.full(times.shape, s) for s in self.start)
            return Samples(times, x, y, heading, *np.zeros((4, len(times))))
        k = np.clip(np.searchsorted(self._begins, times, side="right") - 1, 0, len(self.phases) - 1)
        phases = np.array(self.phases)[k]
        within = np.minimum(times - self._begins[k], phases[:, 0])
        x, y, heading, v = _moved(self._states[k], phases, within)
        omega = phases[:, 3] + phases[:, 2] * within
        return Samples(times, x, y, heading, v, omega, phases[:, 1], phases[:, 2])

    @checked
    def sample(self, dt: float = SAMPLES) -> Samples:
        """States every dt seconds, and at the beginning of every phase and the end.

        Raises:
            InvalidSetting: A dt that is not above zero.
        """
        if not dt > 0 or self.duration > MANY * dt:
            raise InvalidSetting(f"dt is above 0 s and not a {MANY:,}th of {self.duration:g} s, got {dt!r}")
        return self.at(np.union1d(np.arange(0.0, self.duration, dt), self._begins))

    @checked
    def write_csv(self, file: str | File, dt: float = SAMPLES) -> None:
        """Write the samples as CSV."""
        write_table(file, (field.name for field in fields(Samples)), self.sample(dt).table)

    @checked
    def write_json(self, file: str | File, dt: float = SAMPLES) -> None:
        """Write the samples as JSON: an object with one array for each column."""
        writable(file).write_text(json.dumps(self.as_dict(dt), allow_nan=False), encoding="utf-8")

    @checked
    def as_dict(self, dt: float = SAMPLES) -> dict[str, list[float]]:
        """The samples as plain lists, by name."""
        samples = self.sample(dt)
        return {field.name: getattr(samples, field.name).tolist() for field in fields(samples)}


def _moved(states: Array, phases: Array, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """x, y, heading and v, each (n,), a time t into phases (n, 4) that begin at states (n, 4)."""
    x, y, heading, v = states.T
    _, a, alpha, omega = phases.T
    way = clothoid(heading, omega, alpha, t) * v + np.exp(1j * heading) * a * np.square(t) / 2
    return x + way.real, y + way.imag, heading + omega * t + alpha * np.square(t) / 2, v + a * t
