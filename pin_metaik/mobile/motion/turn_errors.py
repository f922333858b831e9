"""How wrong tangent lengths are, in the paper's measures and as shares of the full scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array


@dataclass(frozen=True)
class TurnErrors:
    """Errors of tangent lengths over a test set.

    Attributes:
        E0: Mean relative error, percent.
        Em: Largest relative error, percent.
        E5: Points with more than 5 percent.
        F0: Mean error as a share of the longest tangent, percent.
        Fm: Largest error as such a share, percent.
        n: Points.
    """

    E0: float
    Em: float
    E5: int
    F0: float
    Fm: float
    n: int


def turn_errors(predicted: Array, true: Array) -> TurnErrors:
    """Errors of predicted tangent lengths (n,) against true ones (n,), none of them 0."""
    relative = 100 * np.abs(predicted - true) / true
    full = 100 * np.abs(predicted - true) / true.max()
    return TurnErrors(
        float(relative.mean()),
        float(relative.max()),
        int((relative > 5).sum()),
        float(full.mean()),
        float(full.max()),
        len(true),
    )
