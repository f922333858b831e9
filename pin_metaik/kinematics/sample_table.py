"""A table of sampled configurations, looked up by pose: where a descent starts.

From the best of the entries with the nearest poses a descent needs 7 evaluations where a random start needs 22 (see
``kernel.descent`` and ``kernel.warm_starts``). The entries are kept in leaves of a balanced k-d tree; a look-up
compares the target with the means of all leaves, then with the entries of the nearest few, which takes 1 us instead of
the 5 us of comparing it with all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import LEAF, Samples

SEED = 20_241_122
TURN = 0.6  # what a whole turn of an axis counts, in root-mean-square distances of the tip from its mean


@dataclass(frozen=True, eq=False)
class SampleTable:
    """Sampled coordinates with the features of their poses.

    A feature (9 T,) is, for each tip, its position and its x and z axes, the axes times ``scale`` (m), so that
    Euclidean distances between features weigh metres against turns. All in single precision: a start need not be more
    precise, and all of it then stays in the cache.

    Attributes:
        leaves: (1 + c, 9 T, LEAF) features by column: leaf 0 holds the means of the c others.
        x: (c LEAF, n) coordinates, leaf after leaf.
        gains: (c LEAF, n, 6) what the tip's error there, in its own frame, is multiplied with for a Newton step; of a
            chain with one tip.
        scale: m.
    """

    leaves: NDArray[np.float32]
    x: NDArray[np.float32]
    gains: NDArray[np.float32]
    scale: float

    def moved(self, moves: NDArray[np.float64]) -> SampleTable:
        """The same samples with the poses of each tip moved as a whole by moves (T, 4, 4); gains are in tip frames."""
        leaves = self.leaves.copy()
        for t, M in enumerate(moves.astype(np.float32)):
            rows = leaves[:, 9 * t : 9 * t + 9].reshape(len(leaves), 3, 3, LEAF)
            rows[:] = M[:3, :3] @ rows
            rows[:, 0] += M[:3, 3:]
        return replace(self, leaves=leaves)

    @property
    def samples(self) -> Samples:
        """The same, as the compiled loops take it."""
        return Samples(self.leaves, self.x, self.gains, self.scale)


def no_samples(n: int, tips: int) -> Samples:
    """A table without entries, for descents from given starts only."""
    none = np.zeros(0, np.float32)
    return Samples(none.reshape(0, 9 * tips, LEAF), none.reshape(0, n), none.reshape(0, n, 6), 1.0)


def build_table(
    x: NDArray[np.float64],
    poses: NDArray[np.float64],
    gains: Callable[[NDArray[np.float64]], NDArray[np.float32]],
) -> SampleTable:
    """The table of the coordinates x (LEAF LEAF, n) with the poses (k, T, 4, 4) of their tips, and gains for them."""
    positions = poses[..., :3, 3]
    spread = np.sqrt(((positions - positions.mean(axis=0)) ** 2).sum(axis=-1).mean())
    scale = TURN * max(float(spread), 1e-6)
    features = np.concatenate([positions, scale * poses[..., :3, 0], scale * poses[..., :3, 2]], axis=-1)
    features = features.reshape(len(x), -1)
    order = _leaves(features, np.arange(len(x)))
    leaves = features[order].reshape(-1, LEAF, features.shape[1])
    leaves = np.concatenate([leaves.mean(axis=1)[None], leaves])
    columns = np.ascontiguousarray(leaves.transpose(0, 2, 1), dtype=np.float32)
    return SampleTable(columns, x[order].astype(np.float32), gains(x[order]), scale)


def _leaves(features: NDArray[np.float64], members: NDArray[np.int64]) -> NDArray[np.int64]:
    """The members in an order in which every LEAF of them are near each other: halved across the widest spread."""
    if len(members) <= LEAF:
        return members
    mine = features[members]
    widest = int(np.argmax(mine.max(axis=0) - mine.min(axis=0)))
    half = len(members) // 2
    order = members[np.argpartition(mine[:, widest], half)]
    return np.concatenate([_leaves(features, order[:half]), _leaves(features, order[half:])])
