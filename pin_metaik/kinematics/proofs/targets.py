"""A target's pose as proofs take it: a rotation to the last digit, and how far the given matrix is from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def exact_pose(pose: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The pose (4, 4) with the nearest rotation, and by how much the given matrix stretches a vector at most."""
    left, stretch, right = np.linalg.svd(pose[:3, :3])
    exact = pose.copy()
    exact[:3, :3] = left @ right
    return exact, float(np.abs(stretch - 1.0).max())
