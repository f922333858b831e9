"""The best points a search has evaluated."""

from __future__ import annotations

import numpy as np

from pin_metaik.arrays import Array


class Elite:
    """The `size` best points evaluated so far, best first, without exact repeats.

    Attributes:
        X: The points (m, n), m <= size.
        costs: Their costs (m,), ascending.
    """

    def __init__(self, size: int, dimension: int) -> None:
        self.size = size
        self.X: Array = np.empty((0, dimension))
        self.costs: Array = np.empty(0)

    def add(self, X: Array, costs: Array) -> None:
        """Look at a generation X (k, n) with its costs (k,), none of them NaN."""
        full = len(self.costs) == self.size
        if full and costs[costs.argmin()] >= self.costs[-1]:
            return
        if self.size == 1:
            best = costs.argmin()
            self.X, self.costs = X[best : best + 1].copy(), costs[best : best + 1].copy()
            return
        near = np.argpartition(costs, self.size)[: self.size] if len(costs) > self.size else slice(None)
        merged, merged_costs = np.concatenate((self.X, X[near])), np.concatenate((self.costs, costs[near]))
        order = np.lexsort((*merged.T, merged_costs))  # ties by position, so that repeats stand side by side
        merged, merged_costs = merged[order], merged_costs[order]
        new = np.ones(len(merged), dtype=bool)
        new[1:] = (merged[1:] != merged[:-1]).any(axis=1)
        self.X, self.costs = merged[new][: self.size], merged_costs[new][: self.size]
