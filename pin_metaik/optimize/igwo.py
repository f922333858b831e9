"""Improved grey wolf optimiser of the RV-7FL paper: the pack closes in exponentially."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass

from pin_metaik.arrays import Array
from pin_metaik.optimize.gwo import hunt
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import whole


@dataclass(frozen=True)
class IGWO:
    """Grey wolves with ``a = 2 exp(-t s / max)``, s the number of wolves (RV-7FL paper, DEU FMD 26(78) 2024, Eq. 13).

    With the paper's 300 wolves a falls below 0.1 after one hundredth of the budget: nearly all of it is spent closing
    in on the leaders of the first generations.

    Attributes:
        agents: Wolves, at least 3.
    """

    agents: int = 30

    def __post_init__(self) -> None:
        whole("agents", self.agents, 3)

    def a(self, progress: float) -> float:
        """How far the wolves still roam (Eq. 13), progress = t / max."""
        return 2 * math.exp(-progress * self.agents)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose packs (agents, n), for ever."""
        return hunt(run, self.agents, self.a)
