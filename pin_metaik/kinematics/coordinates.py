"""Which entries of a Pinocchio configuration the coordinates of a chain are, both ways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Coordinates:
    """n joint coordinates x and their places in a configuration q.

    A revolute or prismatic joint is one entry of q. A continuous joint is the pair (cos, sin) in q and an angle in x.

    Attributes:
        joints: (n,) Pinocchio joint ids.
        plain: (a,) columns of x that are one entry of q, and ``plain_q`` (a,) those entries; slices where consecutive.
        circular: (b,) columns of x that are a pair in q, and ``circular_q`` (b,) the first entry of each pair.
    """

    joints: NDArray[np.int64]
    plain: NDArray[np.int64] | slice
    plain_q: NDArray[np.int64] | slice
    circular: NDArray[np.int64]
    circular_q: NDArray[np.int64]

    def write(self, x: NDArray[np.float64], q: NDArray[np.float64]) -> None:
        """Write coordinates x (..., n) into configurations q (..., nq); other joints keep their entries."""
        q[..., self.plain_q] = x[..., self.plain]
        if self.circular.size:
            angles = x[..., self.circular]
            q[..., self.circular_q] = np.cos(angles)
            q[..., self.circular_q + 1] = np.sin(angles)

    def read(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (..., n) of configurations q (..., nq); continuous joints as an angle in (-pi, pi]."""
        if not self.circular.size:
            return np.array(q[..., self.plain_q])
        x = np.empty((*q.shape[:-1], len(self.joints)))
        x[..., self.plain] = q[..., self.plain_q]
        x[..., self.circular] = np.arctan2(q[..., self.circular_q + 1], q[..., self.circular_q])
        return x


def consecutive(indices: NDArray[np.int64]) -> NDArray[np.int64] | slice:
    """The indices, as a slice if they are consecutive: five times quicker to read and write."""
    if indices.size and (np.diff(indices) == 1).all():
        return slice(int(indices[0]), int(indices[-1]) + 1)
    return indices
