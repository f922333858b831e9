"""Singular: wrists, elbows and shoulders that have lost a direction, whatever the arm; found by descent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.compare.cases.case import Case, NoTask, Task
from pin_metaik.compare.cases.jacobians import jacobians
from pin_metaik.kinematics import Chain

SINGULAR = 1e-3  # smallest singular value of the frame's Jacobian (m and rad alike)
SWEEPS, LARGEST = 30, 0.5  # steps from one start, and the longest (rad or m)
PATIENCE = 256  # consecutive starts without a singularity after which the arm counts as having none


def singular(chain: Chain, count: int, rng: np.random.Generator, pool: int = 64) -> NDArray[np.float64]:
    """Coordinates (count, n) where the Jacobian's smallest singular value is below 1e-3, from random starts.

    At a singularity some unit u has A(x) u = 0 with A = J' (or J, of an arm with fewer than six joints). With u the
    singular vector of the smallest value, Gauss and Newton's step on A(x) u, then u anew.

    Args:
        chain: The arm.
        count: How many.
        rng: Where starts come from.
        pool: Starts that are tried at once at least.

    Raises:
        NoTask: The arm has no singular configuration, as far as 256 starts can tell.
    """
    least = min(6, chain.n) - 1
    found = np.empty((0, chain.n))
    barren = 0  # starts in a row that led to none
    while len(found) < count:
        if barren >= PATIENCE:
            raise NoTask(
                f"no configuration of these {chain.n} joints loses a direction: {barren} random starts led to none"
            )
        X = chain.box.sample(rng, max(pool, 2 * (count - len(found))))
        barren += len(X)
        for _ in range(SWEEPS):
            A = tall(jacobians(chain, X))  # (k, m, least + 1)
            _, sigma, Vt = np.linalg.svd(A, full_matrices=False)
            done = sigma[:, least] < SINGULAR
            found = np.concatenate((found, X[done]))
            barren = 0 if done.any() else barren
            X, A, u = X[~done], A[~done], Vt[~done, least]
            if not len(X) or len(found) >= count:
                break
            r = np.einsum("kij,kj->ki", A, u)  # (k, m)
            slope = np.empty((len(X), A.shape[1], chain.n))  # of r, by differences
            for i in range(chain.n):
                h = np.zeros(chain.n)
                h[i] = 1e-6
                slope[:, :, i] = np.einsum("kij,kj->ki", tall(jacobians(chain, X + h)) - A, u) / 1e-6
            normal = np.swapaxes(slope, 1, 2) @ slope + 1e-6 * np.eye(chain.n)
            step = -np.linalg.solve(normal, np.einsum("kji,kj->ki", slope, r)[..., None])[..., 0]
            step *= np.minimum(1.0, LARGEST / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12))
            X = np.minimum(np.maximum(X + step, chain.box.lower), chain.box.upper)
    return found[:count]


def tall(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of Jacobians (k, 6, n) the transposes, unless that would leave more columns than rows."""
    return np.swapaxes(J, 1, 2) if J.shape[2] >= 6 else J


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A singular pose; a pool of two starts hardly prefers the singularities that are quickly found."""
    return Task.at(chain, singular(chain, 1, rng, pool=2))


SINGULAR_POSES = Case(
    "singular",
    "Poses of configurations whose Jacobian has a singular value below 1e-3 (wrist, elbow or shoulder, whichever is "
    "near a random configuration), found by Gauss-Newton steps.",
    draw,
)
