"""A trajectory: where the robot is at any time, exact, and as arrays to plot, to send and to save."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path as File
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.files import read_json
from pin_metaik.mobile.motion.turn import clothoid
from pin_metaik.optimize.settings import MANY, within
from pin_metaik.output import writable, write_table

SAMPLES = 0.02  # s


class Moved(NamedTuple):
    """How far anything between two places of a motion is from the middle of the two at most.

    Attributes:
        travel: Of the robot's point (n,), m.
        turn: (n,), rad.
    """

    travel: Array
    turn: Array


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
    """States over time, each (n,); an acceleration holds from its time to the next.

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
@dataclass(frozen=True)
class State:
    """State of a mobile robot: pose, speed and turning rate.

    Attributes:
        x: Position, m.
        y: Position, m.
        heading: Direction of travel, rad.
        v: Speed, m/s.
        omega: Turning rate, rad/s.

    Raises:
        InvalidSetting: One of them is not a finite number, or the speed is below zero.
    """

    x: float
    y: float
    heading: float
    v: float = 0.0
    omega: float = 0.0

    def __post_init__(self) -> None:
        array("state", (self.x, self.y, self.heading, self.v, self.omega), 5)
        within("v", self.v, 0)

    @property
    def pose(self) -> tuple[float, float, float]:
        """(x, y, heading) in m and rad."""
        return self.x, self.y, self.heading


@checked
class Trajectory:
    """A robot's motion from a pose, as a sequence of phases with constant accelerations.

    Attributes:
        phases: Its phases, one after the other.
        start: Pose (x, y, heading) in m and rad.
        v: Speed at the start, m/s.
        duration: Duration of the motion, s.
    """

    def __init__(self, phases: Sequence[Phase], start: tuple[float, float, float], v: float = 0.0) -> None:
        rows = array("phases", [tuple(phase) for phase in phases] or np.empty((0, 4)), "p", 4)
        if len(rows) and rows[:, 0].min() < 0.0:
            raise InvalidSetting(f"a phase lasts 0 s or longer, got {rows[:, 0].min():g} s")
        array("start", start, 3)
        within("v", v, 0)
        self.phases = tuple(phases)
        self.start = start
        self.v = v
        self._rows = rows
        self._begins = np.cumsum([0.0, *rows[:, 0]])
        self.duration = float(self._begins[-1])
        states = [np.array([*start, v])]  # x, y, heading, v at the beginning of each phase
        for row in rows:
            states.append(np.concatenate(_moved(states[-1][None], row[None], row[0])))
        self._states = np.array(states)

    @property
    def end(self) -> tuple[float, float, float]:
        """Pose (x, y, heading) at the end, in m and rad."""
        x, y, heading, _ = self._states[-1].tolist()
        return x, y, heading

    @checked
    def state(self, t: float) -> State:
        """The state at a time t in s, for instance to plan again from (``plan_in_motion``)."""
        at = self.at(t)
        v = max(float(at.v[0]), 0.0)  # by rounding it may be below, at rest
        return State(float(at.x[0]), float(at.y[0]), float(at.heading[0]), v, float(at.omega[0]))

    @checked
    def poses(self, s: ArrayLike) -> Array:
        """Poses (n, 3) at times s (n,), in s: x, y in m and the heading in rad."""
        at = self.at(s)
        return np.column_stack((at.x, at.y, at.heading))

    @checked
    def moved(self, a: Array, b: Array) -> Moved:
        """Bound (n,), m, on how far positions between times a and b (n,), in s, are from the one in the middle.

        Both times are in one phase, in which speed and turning rate change linearly and are largest at an end.
        """
        a = array("a", a, "n")
        b = array("b", b, len(a))
        middle, half = (a + b) / 2, (b - a) / 2
        k = np.clip(np.searchsorted(self._begins, middle, side="right") - 1, 0, max(len(self.phases) - 1, 0))
        _, acceleration, alpha, _ = (self._rows if self.phases else np.zeros((1, 4)))[k].T
        at = self.at(middle)
        fastest, turning = np.abs(at.v) + np.abs(acceleration) * half, np.abs(at.omega) + np.abs(alpha) * half
        return Moved(fastest * half, turning * half)

    @property
    def boundaries(self) -> Array:
        """Times (p + 1,) in s at which phases begin and the last ends."""
        return self._begins.copy()

    @checked
    def at(self, t: ArrayLike) -> Samples:
        """States at times t (n,) in s, by the closed form; before the start the first, after the end the last."""
        times = np.clip(np.atleast_1d(array("t", t, "...")).ravel(), 0.0, self.duration)
        if not self.phases:
            x, y, heading = (np.full(times.shape, s) for s in self.start)
            return Samples(times, x, y, heading, np.full(times.shape, self.v), *np.zeros((3, len(times))))
        k = np.clip(np.searchsorted(self._begins, times, side="right") - 1, 0, len(self.phases) - 1)
        phases = self._rows[k]
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
            raise InvalidSetting(
                f"dt is above 0 s and makes at most {MANY:,} samples of {self.duration:g} s, got {dt!r}"
            )
        return self.at(np.union1d(np.arange(0.0, self.duration, dt), self._begins))

    @checked
    def write_csv(self, file: str | File, dt: float = SAMPLES) -> None:
        """Write the samples as CSV."""
        write_table(file, (field.name for field in fields(Samples)), self.sample(dt).table)

    @checked
    def write_json(self, file: str | File, dt: float = SAMPLES) -> None:
        """Write the samples as JSON: an object with one array for each column."""
        writable(file).write_text(json.dumps(self.as_dict(dt), allow_nan=False), encoding="utf-8")

    def exact(self) -> dict[str, Any]:
        """The whole motion as plain values: pose (x, y, heading) and speed at the start, and the phases."""
        return {"start": list(self.start), "v": self.v, "phases": [list(phase) for phase in self.phases]}

    @checked
    def as_dict(self, dt: float = SAMPLES) -> dict[str, list[float]]:
        """The samples as plain lists, by name."""
        samples = self.sample(dt)
        return {field.name: getattr(samples, field.name).tolist() for field in fields(samples)}


@checked
def load_trajectory(file: str | File) -> Trajectory:
    """Read a motion exactly, from JSON that ``plan --out`` wrote or that holds ``TrajectoryPlan.as_dict()``.

    Raises:
        InvalidSetting: The file is missing, or has no start, v and phases that make a motion.
    """
    given = read_json(File(file), InvalidSetting)
    if not isinstance(given, dict) or any(key not in given for key in ("start", "v", "phases")):
        raise InvalidSetting(f"{file} is not a trajectory: expected an object with start, v and phases")
    try:
        start = array("start", given["start"], 3).tolist()
        phases = array("phases", given["phases"] or np.empty((0, 4)), "p", 4)
        return Trajectory([Phase(*row) for row in phases.tolist()], (start[0], start[1], start[2]), given["v"])
    except InvalidSetting as error:
        raise InvalidSetting(f"{file} is not a trajectory: {error}") from None


def _moved(states: Array, phases: Array, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """x, y, heading and v, each (n,), a time t into phases (n, 4) that begin at states (n, 4)."""
    x, y, heading, v = states.T
    _, a, alpha, omega = phases.T
    way = clothoid(heading, omega, alpha, t) * v + np.exp(1j * heading) * a * np.square(t) / 2
    return x + way.real, y + way.imag, heading + omega * t + alpha * np.square(t) / 2, v + a * t
