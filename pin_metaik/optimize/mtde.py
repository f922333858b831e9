"""Multi-trial vector differential evolution: three ways to make trial vectors compete for the population."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.optimize.pick import below, others
from pin_metaik.optimize.search import Search
from pin_metaik.optimize.settings import whole, within

R, L, G = range(3)  # the trial-vector producers: representative, local random, global best history
SHARES = {R: (0.6, 0.2, 0.2), L: (0.2, 0.6, 0.2), G: (0.4, 0.4, 0.2)}  # of the population, by winner (16, 17)


@dataclass(frozen=True)
class MTDE:
    """MTDE, Nadimi-Shahraki et al. 2020, Applied Soft Computing 97 (equations as numbered in the RV-7FL paper).

    Where the paper is silent this assumes: the population is dealt to the producers anew, at random, every iteration;
    x_r1 and x_r2 come from the producer's own share; of the history of global bests the latest are used; coordinates
    that leave the box go half-way back (Zhang and Sanderson 2009, JADE).

    Attributes:
        agents: Individuals N, at least 20, so that differences can be formed within a fifth of them.
        patience: Iterations between two choices of the winner, n or WinIter; the paper gives none.
        a2_initial: Weight of the union in L-TVP at the end of the run: Eq. 24 runs backwards.
        a2_final: The same at the beginning.
        scale: First location mu_f of the Cauchy distribution of the scale factors.
        spread: Width of that distribution.
    """

    agents: int = 50
    patience: int = 20
    a2_initial: float = 0.001
    a2_final: float = 2.0
    scale: float = 0.5
    spread: float = 0.2

    def __post_init__(self) -> None:
        whole("agents", self.agents, 20)
        whole("patience", self.patience, 1)
        within("a2_initial", self.a2_initial, 0)
        within("a2_final", self.a2_final, 0)
        within("scale", self.scale, 0, 1)
        within("spread", self.spread, 0)

    def search(self, run: Search) -> Generator[Array, Array, None]:
        """Propose trial vectors (agents, n), for ever."""
        rng, space, N, D = run.rng, run.space, self.agents, run.space.dimension
        union = np.empty((2 * N, D))  # unionPopulation: the population and behind it its life-time archive
        X, archive = union[:N], union[N:]
        archived = 0  # losers so far; the archive is a ring, so the N youngest stay
        X[:] = run.start(N)
        f = yield X
        history, best = X[[f.argmin()]], f.min()  # the global bests so far, newest first (m, D); the cost of the newest
        mu, mu_f = math.log(D), self.scale
        winner = R
        while True:
            producers, improved, spent = deal(N, winner), np.zeros(3), np.zeros(3)
            for _ in range(self.patience):
                shuffled = rng.permutation(N)
                X[:], f = X.take(shuffled, axis=0), f.take(shuffled)
                t = run.progress  # iter / MaxIter
                a1 = 2 - 2 * t  # (22)
                a2 = self.a2_initial - (self.a2_initial - self.a2_final) * (1 - t) ** mu  # (24)
                F = positive_cauchy(rng, mu_f, self.spread, N)[:, None]
                x_Upop = union.take(below(rng, N + min(archived, N), N), axis=0)
                r, l, g = producers  # noqa: E741  the paper's letters
                v_R = representative(X[r], f[r], F[r], x_Upop[r], a1)
                v_L = local_random(rng, X[l], F[l], x_Upop[l], a2)
                v_G = global_history(rng, X[g], F[g], history)
                M = transformation(rng, N, D)
                M[l] = False  # L-TVP: u = v
                U = np.where(M, X, np.concatenate((v_R, v_L, v_G)))  # u = M x + (1 - M) v (20, 25)
                U = space.halfway(U, X)

                costs = yield U
                wins = costs < f
                improved += [np.count_nonzero(wins[share]) for share in producers]
                spent += [share.stop - share.start for share in producers]
                better = np.flatnonzero(wins)
                if len(better):
                    mu_f = lehmer_mean(F[better, 0], f[better] - costs[better], mu_f)
                    archived = remember(archive, archived, X[better])
                    X[better], f[better] = U[better], costs[better]
                    if f.min() < best:
                        history, best = np.concatenate((X[[f.argmin()]], history[: N - 1])), f.min()
            winner = int((improved / spent).argmax())  # the highest improved rate IR (15)


def deal(count: int, winner: int) -> tuple[slice, slice, slice]:
    """Which of a shuffled population go to R-, L- and G-TVP (16, 17)."""
    share_R, share_L, _ = SHARES[winner]
    end_R, end_L = round(share_R * count), round((share_R + share_L) * count)
    return slice(0, end_R), slice(end_R, end_L), slice(end_L, count)


def remember(archive: Array, archived: int, losers: Array) -> int:
    """Write losers (k, n) over the oldest of the archive (N, n), a ring; returns how many there have been in all."""
    archive[(archived + np.arange(len(losers))) % len(archive)] = losers
    return archived + len(losers)


def representative(x: Array, f: Array, F: Array, x_Upop: Array, a1: float) -> Array:
    """R-TVP (21); the i-th best and the i-th worst of the share go to its i-th individual."""
    order = f.argsort()
    x_best, x_worst = x.take(order, axis=0), x.take(order[::-1], axis=0)
    v: Array = x + F * (x_best - x) + F * (x_worst - x) + a1 * (x_Upop - x)
    return v


def local_random(rng: np.random.Generator, x: Array, F: Array, x_Upop: Array, a2: float) -> Array:
    """L-TVP (23)."""
    x_r1, x_r2, _ = x.take(others(rng, len(x)), axis=0)
    v: Array = x + F * (x_r1 - x_r2) + a2 * (x_Upop - x)
    return v


def global_history(rng: np.random.Generator, x: Array, F: Array, history: Array) -> Array:
    """G-TVP (26); the history is repeated, or cut to its newest, to fill the share."""
    x_gbh = history.take(np.arange(len(x)) % len(history), axis=0)
    x_r1, x_r2, _ = x.take(others(rng, len(x)), axis=0)
    v: Array = x_gbh + F * (x_r1 - x_r2)
    return v


def positive_cauchy(rng: np.random.Generator, location: float, spread: float, count: int) -> Array:
    """Scale factors (count,) from Cauchy(location, spread), redrawn while <= 0, cut at 1.

    Redrawing is done at once, by inverting the distribution above 0.
    """
    if spread == 0:
        return np.full(count, location)
    P_above = 0.5 + math.atan(location / spread) / math.pi  # probability of F > 0
    u = 1 - P_above * rng.random(count)  # uniform on (1 - P_above, 1]
    return np.minimum(location + spread * np.tan(math.pi * (u - 0.5)), 1.0)


def transformation(rng: np.random.Generator, count: int, dimension: int) -> NDArray[np.bool_]:
    """The binary matrix M (count, dimension): where it is True, the trial vector keeps x.

    Strictly lower-triangular matrices, one below the other, their rows and then the entries of each row shuffled (as in
    QUATRE, Meng, Pan and Xu 2016). Strictly: a row of ones only would be a trial vector equal to its parent, and with
    one dimension all of them would.
    """
    kept = rng.permutation(np.arange(count) % dimension)  # how many ones each row has, 0..D-1
    mask: NDArray[np.bool_] = rng.random((count, dimension)).argsort(axis=1) < kept[:, None]
    return mask


def lehmer_mean(F: Array, gain: Array, otherwise: float) -> float:
    """``sum w F^2 / sum w F`` with w the share of the gain (18, 19); infinite gains (from +inf) have no share."""
    w = np.where(np.isfinite(gain), gain, 0.0)
    total = w @ F
    return float(w @ F**2 / total) if total > 0 else otherwise
