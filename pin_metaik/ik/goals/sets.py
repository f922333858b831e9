"""The set that a vector shall be in: a box, or a ball around one; how far outside it is, and the derivative of that."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from pin_metaik.arrays import Array


class Grown(NamedTuple):
    """A box of vectors y (m,), grown by a radius to all sides.

    The way out of the box is e = y - clip(y, least, most); the residual r = max(0, 1 - radius / |e|) e is the way to
    the grown box, zero inside.

    Attributes:
        least: (m,) lower bounds, or one for all; ``-inf`` for none.
        most: (m,) upper bounds, likewise.
        radius: In the unit of y.
    """

    least: Array | float
    most: Array | float
    radius: float = 0.0

    def excess(self, y: Array) -> Array:
        """The way e (m,) from the box to y (m,); zero inside."""
        out: Array = y - np.minimum(np.maximum(y, self.least), self.most)
        return out

    def residual(self, y: Array) -> Array:
        """The way r (m,) from the grown box to y (m,); zero inside."""
        e = self.excess(y)
        if self.radius == 0.0:
            return e
        size = math.sqrt(e.dot(e))
        return e * (1.0 - self.radius / size) if size > self.radius else np.zeros_like(e)

    def slopes(self, y: Array, J: Array) -> Array:
        """The derivative (m, n) of the residual, from the derivative J (m, n) of y (m,)."""
        inside = (y > self.least) & (y < self.most)
        active = np.where(inside[:, None], 0.0, J) if inside.any() else J
        if self.radius == 0.0:
            return active
        e = self.excess(y)
        size = math.sqrt(e.dot(e))
        if size <= self.radius:
            return np.zeros_like(J)
        share, u = self.radius / size, e / size
        out: Array = (1.0 - share) * active + np.outer(share * u, u @ active)
        return out
