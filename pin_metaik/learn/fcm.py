"""Fuzzy c-means: every point belongs to every cluster, to the nearer ones more (Bezdek 1981)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.learn.tables import as_table
from pin_metaik.plain import fields_of
from pin_metaik.randomness import as_generator
from pin_metaik.watching import Progress, Watch, ended, tell

CHUNK = 2**16  # memberships held at a time: half a megabyte, which stays in the cache
COINCIDENT = 1e-300  # squared distance of a point from a centre it lies on


@dataclass(frozen=True, eq=False)
class Clusters:
    """The result of fuzzy c-means.

    Attributes:
        centres: (c, d) centres of the clusters.
        objective: J after each iteration (i,), never rising; computed with the centres at the beginning of the
            iteration.
        converged: Whether the centres came to rest within the iterations allowed.
        interrupted: Whether Ctrl-C or a watch ended it.
    """

    centres: Array
    objective: Array
    converged: bool
    interrupted: bool = False

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return fields_of(self, "centres", "objective", "converged", "interrupted")


@checked
def fuzzy_c_means(
    Z: ArrayLike,
    clusters: int,
    *,
    m: float = 2.0,
    iterations: int = 300,
    tolerance: float = 1e-6,
    rng: int | np.random.Generator | None = 0,
    start: ArrayLike | None = None,
    watch: Watch | None = None,
) -> Clusters:
    """Minimise ``J = sum u_ik^m |z_k - v_i|^2`` alternately over memberships u and centres v (Bezdek 1981).

    It starts from points drawn at random: from random memberships all centres begin near the mean, and have hardly
    moved after a hundred iterations. The memberships are never stored all at once: 23,779 x 1,064 of them would take
    200 MB.

    Args:
        Z: Points (n, d); scale the columns alike, the distance is Euclidean.
        clusters: c, at most n.
        m: Fuzziness, above 1.
        iterations: Largest number of iterations.
        tolerance: It ends when no centre has moved by more than this share of the range of the data's widest column.
        rng: Seed or generator; ``None`` is a fixed seed.
        start: Centres (c, d) to begin at instead, e.g. to go on with a run that was cut short.
        watch: Called after every iteration with the number of iterations and J; returning True ends the search.

    Raises:
        InvalidSetting: Points that are not a table of finite numbers, or settings out of range.
        Interrupted: Ctrl-C; its ``result`` is the clusters so far.
    """
    Z = as_table("the points", Z)
    if not 1 <= clusters <= len(Z):
        raise InvalidSetting(f"clusters must be between 1 and the {len(Z)} points, not {clusters!r}")
    if not 1 < m < math.inf:
        raise InvalidSetting(f"m must be a finite number above 1, not {m!r}")
    if iterations < 1 or not tolerance >= 0:
        raise InvalidSetting(f"iterations must be at least 1 and tolerance at least 0, not {iterations}, {tolerance}")
    generator = as_generator(rng)
    centres = Z[generator.choice(len(Z), clusters, replace=False)] if start is None else as_table("the start", start)
    if centres.shape != (clusters, Z.shape[1]):
        raise InvalidSetting(f"the start has shape {centres.shape}: expected ({clusters}, {Z.shape[1]})")
    rest = tolerance * float(np.ptp(Z, axis=0).max())
    objective: list[float] = []
    converged = False
    try:
        while not converged and len(objective) < iterations:
            moved, J = _step(Z, centres, m)
            objective.append(J)
            converged = bool(np.abs(moved - centres).max() <= rest)
            centres = moved
            tell(watch, Progress(len(objective), iterations, J))
    except KeyboardInterrupt as stop:
        return ended(stop, Clusters(centres, np.array(objective), converged, interrupted=True))
    return Clusters(centres, np.array(objective), converged)


@checked
def memberships(Z: ArrayLike, centres: ArrayLike, m: float = 2.0) -> Array:
    """The memberships (c, n) of points Z (n, d) in clusters with centres (c, d): columns sum to one."""
    Z, centres = as_table("the points", Z), as_table("the centres", centres)
    if Z.shape[1] != centres.shape[1]:
        raise InvalidSetting(f"points and centres have as many columns, got {Z.shape[1]} and {centres.shape[1]}")
    if not 1 < m < math.inf:
        raise InvalidSetting(f"m must be a finite number above 1, not {m!r}")
    W = np.empty((len(Z), len(centres)))
    _weigh(Z, centres, m, W, np.empty_like(W))
    U: Array = (W / W.sum(axis=1, keepdims=True)).T
    return U


def _step(Z: Array, centres: Array, m: float) -> tuple[Array, float]:
    """New centres (c, d), and J of the old ones."""
    total, weight, J = np.zeros_like(centres), np.zeros(len(centres)), 0.0
    rows = max(1, CHUNK // len(centres))
    space = np.empty((2, rows, len(centres)))
    for first in range(0, len(Z), rows):
        z = Z[first : first + rows]
        W, spare = space[:, : len(z)]
        nearest = _weigh(z, centres, m, W, spare)
        S = W.sum(axis=1)
        J += float((nearest * S ** (1 - m)).sum())  # sum_i u^m d^2 = nearest S^(1 - m)
        W /= S[:, None]  # u
        U = np.square(W, out=W) if m == 2 else np.power(W, m, out=W)
        total += U.T @ z
        weight += U.sum(axis=0)
    return total / weight[:, None], J


def _weigh(z: Array, centres: Array, m: float, W: Array, spare: Array) -> Array:
    """Fill W (k, c) with ``(d_min / d_i)^(2 / (m - 1))`` for points (k, d); squared distances d_min^2 (k,)."""
    W.fill(COINCIDENT)
    for x, v in zip(z.T, np.ascontiguousarray(centres.T), strict=True):
        np.subtract(x[:, None], v, out=spare)
        W += np.square(spare, out=spare)
    nearest: Array = W.min(axis=1)
    np.divide(nearest[:, None], W, out=W)
    if m != 2:
        np.power(W, 1 / (m - 1), out=W)
    return nearest
