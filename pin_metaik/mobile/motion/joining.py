"""From a state in motion onto a straight line: driving on straight to another speed, then turning towards a place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from pin_metaik.arrays import Array
from pin_metaik.mobile.motion.trajectory import Phase, State, Trajectory
from pin_metaik.mobile.motion.turn import clothoid
from pin_metaik.mobile.motion.vehicle import Vehicle

TURNS = np.linspace(-2 * np.pi, 2 * np.pi, 129)  # rad, among which those that lead towards a place are looked for
AIMED = 1e-11  # m; a turn that moves the aimed-at place by less is left out


class Joining(NamedTuple):
    """Phases that end heading for a place, not turning.

    Attributes:
        phases: Phases of the motion.
        end: Pose (x, y, heading) where they end.
        v: Speed there, m/s.
    """

    phases: list[Phase]
    end: tuple[float, float, float]
    v: float

    @property
    def time(self) -> float:
        """Duration, s."""
        return sum(phase.duration for phase in self.phases)


def joining(state: State, v: float, place: Array, vehicle: Vehicle) -> Joining | None:
    """From a state to speed v, and then, at that speed, turning until the robot heads for a place.

    Args:
        state: Where it begins.
        v: Speed in the turn, m/s. If it is not the state's, the robot stops turning first, and drives straight to it.
        place: (x, y), m.
        vehicle: The robot.

    Returns:
        The quickest of this form; None if no turn at that speed leads towards the place.
    """
    phases = [] if v == state.v else straightening(state, v, vehicle)
    before = Trajectory(phases, state.pose, state.v)
    omega = 0.0 if phases else state.omega
    turn = _turn_towards(before.end, v, omega, place, vehicle)
    if turn is None:
        return None
    durations, alphas = swings(np.array([turn]), omega, float(vehicle.omega_at(v)), vehicle.alpha_max)
    for duration, alpha in zip(durations[0].tolist(), alphas[0].tolist(), strict=True):
        if duration > 0:
            phases.append(Phase(duration, 0.0, alpha, omega))
            omega += alpha * duration
    return Joining(phases, Trajectory(phases, state.pose, state.v).end, v)


def straightening(state: State, v: float, vehicle: Vehicle) -> list[Phase]:
    """Phases that end the turn of a state and lead straight to speed v; to 0 it is how the robot stops."""
    phases = []
    if state.omega:
        alpha = -math.copysign(vehicle.alpha_max, state.omega)
        phases.append(Phase(-state.omega / alpha, 0.0, alpha, state.omega))
    if v != state.v:
        a = math.copysign(vehicle.a_max, v - state.v)
        phases.append(Phase((v - state.v) / a, a))
    return phases


def backwards(phases: Sequence[Phase]) -> list[Phase]:
    """The phases that drive the same way the other way round: their last state is these ones' first, turned by pi."""
    return [
        Phase(duration, -a, alpha, -(omega + alpha * duration)) for duration, a, alpha, omega in reversed(list(phases))
    ]


def swings(angles: Array, omega: float, omega_max: float, alpha_max: float) -> tuple[Array, Array]:
    """The quickest turns through angles (k,) from a turning rate to none: to a larger rate, at it, and to none.

    Args:
        angles: rad, to the left above zero.
        omega: Turning rate at the beginning, rad/s, at most omega_max.
        omega_max: Largest turning rate, rad/s.
        alpha_max: Largest angular acceleration, rad/s^2.

    Returns:
        Durations (k, 3), s, and angular accelerations (k, 3), rad/s^2.
    """
    least = omega * abs(omega) / (2 * alpha_max)  # braking at once turns through this
    side = np.where(angles >= least, 1.0, -1.0)
    w, angle = side * omega, side * angles
    peak = np.minimum(np.sqrt(np.maximum(alpha_max * angle + w**2 / 2, 0.0)), omega_max)
    peak = np.maximum(peak, w)
    left = angle - (2 * peak**2 - w**2) / (2 * alpha_max)
    steady = np.where(peak >= omega_max, np.maximum(left, 0.0) / omega_max, 0.0)
    durations = np.column_stack(((peak - w) / alpha_max, steady, peak / alpha_max))
    return durations, side[:, None] * alpha_max * np.array([1.0, 0.0, -1.0])


def _turn_towards(
    pose: tuple[float, float, float], v: float, omega: float, place: Array, vehicle: Vehicle
) -> float | None:
    """The angle, rad, of the quickest turn at speed v after which a place lies ahead."""
    x, y, heading = pose
    towards = complex(place[0] - x, place[1] - y)
    limits = float(vehicle.omega_at(v)), vehicle.alpha_max

    def aims(angles: Array) -> np.ndarray:
        """The place as it is seen after turns through angles (k,): ahead is the real part, to the left the other."""
        durations, alphas = swings(angles, omega, *limits)
        way, rate, angle = np.zeros(len(angles), dtype=complex), np.full(len(angles), omega), np.zeros(len(angles))
        for t, alpha in zip(durations.T, alphas.T, strict=True):
            way += v * clothoid(angle, rate, alpha, t)
            angle, rate = angle + rate * t + alpha * t**2 / 2, rate + alpha * t
        return np.asarray((towards * np.exp(-1j * heading) - way) * np.exp(-1j * angle))

    straight = aims(np.zeros(1))[0]
    if omega == 0.0 and abs(straight.imag) <= AIMED and straight.real >= 0:
        return 0.0
    seen = aims(TURNS).imag
    brackets = np.flatnonzero((seen[:-1] <= 0) != (seen[1:] <= 0))
    times = swings((TURNS[brackets] + TURNS[brackets + 1]) / 2, omega, *limits)[0].sum(axis=1)
    for i in brackets[np.argsort(times, kind="stable")]:
        root = brentq(lambda angle: float(aims(np.array([angle]))[0].imag), TURNS[i], TURNS[i + 1], xtol=1e-15)
        if aims(np.array([root]))[0].real >= 0:
            return float(root)
    return None
