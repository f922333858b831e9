"""Random indices the way differential evolution needs them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]


def below(rng: np.random.Generator, count: int, size: int) -> Indices:
    """Numbers (size,) from 0..count-1; for small arrays three times as fast as ``rng.integers``."""
    return (count * rng.random(size)).astype(np.intp)


def others(rng: np.random.Generator, count: int) -> Indices:
    """For each i in 0..count-1 indices r1, r2, r3 that differ from i and from each other: (3, count), count >= 4.

    Each column draws three distinct offsets from 1..count-1: from as many numbers as are left, then moved past those
    already taken. Half of the indices are negative: they count from the end, as numpy does.
    """
    left = np.arange(count - 1, count - 4, -1)[:, None]
    offsets: Indices = (left * rng.random((3, count))).astype(np.intp) + 1
    first, second, third = offsets
    second += second >= first
    third += third >= np.minimum(first, second)
    third += third >= np.maximum(first, second)
    offsets += np.arange(-count, 0)
    return offsets
