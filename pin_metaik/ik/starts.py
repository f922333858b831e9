"""Where a refiner starts: from q0, then from configurations drawn uniformly inside the limits."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics import Chain
from pin_metaik.randomness import DEFAULT_SEED, Rng

FIRST, BATCH = 16, 64  # starts refined before the first look at the clock and at the reach, and between further ones


def start_batches(
    chain: Chain, x0: NDArray[np.float64], rng: Rng, count: int | None, tried: int = 0
) -> Iterator[NDArray[np.float64]]:
    """Starts (s, n) in batches, x0 the very first; ``count`` in all, or endless; less the batches already ``tried``."""
    given = 0
    for index in itertools.count(tried):
        starts = drawn(chain, rng, index, BATCH if index else FIRST)
        if index == 0:
            starts = np.concatenate([x0[None], starts[1:]])
        if count is not None:
            starts = starts[: count - given]
        given += len(starts)
        yield starts
        if given == count:
            return


def drawn(chain: Chain, rng: Rng, index: int, size: int) -> NDArray[np.float64]:
    """One batch of starts, not to be written to: from a generator, or the same for the same seed and index."""
    if isinstance(rng, np.random.Generator):
        return chain.box.sample(rng, size)
    return chain.sample(size, (DEFAULT_SEED if rng is None else rng, index))
