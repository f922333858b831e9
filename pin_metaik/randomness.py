"""Randomness comes in by one door: what somebody gave as ``rng`` becomes a generator once, and is handed down."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from pin_metaik.errors import InvalidSetting

Rng: TypeAlias = int | np.random.Generator | None

DEFAULT_SEED = 0
"""What ``rng=None`` stands for in inverse kinematics: the same call gives the same answer."""


def as_generator(rng: Rng | tuple[int, ...]) -> np.random.Generator:
    """The generator itself, or one seeded with a number or numbers; with ``None`` from the operating system.

    Raises:
        InvalidSetting: If it is neither.
    """
    try:
        return np.random.default_rng(rng)
    except (TypeError, ValueError):
        given = rng[0] if isinstance(rng, tuple) else rng
        raise InvalidSetting(f"rng is a seed of at least 0, a numpy Generator or None, got {given!r}") from None
