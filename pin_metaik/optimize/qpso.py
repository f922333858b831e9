"""Quantum-behaved particle swarm: no velocities, a cloud around each particle's attractor (Sun, Feng and Xu 2004)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import whole, within


@dataclass(frozen=True)
class QPSO:
    """Quantum-behaved PSO; Eq. 14-15 of the Stewart platform paper, repaired after Sun, Feng and Xu 2004.

    ``p = phi P + (1 - phi) G``, ``mBest = mean of P``, ``x = p +- beta |mBest - x| ln(1/u)``; phi and u are uniform on
    (0, 1), each sign is as likely. The paper prints one sign for both branches, no modulus, and no beta; its usual
    schedule is assumed. Particles that leave the box are put back on its wall.

    Attributes:
        agents: Particles.
        beta_start: Contraction-expansion coefficient at the beginning of the budget.
        beta_end: The same at its end; it falls linearly.
    """

    agents: int = 40
    beta_start: float = 1.0
    beta_end: float = 0.5

    def __post_init__(self) -> None:
        whole("agents", self.agents, 1)
        within("beta_start", self.beta_start, 0)
        within("beta_end", self.beta_end, 0)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose swarms (agents, n), for ever."""
        rng = run.rng
        X = run.start(self.agents)
        P, f = X.copy(), (yield X)  # the particles' best places and their costs
        while True:
            phi, sign = rng.random((2, *X.shape))
            p = phi * P + (1 - phi) * P[f.argmin()]
            spread = np.abs(P.mean(axis=0) - X) * rng.standard_exponential(X.shape)  # |mBest - x| ln(1/u)
            beta = self.beta_start + (self.beta_end - self.beta_start) * run.progress
            X = run.space.clip(p + np.copysign(beta, sign - 0.5) * spread)

            costs = yield X
            better = costs < f
            P[better], f[better] = X[better], costs[better]
