"""Near the limits: where steps that are clipped or rejected afterwards get stuck."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compare.cases.case import Case, Task
from pin_metaik.kinematics import Chain

NEAR = 0.01  # of its range: how near a limit a joint is


def near_limit(chain: Chain, count: int, rng: np.random.Generator, near: float = NEAR) -> NDArray[np.float64]:
    """Coordinates (count, n), half of the joints within a share of one of their limits; continuous joints have none."""
    X = chain.box.sample(rng, count)
    limited = np.flatnonzero(~chain.limits.periodic)
    chosen = rng.permuted(np.tile(limited, (count, 1)), axis=1)[:, : min(chain.n // 2, len(limited))]
    rows = np.arange(count)[:, None]
    low, span = chain.box.lower[chosen], (chain.box.upper - chain.box.lower)[chosen]
    depth = rng.uniform(0.0, near, chosen.shape)
    X[rows, chosen] = low + span * np.where(rng.random(chosen.shape) < 0.5, depth, 1.0 - depth)
    return X


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A pose near the limits."""
    return Task.at(chain, near_limit(chain, 1, rng))


NEAR_LIMIT = Case(
    "near_limit", "Poses of configurations with half of the joints within 1 % of one of their limits.", draw
)
