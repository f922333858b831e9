"""Randomness enters once: the ``rng`` of a caller becomes a generator, and is handed down."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from pin_metaik.errors import InvalidSetting

Rng: TypeAlias = int | np.random.Generator | None

DEFAULT_SEED = 0
"""What ``rng=None`` stands for everywhere: the same call gives the same answer."""


def as_generator(rng: Rng | tuple[int, ...]) -> np.random.Generator:
    """The generator itself, or one seeded with a number or numbers; ``None`` is ``DEFAULT_SEED``.

    Raises:
        InvalidSetting: If it is neither.
    """
    try:
        return np.random.default_rng(DEFAULT_SEED if rng is None else rng)
    except (TypeError, ValueError):
        raise _no_rng(rng[0] if isinstance(rng, tuple) else rng) from None


def as_seed(rng: Rng) -> int | None:
    """The seed itself, or None; of a generator one number of 62 bits, drawn from it.

    So the caller's generator is one draw on after a search, however hard that was.

    Raises:
        InvalidSetting: If it is neither.
    """
    if rng is None or (type(rng) is int and rng >= 0):
        return rng
    if isinstance(rng, np.random.Generator):
        return rng.bit_generator.random_raw() >> 2  # what ``integers(2**62)`` gives, in a sixth of its time
    if isinstance(rng, (int, np.integer)) and rng >= 0:
        return int(rng)
    raise _no_rng(rng)


def repeatable(rng: Rng) -> int | None:
    """The seed that gives the same numbers again; None of a generator, which is somewhere in its own."""
    return None if isinstance(rng, np.random.Generator) else int(DEFAULT_SEED if rng is None else rng)


def _no_rng(given: object) -> InvalidSetting:
    return InvalidSetting(f"rng is a seed of at least 0, a numpy Generator or None, got {given!r}")
