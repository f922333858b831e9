"""CMA-ES, the modern control: the well-kept package `cma` behind the same protocol as everything else."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.lookup import need
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import positive, whole, within


@dataclass(frozen=True)
class CMAES:
    """Covariance matrix adaptation (Hansen and Ostermeier 2001); needs the extra ``cma``.

    When a run has converged the next starts with a larger population (IPOP, Auger and Hansen 2005).

    Searches the unit cube (the box scaled by its width, fixed coordinates left out) with the package's own treatment of
    bounds. The first run starts at the best of an initial population, later ones at random points.

    Attributes:
        agents: Population of the first run; None for the package's ``4 + 3 ln n``.
        sigma: First step size as a share of the width of the box.
        growth: Factor by which the population grows at a restart.

    Raises:
        MissingExtra: The package `cma` is not installed.
    """

    agents: int | None = None
    sigma: float = 0.3
    growth: float = 2.0

    def __post_init__(self) -> None:
        if self.agents is not None:
            whole("agents", self.agents, 2)
        positive("sigma", self.sigma)
        within("growth", self.growth, 1)
        need("CMA-ES", "cma", "cma")

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose populations (agents, n), for ever."""
        from cma import CMAEvolutionStrategy

        rng, space = run.rng, run.space
        free = np.flatnonzero(space.width > 0)
        agents = self.agents or 4 + int(3 * math.log(max(1, len(free))))
        X = run.start(agents)
        costs = yield X
        while not len(free):
            costs = yield X
        start = X[costs.argmin()]
        while True:
            options = {
                "popsize": agents,
                "bounds": [0, 1],
                "randn": lambda count, n: rng.standard_normal((count, n)),
                "seed": math.nan,  # leave numpy's global state alone
                "verbose": -9,
                "verb_log": 0,
                "signals_filename": "",
            }
            unit = np.full(max(2, len(free)), 0.5)  # cma fails on one coordinate: then a second one counts for nothing
            unit[: len(free)] = ((start - space.lower)[free] / space.width[free]).clip(0, 1)
            strategy = CMAEvolutionStrategy(unit, self.sigma, options)
            converged = False
            while not converged:
                Y = strategy.ask()
                X = np.tile(start, (len(Y), 1))
                X[:, free] = space.lower[free] + np.array(Y)[:, : len(free)] * space.width[free]
                costs = yield space.clip(X)
                with np.errstate(over="ignore", invalid="ignore"):  # cma 4.0 counts with infinite costs and steps
                    strategy.tell(Y, costs.tolist())
                    converged = bool(strategy.stop())
            agents = round(agents * self.growth)
            start = space.sample(rng, 1)[0]
