"""A way along a curve within limits of jerk as well, by ruckig."""

from __future__ import annotations

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
    from ruckig import InputParameter, Result, Ruckig, Trajectory

    assert limits.jerk is not None
    if curve.bent:
        raise InvalidSetting(
            f"joint number {curve.bent[0]} would leave its limits on a smooth way between the poses: give more poses "
            "there, or no jerk"
        )
    first, second, third = (np.maximum(curve.largest(order), 1e-12) for order in (1, 2, 3))
    request = InputParameter(1)
    request.target_position = [curve.length]
    planner, best = Ruckig(1), None
    fastest = min((limits.velocity / first).min(), np.sqrt(limits.acceleration / second).min())
    for u in fastest * np.arange(1, TRIED + 1) / TRIED:
        most = ((limits.acceleration - second * u**2) / first).min()
        for b in most * np.arange(1, TRIED + 1) / TRIED:
            j = ((limits.jerk - third * u**3 - 3.0 * second * u * b) / first).min()
            if b <= 0.0 or j <= 0.0:
                continue
            request.max_velocity, request.max_acceleration, request.max_jerk = [SAFE * u], [SAFE * b], [SAFE * j]
            trajectory = Trajectory(1)
            if planner.calculate(request, trajectory) == Result.Working and (
                best is None or trajectory.duration < best.duration
            ):
                best = trajectory
    if best is None:
        raise InvalidSetting("ruckig finds no way along this path within the limits")
    return SmoothProfile(best)
