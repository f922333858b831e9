"""A motion along a curve within limits of speed, acceleration and jerk, by ruckig."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import need
from pin_metaik.timing.curve import JointCurve
from pin_metaik.timing.limits import MotionLimits
from pin_metaik.timing.profile import Places

TRIED = 40  # greatest speeds, and for each as many accelerations
SAFE = 1.0 - 1e-9  # of every limit, for rounding


@dataclass(frozen=True, eq=False)
class SmoothProfile:
    """A profile with constant limits of its speed, acceleration and jerk along the curve, as ruckig has it.

    Attributes:
        trajectory: ruckig's.
    """

    trajectory: Any

    @property
    def duration(self) -> float:
        """When its end is reached, s."""
        return float(self.trajectory.duration)

    def at(self, t: NDArray[np.float64]) -> Places:
        """See ``Profile``."""
        rows = np.array([[one[0] for one in self.trajectory.at_time(time)[:3]] for time in t.tolist()]).reshape(-1, 3)
        return rows[:, 0], rows[:, 1], rows[:, 2]


def smooth(curve: JointCurve, limits: MotionLimits) -> SmoothProfile:
    """The quickest, of those tried, of the profiles that ruckig makes with constant limits along the whole curve.

    With s', s'', s''' below u, b, j the joints keep theirs if, for the largest |x'|, |x''|, |x'''| of each by s,

        |x'| u <= v,   |x''| u^2 + |x'| b <= a,   |x'''| u^3 + 3 |x''| u b + |x'| j <= jerk:

    where the curve bends most decides for all of it.

    Raises:
        MissingExtra: ruckig is not installed.
        InvalidSetting: A joint would leave its limits between the points if its second derivative were continuous.
    """
    need("timing a path with limited jerk", "timing", "ruckig")
    if curve.bent:
        raise InvalidSetting(
            f"joint number {curve.bent[0]} would leave its limits on a smooth curve between the poses: give more poses "
            "there, or no jerk"
        )
    best = None
    for u, b, j in _bounds(curve, limits):
        trajectory = _moved(curve.length, SAFE * u, SAFE * b, SAFE * j)
        if trajectory is not None and (best is None or trajectory.duration < best.duration):
            best = trajectory
    if best is None:
        raise InvalidSetting("ruckig finds no motion along this path within the limits")
    return SmoothProfile(best)


def _bounds(curve: JointCurve, limits: MotionLimits) -> Iterator[tuple[float, float, float]]:
    """Limits u, b and j of the derivatives of s with which the joints keep theirs."""
    assert limits.jerk is not None
    first, second, third = (np.maximum(curve.largest(order), 1e-12) for order in (1, 2, 3))
    fastest = min((limits.velocity / first).min(), np.sqrt(limits.acceleration / second).min())
    for u in fastest * np.arange(1, TRIED + 1) / TRIED:
        most = ((limits.acceleration - second * u**2) / first).min()
        for b in most * np.arange(1, TRIED + 1) / TRIED:
            j = ((limits.jerk - third * u**3 - 3.0 * second * u * b) / first).min()
            if b > 0.0 and j > 0.0:
                yield float(u), float(b), float(j)


def _moved(length: float, u: float, b: float, j: float) -> Any | None:
    """The trajectory that ruckig has over a length from rest to rest; None, where its numbers do not do."""
    from ruckig import InputParameter, Result, Ruckig, RuckigError, Trajectory

    request, trajectory = InputParameter(1), Trajectory(1)
    request.target_position = [length]
    request.max_velocity, request.max_acceleration, request.max_jerk = [u], [b], [j]
    try:
        found = Ruckig(1).calculate(request, trajectory)
    except RuckigError:
        return None
    return trajectory if found == Result.Working else None
