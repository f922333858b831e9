"""The best way through layers of solutions: the fewest breaks, then the fewest changes of branch, then the shortest.

It is found by dynamic programming. In a world, a step between two solutions counts only if it is proved free; that is
looked at lazily, for the steps of the way that is the best so far, until all of its steps are known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.ik.labels import Signs, on_other_branches
from pin_metaik.kinematics import Chain

BREAK = 1e6  # what a break costs, in rad or m of way: more than any path has
CHANGE = 1e3  # and what another branch of solutions does, which is reached through a singularity
ROUNDS = 400  # ways that are looked at; the steps that are left then count as breaks

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Way:
    """One solution of each layer that has any.

    Attributes:
        rows: The number of the solution in its layer, by the number of the layer.
        breaks: The layers that are not reached from the one before.
        barred: Those of them that no straight move leads to either, in the world.
    """

    rows: dict[int, int]
    breaks: tuple[int, ...]
    barred: tuple[int, ...]


@dataclass(eq=False)
class Ways:
    """Layers of solutions, and what the steps between them cost.

    Attributes:
        chain: The chain.
        layers: Solutions (s, n) of each pose.
        bound: (n,) the longest step of each joint, rad or m.
        x0: (n,) where to begin near; None: anywhere.
        base: (nq,) where the joints that the chain does not move are.
        world: What must not collide between poses; None: nothing is looked at.
        moves: Whether a break is better where a straight move leads across it.
        signs: The branches (s, f) of the solutions (s, n) of a layer: see ``labels.signs_of``.
    """

    chain: Chain
    layers: list[Floats]
    bound: Floats
    x0: Floats | None
    base: Floats
    world: CollisionWorld | None
    moves: bool
    signs: Callable[[int, Floats], Signs]
    _signs: dict[int, Signs] = field(init=False, default_factory=dict)  # branches (s, f) of each layer
    _steps: dict[int, Singles] = field(init=False, default_factory=dict)  # costs (a, b) of the steps to each layer
    _known: set[tuple[int, int, int]] = field(init=False, default_factory=set)  # steps that were looked at
    _totals: dict[int, Floats] = field(init=False, default_factory=dict)  # costs (b,) up to each layer
    _before: dict[int, NDArray[np.int64]] = field(init=False, default_factory=dict)  # best row of the layer before

    def best(self) -> Way:
        """The best way of all, with all of its steps looked at."""
        places = [i for i, layer in enumerate(self.layers) if len(layer)]
        changed = 0
        for _ in range(ROUNDS):
            self._sum(places, changed)
            rows = self._trace(places)
            costlier = [k for k in range(1, len(places)) if self._look(places[k - 1], places[k], rows)]
            if not costlier:
                break
            changed = min(costlier)
        return self._way(places, rows)

    def _sum(self, places: list[int], first: int) -> None:
        """Costs up to every layer from number ``first`` of those that have solutions on."""
        for k in range(first, len(places)):
            here = places[k]
            if k == 0:
                layer = self.layers[here]
                self._totals[here] = (
                    np.zeros(len(layer)) if self.x0 is None or here else self._lengths(self.x0[None], layer)[0]
                )
                continue
            if here not in self._steps:
                self._steps[here] = self._costs(places[k - 1], here)
            total = self._totals[places[k - 1]][:, None] + self._steps[here]
            self._before[here] = total.argmin(axis=0)
            self._totals[here] = total.min(axis=0)

    def _trace(self, places: list[int]) -> dict[int, int]:
        """The rows of the cheapest way."""
        if not places:
            return {}
        rows = {places[-1]: int(self._totals[places[-1]].argmin())}
        for k in range(len(places) - 1, 0, -1):
            rows[places[k - 1]] = int(self._before[places[k]][rows[places[k]]])
        return rows

    def _look(self, before: int, here: int, rows: dict[int, int]) -> bool:
        """Look at a step in the world, unless that is known or of no use; whether it costs more now."""
        a, b = rows[before], rows[here]
        costs = self._steps[here]
        if self.world is None or (here, a, b) in self._known or (costs[a, b] >= BREAK and not self.moves):
            return False
        self._known.add((here, a, b))
        q0, q1 = self.chain.q(np.array([self.layers[before][a], self.layers[here][b]]), self.base)
        if self.world.clear_between(q0, q1):
            return False
        costs[a, b] += BREAK * ((2 if self.moves else 1) - costs[a, b] // BREAK)
        return True

    def _way(self, places: list[int], rows: dict[int, int]) -> Way:
        breaks, barred = [], []
        for before, here in zip(places, places[1:], strict=False):
            a, b = rows[before], rows[here]
            cost = float(self._steps[here][a, b])
            unknown = self.world is not None and (here, a, b) not in self._known
            if cost >= BREAK or unknown:
                breaks.append(here)
            if cost >= 2.0 * BREAK or (unknown and self.moves):
                barred.append(here)
        return Way(rows, tuple(breaks), tuple(barred))

    def _costs(self, before: int, here: int) -> Singles:
        """Costs (a, b) of the steps between two layers, with what is too long for a step, or to another branch."""
        a, b = self.layers[before], self.layers[here]
        step = self.chain.limits.way(a[:, None], b[None])  # (a, b, n)
        changes = on_other_branches(self._branches(before), self._branches(here))
        costs = np.linalg.norm(step, axis=2) + CHANGE * changes
        costs += BREAK * (np.abs(step) > self.bound).any(axis=2)
        kept: Singles = costs.astype(np.float32)  # they are, of all layers
        return kept

    def _branches(self, i: int) -> Signs:
        """The branches (s, f) of the solutions of a layer, which has two neighbours that ask for them."""
        if i not in self._signs:
            self._signs[i] = self.signs(i, self.layers[i])
        return self._signs[i]

    def _lengths(self, before: Floats, here: Floats) -> Floats:
        lengths: Floats = np.linalg.norm(self.chain.limits.way(before[:, None], here[None]), axis=2)
        return lengths
