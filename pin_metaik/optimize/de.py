"""Differential evolution: differences of the population are its mutations (Storn and Price 1997)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.pick import below, others
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import one_of, whole, within

Strategy = Literal["rand/1/bin", "best/1/bin", "current-to-best/1/bin"]


@dataclass(frozen=True)
class DE:
    """Differential evolution, Storn and Price 1997, J. Global Optimization 11.

    Generations are synchronous: no trial vector sees another of its generation. Coordinates that leave the box go
    half-way back to where they came from (Zhang and Sanderson 2009, JADE).

    Attributes:
        agents: Population, at least 4.
        F: Scale factor of the differences, 0 to 2.
        CR: Probability that a coordinate comes from the mutant; at least one does.
        strategy: How mutants are made.
    """

    agents: int = 50
    F: float = 0.5
    CR: float = 0.9
    strategy: Strategy = "rand/1/bin"

    def __post_init__(self) -> None:
        whole("agents", self.agents, 4)
        within("F", self.F, 0, 2)
        within("CR", self.CR, 0, 1)
        one_of("strategy", self.strategy, Strategy)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose trial vectors (agents, n), for ever."""
        rng, F, k, n = run.rng, self.F, self.agents, run.space.dimension
        X = run.start(k)
        f = yield X
        while True:
            x1, x2, x3 = X.take(others(rng, k), axis=0)
            match self.strategy:
                case "rand/1/bin":
                    V = x1 + F * (x2 - x3)
                case "best/1/bin":
                    V = X[f.argmin()] + F * (x1 - x2)
                case "current-to-best/1/bin":
                    V = X + F * (X[f.argmin()] - X) + F * (x1 - x2)
            crossed = rng.random((k, n)) < self.CR
            crossed |= np.arange(n) == below(rng, n, k)[:, None]
            U = run.space.halfway(np.where(crossed, V, X), X)

            costs = yield U
            better = np.flatnonzero(costs <= f)
            X[better], f[better] = U[better], costs[better]
