"""Particle swarm: every particle is drawn to its own best place and to the swarm's (Kennedy and Eberhart 1995)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import one_of, positive, whole, within

Variant = Literal["constriction", "inertia", "literal"]
ATTRACTION: dict[Variant, float] = {"constriction": 2.05, "inertia": 2.0, "literal": 2.05}  # c1 and c2 of the papers


@dataclass(frozen=True)
class PSO:
    """Particle swarm optimisation with one global best, in three variants.

    - ``constriction``: ``v = chi (v + c1 r1 (p - x) + c2 r2 (g - x))`` (Clerc and Kennedy 2002); c1 = c2 = 2.05.
    - ``inertia``: ``v = w v + c1 r1 (p - x) + c2 r2 (g - x)``, w falling linearly (Shi and Eberhart 1998); c1 = c2 = 2.
    - ``literal``: ``v = chi v + c1 r1 (p - x) + c2 r2 (g - x)``, the constants of the first in the form of the second,
      as the Stewart platform paper prints it (its Eq. 12). It diverges, limited only by the box and v_max.

    Particles start with half the way to a random point as their velocity (as SPSO 2007); one that would leave the box
    stops at its wall.

    Attributes:
        agents: Particles.
        variant: How velocities are made.
        c1: Attraction to the particle's best; None for the variant's own.
        c2: Attraction to the swarm's best; None for the variant's own.
        w_max: Inertia at the beginning of the budget (inertia only).
        w_min: Inertia at its end (inertia only).
        chi: Constriction factor (constriction and literal).
        v_max: Largest velocity as a share of the width of the box; from 1 on it has no effect.
    """

    agents: int = 40
    variant: Variant = "constriction"
    c1: float | None = None
    c2: float | None = None
    w_max: float = 0.9
    w_min: float = 0.4
    chi: float = 0.7298
    v_max: float = 0.5

    def __post_init__(self) -> None:
        whole("agents", self.agents, 1)
        one_of("variant", self.variant, Variant)
        for name, c in (("c1", self.c1), ("c2", self.c2)):
            if c is not None:
                within(name, c, 0)
        within("w_min", self.w_min, 0)
        within("w_max", self.w_max, self.w_min)
        within("chi", self.chi, 0)
        positive("v_max", self.v_max)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose swarms (agents, n), for ever."""
        rng, space, chi = run.rng, run.space, self.chi
        c1, c2 = (ATTRACTION[self.variant] if c is None else c for c in (self.c1, self.c2))
        X = run.start(self.agents)
        v_max = self.v_max * np.tile(space.width, (self.agents, 1))
        V = 0.5 * (space.sample(rng, self.agents) - X)
        P, f = X.copy(), (yield X)  # the particles' best places and their costs
        while True:
            g = P[f.argmin()]
            r1, r2 = rng.random((2, *X.shape))
            pull = c1 * r1 * (P - X) + c2 * r2 * (g - X)
            match self.variant:
                case "constriction":
                    V = chi * (V + pull)
                case "inertia":
                    V = (self.w_max - (self.w_max - self.w_min) * run.progress) * V + pull
                case "literal":
                    V = chi * V + pull
            V = np.minimum(np.maximum(V, -v_max), v_max)
            flown = X + V
            X = space.clip(flown)
            V *= flown == X  # stopped at the wall

            costs = yield X
            better = costs < f
            P[better], f[better] = X[better], costs[better]
