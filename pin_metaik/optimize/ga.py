"""Genetic algorithm with real genes (Holland 1975), as the offset-wrist Puma paper sets it up."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.optimize.pick import Indices
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import one_of, whole, within

Selection = Literal["roulette", "tournament"]
Crossover = Literal["one-point", "blend"]


@dataclass(frozen=True)
class GA:
    """Genetic algorithm: roulette wheel, one-point crossover, one-point mutation, elitism; a gene is a coordinate.

    The paper (e-J. New World Sci. Acad. 6(4), 2011, 1A0269) names the operators and the rates and leaves the rest open.
    Assumed: the roulette's weight is how much better than the worst one is (windowing, Goldberg 1989); mutation draws
    one gene of a child anew within its bounds; parents pair up as drawn, each pair has two children; one elite.

    ``GA(selection="tournament", crossover="blend", elites=5)`` is the better choice: roulette loses its pressure as
    costs draw level, one-point crossover only reshuffles coordinates that exist, and blends need more than one elite.

    Attributes:
        agents: Population, at least 2.
        crossover_rate: Probability that a pair's children are crossed rather than copied.
        mutation_rate: Probability that a child has one gene redrawn.
        elites: How many of the best live on unchanged (and are not evaluated again), fewer than agents.
        selection: ``roulette``, or ``tournament`` between two.
        crossover: ``one-point``, or ``blend``: BLX-0.5, Eshelman and Schaffer 1993, clipped to the box.
    """

    agents: int = 100
    crossover_rate: float = 0.9
    mutation_rate: float = 0.2
    elites: int = 1
    selection: Selection = "roulette"
    crossover: Crossover = "one-point"

    def __post_init__(self) -> None:
        whole("agents", self.agents, 2)
        whole("elites", self.elites, 0)
        whole("agents - elites", self.agents - self.elites, 1)
        within("crossover_rate", self.crossover_rate, 0, 1)
        within("mutation_rate", self.mutation_rate, 0, 1)
        one_of("selection", self.selection, Selection)
        one_of("crossover", self.crossover, Crossover)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose the population (agents, n), then children (agents - elites, n), for ever."""
        rng, space, births = run.rng, run.space, self.agents - self.elites
        pairs = (births + 1) // 2
        X = run.start(self.agents)
        f = yield X
        while True:
            match self.selection:
                case "roulette":
                    parents = spin(rng, wheel(f), 2 * pairs)
                case "tournament":
                    one, other = rng.integers(self.agents, size=(2, 2 * pairs))
                    parents = np.where(f[one] <= f[other], one, other)
            mothers, fathers = X[parents[:pairs]], X[parents[pairs:]]
            match self.crossover:
                case "one-point":
                    crossed = one_point(rng, mothers, fathers)
                case "blend":
                    crossed = space.clip(blend(rng, mothers, fathers))
            pair_crosses = np.tile(rng.random(pairs) < self.crossover_rate, 2)
            children = np.where(pair_crosses[:, None], crossed, np.concatenate((mothers, fathers)))[:births]
            mutants = np.flatnonzero(rng.random(births) < self.mutation_rate)
            genes = rng.integers(space.dimension, size=len(mutants))
            children[mutants, genes] = space.sample(rng, len(mutants))[np.arange(len(mutants)), genes]

            costs = yield children
            elite = f.argsort(kind="stable")[: self.elites]
            X, f = np.concatenate((X[elite], children)), np.concatenate((f[elite], costs))


def wheel(costs: Array) -> Array:
    """Probabilities (k,) on the roulette wheel: in proportion to how much better one is than the worst finite cost."""
    finite = np.isfinite(costs)
    weights = np.zeros(len(costs))
    if finite.any():
        weights[finite] = costs[finite].max() - costs[finite]
    if not weights.any():  # all are equally good
        weights[:] = 1
    probabilities: Array = weights / weights.sum()
    return probabilities


def spin(rng: np.random.Generator, probabilities: Array, count: int) -> Indices:
    """Indices (count,) drawn with the given probabilities."""
    edges = probabilities.cumsum()
    drawn: Indices = np.searchsorted(edges, rng.random(count) * edges[-1], side="right")
    return drawn


def one_point(rng: np.random.Generator, mothers: Array, fathers: Array) -> Array:
    """Children (2k, n): the genes before a random cut from one parent, the rest from the other, and the reverse."""
    pairs, n = mothers.shape
    before = np.arange(n) < rng.integers(1, max(n, 2), size=(pairs, 1))
    return np.concatenate((np.where(before, mothers, fathers), np.where(before, fathers, mothers)))


def blend(rng: np.random.Generator, mothers: Array, fathers: Array) -> Array:
    """Children (2k, n): genes uniform on the parents' interval made longer by half of it on both sides (BLX-0.5)."""
    shares = 2 * rng.random((2, *mothers.shape)) - 0.5  # uniform on (-0.5, 1.5)
    return (mothers + shares * (fathers - mothers)).reshape(-1, mothers.shape[1])
