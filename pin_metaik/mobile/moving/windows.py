"""The times at which a robot may start along a line, or stay at a place, among moving obstacles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.mobile.moving import kernels
from pin_metaik.mobile.moving.obstacle import MovingObstacle

Windows = list[tuple[float, float]]

SHORT = 1e-9  # s, or of the time: between two legs of one obstacle rounding leaves gaps, through which nothing drives


class Departures:
    """Times at which nothing is met, for a speed and a clearance.

    Attributes:
        speed: Of the robot, m/s.
    """

    def __init__(self, moving: Sequence[MovingObstacle], speed: float, clearance: float) -> None:
        self.speed = speed
        planes = [obstacle.planes(clearance) for obstacle in moving]
        self._first = np.cumsum([0, *map(len, planes)])
        self._planes = np.ascontiguousarray(np.vstack([np.empty((0, 3)), *planes]))
        self._legs = np.ascontiguousarray(np.vstack([np.empty((0, 7)), *(m.legs(k) for k, m in enumerate(moving))]))
        most = max(map(len, planes), default=0) + 8
        self._rooms = np.empty((most, 2)), np.empty((most, 2))
        self._refused = np.empty((len(self._legs), 2))

    def along(self, a: Array, b: Array) -> Windows:
        """Closed windows of departure times from a (2,) straight to b (2,); from a to a of times to be there."""
        count = kernels.refused_departures(
            np.concatenate((a, b)),
            self.speed,
            self._planes,
            self._first,
            self._legs,
            *self._rooms,
            self._refused,
        )
        return _gaps(self._refused[:count])


def _gaps(refused: Array) -> Windows:
    """What open intervals (k, 2) leave of all times; what is no longer than rounding makes it is no window."""
    windows, begin = [], -np.inf
    for low, high in refused[np.argsort(refused[:, 0], kind="stable")].tolist():
        if low > begin + SHORT * max(1.0, abs(low)):
            windows.append((begin, low))
        begin = max(begin, high)
    if begin < np.inf:
        windows.append((begin, np.inf))
    return windows
