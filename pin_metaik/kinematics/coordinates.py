"""Which entries of a Pinocchio configuration the coordinates of a chain are, both ways."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.joints import angles, quaternion

READ_BACK = 1e-12  # rad, of an angle that a cosine and a sine, or a quaternion, hold


@dataclass(frozen=True, eq=False)
class Coordinates:
    """n joint coordinates x and their places in a configuration q.

    A revolute or prismatic joint is one entry of q. A continuous joint is the pair (cos, sin) in q and an angle in x. A
    ball joint, and the turn of a floating base, is a quaternion in q and yaw, pitch and roll in x.

    Attributes:
        joints: (n,) Pinocchio joint ids.
        plain: (a,) columns of x that are one entry of q, and ``plain_q`` (a,) those entries; slices where consecutive.
        circular: (b,) columns of x that are a pair in q, and ``circular_q`` (b,) the first entry of each pair.
        turning: (c,) columns of x of each first angle, a yaw, and ``turning_q`` (c,) the first entry of its quaternion.
    """

    joints: NDArray[np.int64]
    plain: NDArray[np.int64] | slice
    plain_q: NDArray[np.int64] | slice
    circular: NDArray[np.int64]
    circular_q: NDArray[np.int64]
    turning: NDArray[np.int64]
    turning_q: NDArray[np.int64]

    @cached_property
    def columns(self) -> dict[int, int]:
        """The first column of x of each joint, by its id."""
        columns: dict[int, int] = {}
        for column, joint in enumerate(self.joints.tolist()):
            columns.setdefault(joint, column)
        return columns

    @property
    def single(self) -> bool:
        """Whether each coordinate has entries of its own, as is not so where there are quaternions."""
        return not self.turning.size

    @cached_property
    def rounding(self) -> NDArray[np.float64] | None:
        """(n,) by how much (rad) a coordinate may differ from itself when read back from q; None: by nothing."""
        if not self.circular.size and not self.turning.size:
            return None
        rounding = np.zeros(len(self.joints))
        rounding[self.circular] = READ_BACK
        rounding[self.turning[:, None] + np.arange(3)] = READ_BACK
        return rounding

    @property
    def places(self) -> NDArray[np.int64]:
        """(n, 2) first entry of q, and whether that is a cosine and its sine, of what has entries of its own."""
        places = np.zeros((len(self.joints), 2), dtype=np.int64)
        entries = self.plain_q
        places[self.plain, 0] = np.arange(entries.start, entries.stop) if isinstance(entries, slice) else entries
        places[self.circular, 0], places[self.circular, 1] = self.circular_q, 1
        return places

    def write(self, x: NDArray[np.float64], q: NDArray[np.float64]) -> None:
        """Write coordinates x (..., n) into configurations q (..., nq); other joints keep their entries."""
        q[..., self.plain_q] = x[..., self.plain]
        if self.circular.size:
            turns = x[..., self.circular]
            q[..., self.circular_q] = np.cos(turns)
            q[..., self.circular_q + 1] = np.sin(turns)
        for column, entry in zip(self.turning.tolist(), self.turning_q.tolist(), strict=True):
            q[..., entry : entry + 4] = quaternion(x[..., column : column + 3])

    def read(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates (..., n) of configurations q (..., nq); continuous joints as an angle in (-pi, pi]."""
        if not self.circular.size and not self.turning.size:
            return np.array(q[..., self.plain_q])
        x = np.empty((*q.shape[:-1], len(self.joints)))
        x[..., self.plain] = q[..., self.plain_q]
        x[..., self.circular] = np.arctan2(q[..., self.circular_q + 1], q[..., self.circular_q])
        for column, entry in zip(self.turning.tolist(), self.turning_q.tolist(), strict=True):
            x[..., column : column + 3] = angles(q[..., entry : entry + 4])
        return x


def consecutive(indices: NDArray[np.int64]) -> NDArray[np.int64] | slice:
    """The indices, as a slice if they are consecutive: five times quicker to read and write."""
    if indices.size and (np.diff(indices) == 1).all():
        return slice(int(indices[0]), int(indices[-1]) + 1)
    return indices
