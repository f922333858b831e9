"""Time profile of a curve: the position on it over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Places = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


class Profile(Protocol):
    """Places s(t) on a curve, from 0 at the time 0 on; at rest at both ends."""

    @property
    def duration(self) -> float:
        """When its end is reached, s."""
        ...

    def at(self, t: NDArray[np.float64]) -> Places:
        """Places and their first and second derivatives by time, each (k,), at times t (k,) from 0 to the end."""
        ...


@dataclass(frozen=True, eq=False)
class SteppedProfile:
    """A profile whose acceleration is constant between places of a grid.

    Attributes:
        grid: (k,) places.
        speeds: (k,) first derivatives by time there, 1/s; above 0 but at the ends.
    """

    grid: NDArray[np.float64]
    speeds: NDArray[np.float64]

    @property
    def accelerations(self) -> NDArray[np.float64]:
        """(k - 1,) second derivatives by time, 1/s^2."""
        accelerations: NDArray[np.float64] = np.diff(np.square(self.speeds)) / (2.0 * np.diff(self.grid))
        return accelerations

    @property
    def times(self) -> NDArray[np.float64]:
        """(k,) when the places of the grid are reached, s."""
        return np.concatenate([[0.0], np.cumsum(2.0 * np.diff(self.grid) / (self.speeds[:-1] + self.speeds[1:]))])

    @property
    def duration(self) -> float:
        """When its end is reached, s."""
        return float(self.times[-1])

    def at(self, t: NDArray[np.float64]) -> Places:
        """See ``Profile``."""
        times, a = self.times, self.accelerations
        i = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(a) - 1)
        since = t - times[i]
        s = self.grid[i] + since * (self.speeds[i] + 0.5 * a[i] * since)
        return np.clip(s, self.grid[i], self.grid[i + 1]), np.maximum(self.speeds[i] + a[i] * since, 0.0), a[i]

    def slowed(self, factor: float) -> SteppedProfile:
        """The same, a factor slower."""
        return SteppedProfile(self.grid, self.speeds / factor)
