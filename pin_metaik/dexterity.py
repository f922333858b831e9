"""Measures of a Jacobian: how well a mechanism can move at a configuration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RANK_TOLERANCE = 1e-6  # of the largest singular value


def singular_values(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Singular values (..., min(m, n)) of Jacobians J (..., m, n), largest first."""
    return np.asarray(np.linalg.svd(J, compute_uv=False), dtype=float)


def manipulability(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Yoshikawa's (1985) measure sqrt(det(J J')) (...,) of Jacobians (..., m, n): product of singular values."""
    product: NDArray[np.float64] = singular_values(J).prod(axis=-1)
    return product


def condition_number(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest over smallest singular value (...,); ``inf`` at a singularity."""
    values = singular_values(J)
    with np.errstate(divide="ignore"):
        ratio: NDArray[np.float64] = values[..., 0] / values[..., -1]
    return ratio


def rank(J: NDArray[np.float64]) -> int:
    """Number of independent directions the mechanism (m, n) can move in."""
    values = singular_values(J)
    return int((values > RANK_TOLERANCE * values[0]).sum())
