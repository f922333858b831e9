"""Grey wolf optimiser: the pack follows its three best wolves (Mirjalili, Mirjalili and Lewis 2014)."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import whole


@dataclass(frozen=True)
class GWO:
    """Grey wolf optimiser, Mirjalili et al. 2014, Adv. Eng. Software 69 (equations as numbered in the RV-7FL paper).

    Wolves that leave the box are put back on its wall. The update contains ``|C leader - x|``, which draws the pack
    towards the origin: on functions with their optimum there it looks better than it is.

    The leaders are the best three so far, as the paper says. The author's published code drops a former alpha instead
    of making it beta; with optima at the origin that yields the printed figures.

    Attributes:
        agents: Wolves, at least 3.
    """

    agents: int = 30

    def __post_init__(self) -> None:
        whole("agents", self.agents, 3)

    def a(self, progress: float) -> float:
        """How far the wolves still roam: from 2 to 0 (Eq. 12), progress = t / max."""
        return 2 - 2 * progress

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose packs (agents, n), for ever."""
        return hunt(run, self.agents, self.a)


def hunt(run: Search, agents: int, a_at: Callable[[float], float]) -> Generator[Array, Array, None]:
    """Equations 4-10 with any schedule of a."""
    X = run.start(agents)  # (k, n)
    costs = yield X
    best = np.argsort(costs)[:3]
    leaders, leader_costs = X[best], costs[best]  # alpha, beta, delta: the three best wolves so far, (3, n) and (3,)
    while True:
        a = a_at(run.progress)
        A, C = run.rng.random((2, 3, *X.shape))  # r1, r2
        A *= 2 * a
        A -= a  # A = 2 a r1 - a
        C *= 2  # C = 2 r2
        D = C  # D = |C leader - X|, built in place
        D *= leaders[:, None]
        D -= X
        np.abs(D, out=D)
        D *= A
        X = run.space.clip((leaders.sum(axis=0) - D.sum(axis=0)) / 3)  # mean of the three leader - A D

        costs = yield X
        if costs.min() < leader_costs[2]:
            best = np.argpartition(costs, 2)[:3]
            pack, pack_costs = np.concatenate((leaders, X[best])), np.concatenate((leader_costs, costs[best]))
            best = np.argsort(pack_costs, kind="stable")[:3]
            leaders, leader_costs = pack[best], pack_costs[best]
