"""Shuffled frog leaping: in every memeplex the worst frog leaps towards the best, then all are shuffled."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import one_of, whole, within

Leapers = Literal["worst", "all"]


@dataclass(frozen=True)
class SFLA:
    """Shuffled frog leaping, Eusuff and Lansey 2003, as Elbeltagi et al. 2005 write it: without sub-memeplexes.

    By default frogs leap beyond the best frog: ``leap=1.3`` is the C_L of the modified SFLA (Ibrahim 2018), here with
    the fall-backs of the published SFLA. ``SFLA(leap=1)`` is SFLA as published; ``SFLA(memeplexes=3, fallbacks=False)``
    is Ibrahim's text to the letter. The memeplexes leap side by side, each with its own worst frog. A leap that does
    not improve the frog is not made; one that ends outside the box ends on its wall.

    ``leapers="all"`` lets every frog but its memeplex's best leap at every step, all at once, as the computing times
    printed by Ibrahim suggest.

    Assumed: ``rand`` is drawn for every coordinate. With one number for all, frogs stay on the lines to their leaders
    and the population goes flat: on the shifted 10-D sphere with 20,000 evaluations it ends at 500 instead of 1e-5.

    Attributes:
        frogs: Population NP, at least two a memeplex.
        memeplexes: m.
        leaps: Leaps of each memeplex between two shuffles, iM.
        leap: C_L: how far a frog may leap, 1 being the frog it leaps to.
        largest_leap: D_max as a share of the width of the box.
        fallbacks: Whether a frog that did not improve leaps towards the best of all, then to a random place.
        leapers: Which frogs of a memeplex leap: its ``worst``, or ``all`` but its best.
    """

    frogs: int = 200
    memeplexes: int = 20
    leaps: int = 10
    leap: float = 1.3
    largest_leap: float = 1.0
    fallbacks: bool = True
    leapers: Leapers = "worst"

    def __post_init__(self) -> None:
        whole("memeplexes", self.memeplexes, 1)
        whole("frogs", self.frogs, 2 * self.memeplexes)
        whole("leaps", self.leaps, 1)
        within("leap", self.leap, 0)
        within("largest_leap", self.largest_leap, 0)
        one_of("leapers", self.leapers, Leapers)
        if not isinstance(self.fallbacks, bool):
            raise InvalidSetting(f"fallbacks must be True or False, not {self.fallbacks!r}")

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose the frogs (frogs, n), then leaps (at most memeplexes, n), for ever."""
        rng, space, m = run.rng, run.space, self.memeplexes
        D_max = self.largest_leap * space.width
        X = run.start(self.frogs)
        f = yield X
        columns, everybody = np.arange(m), np.arange(len(f))
        vacant = np.arange(-(-len(f) // m) * m).reshape(-1, m) >= len(f)
        while True:
            # Shuffle: frog i, counted from the best, joins memeplex i % m; each column of the table is a memeplex.
            ranks = f.argsort(kind="stable")
            X, f = X[ranks], f[ranks]
            table = np.full(vacant.shape, -np.inf)  # a place without a frog is never the worst
            cost = table.reshape(-1)  # the same numbers, by frog
            cost[: len(f)] = f
            best = columns
            for _ in range(self.leaps):
                match self.leapers:
                    case "worst":
                        frogs = table.argmax(axis=0) * m + columns
                    case "all":
                        frogs = np.delete(everybody, best)
                best_of_all = np.full(m, best[cost[best].argmin()])
                for leader in (best, best_of_all) if self.fallbacks else (best,):
                    D = self.leap * rng.random((len(frogs), space.dimension)) * (X[leader[frogs % m]] - X[frogs])
                    x = space.clip(X[frogs] + np.minimum(np.maximum(D, -D_max), D_max))
                    costs = yield x
                    better = costs < cost[frogs]
                    X[frogs[better]], cost[frogs[better]] = x[better], costs[better]
                    frogs = frogs[~better]
                    if not len(frogs):
                        break
                if self.fallbacks and len(frogs):
                    X[frogs] = space.sample(rng, len(frogs))
                    cost[frogs] = yield X[frogs]
                best = np.where(vacant, np.inf, table).argmin(axis=0) * m + columns
            f = cost[: len(f)]
