"""Selectively damped least squares: every singular direction is damped by how far it would swing the robot."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import instance
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.refine.iterate import Patience, iterate
from pin_metaik.ik.refine.protocol import Refinement
from pin_metaik.optimize.settings import positive

ZERO = 1e-10  # singular values below it have no direction to damp


@dataclass(frozen=True)
class SDLS:
    """Selectively damped least squares (Buss and Kim 2005), clipped at the limits.

    The paper places end effectors; here each position and each orientation of a frame counts as one of them.

    Attributes:
        largest: gamma_max, the most that any coordinate moves in one step, rad or m.
        patience: When a start is given up.
    """

    largest: float = np.pi / 4.0
    patience: Patience = field(default=Patience(share=0.8))

    def __post_init__(self) -> None:
        """Raises InvalidSetting for a largest step that is not above 0."""
        positive("largest", self.largest)

    def refine(self, problem: IKProblem, starts: NDArray[np.float64], evaluations: int) -> Refinement:
        """Descend from each of the starts (s, n), in order, until one meets the tolerances or the budget is spent."""
        instance(IKProblem, problem=problem)
        effectors = effectors_of(problem)

        def step(
            x: NDArray[np.float64], r: NDArray[np.float64], J: NDArray[np.float64], square: float
        ) -> NDArray[np.float64]:
            return self.step(r, J, effectors)

        return iterate(problem, starts, evaluations, step, self.patience)

    def step(
        self, r: NDArray[np.float64], J: NDArray[np.float64], effectors: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """dx (n,) for a residual r (m,), its Jacobian J (m, n), and which rows belong to which effector (e, m)."""
        U, sigma, Vt = np.linalg.svd(J, full_matrices=False)  # J = U diag(sigma) V'
        sigma = np.maximum(sigma, ZERO)
        alpha = U.T @ -r
        N = np.sqrt(effectors @ (U * U)).sum(axis=0)  # how far a unit along u_i moves the effectors
        rho = np.sqrt(effectors @ (J * J)).sum(axis=0)  # how far a unit of each coordinate moves them
        M = np.abs(Vt) @ rho / sigma  # how far the coordinates swing them on the way
        gamma = N / np.maximum(N, M) * self.largest  # min(1, N / M) gamma_max
        phi = clamp((alpha / sigma)[:, None] * Vt, gamma[:, None])  # (k, n)
        return clamp(phi.sum(axis=0), self.largest)


def clamp(rows: NDArray[np.float64], most: float | NDArray[np.float64]) -> NDArray[np.float64]:
    """ClampMaxAbs: rows (..., n), each scaled down so that no entry is larger than ``most``."""
    largest = np.abs(rows).max(axis=-1, keepdims=True)
    scaled: NDArray[np.float64] = rows * (most / np.maximum(largest, most))
    return scaled


def effectors_of(problem: IKProblem) -> NDArray[np.float64]:
    """Which residuals belong to which frame's position or orientation, or which other goal: (e, m), ones and zeros."""
    placed = 2 * problem.rows[:, 0] + problem.rows[:, 1] // 3
    others = np.repeat(-1 - np.arange(len(problem.goals.sizes)), problem.goals.sizes)
    owner = np.concatenate([placed, others])  # (m,)
    effectors: NDArray[np.float64] = np.equal.outer(np.unique(owner), owner).astype(np.float64)
    return effectors
