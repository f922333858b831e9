"""Distances kept between bodies: the margin of all pairs, and additions by name or for one pair."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from pin_metaik.collision.srdf import Pair, pair_of
from pin_metaik.errors import InvalidSetting

Key: TypeAlias = str | Pair
"""A name, or the names of a pair."""


def names_of(key: Key) -> tuple[str, ...]:
    """The one or two names of a key."""
    return (key,) if isinstance(key, str) else key


def read_padding(padding: Mapping[Key, float]) -> dict[Key, float]:
    """Paddings of a caller, the names of a pair in alphabetical order.

    Raises:
        InvalidSetting: If one is not a finite distance of at least 0 m, or a pair is one name, or there twice.
    """
    read: dict[Key, float] = {}
    for given, distance in padding.items():
        key = given if isinstance(given, str) else pair_of(*given)
        if not 0.0 <= distance < math.inf:
            raise InvalidSetting(f"a padding is a finite distance of at least 0 m, got {distance!r} for {key!r}")
        if key in read or len(set(names_of(key))) < len(names_of(key)):
            raise InvalidSetting(
                f"a padding is for one name or for a pair of different names, each once, got {given!r}"
            )
        read[key] = float(distance)
    return read


def check_padding(padding: Mapping[Key, float], disabled: Mapping[Pair, str]) -> None:
    """Make sure that the pairs that are to be kept apart are checked.

    Raises:
        InvalidSetting: One is not; the message says why.
    """
    for key in padding:
        reason = "" if isinstance(key, str) else disabled.get(key, "")
        if reason not in ("", "Never"):
            raise InvalidSetting(
                f"a padding of {key[0]!r} and {key[1]!r} has no effect: they are not checked ({reason})"
            )


def entries(name: str, padding: float | Mapping[str, float]) -> dict[Key, float]:
    """The padding of one body: a distance to all others, or one to each body by name, m."""
    if isinstance(padding, Mapping):
        return {pair_of(name, other): distance for other, distance in padding.items()}
    return {name: padding} if padding else {}


@dataclass(frozen=True)
class Padding:
    """The distances at or below which pairs of bodies collide.

    Attributes:
        margin: Of every pair, m ...
        by: ... and what is added, m: by name, in all pairs of a body; by pair, instead of what its two names add.
    """

    margin: float = 0.0
    by: Mapping[Key, float] = field(default_factory=dict)

    def between(self, first: str, second: str) -> float:
        """The distance of two bodies, m."""
        if not self.by:
            return self.margin
        added = self.by.get(pair_of(first, second))
        return self.margin + (self.by.get(first, 0.0) + self.by.get(second, 0.0) if added is None else added)

    def names(self, first: str, second: str) -> bool:
        """Whether the pair itself was asked to be kept apart."""
        return pair_of(first, second) in self.by

    def most(self, name: str) -> float:
        """So much is added for a body that what this says of two bodies is, summed up, never too little, m."""
        return self._most.get(name, 0.0)

    @property
    def pairs(self) -> Padding:
        """What was asked for pairs alone: of all others nothing, of these the same."""
        return Padding(0.0, {key: self.between(*key) for key in self.by if not isinstance(key, str)})

    @cached_property
    def _most(self) -> dict[str, float]:
        most: dict[str, float] = {}
        for key, distance in self.by.items():
            for name in names_of(key):
                most[name] = max(distance, most.get(name, 0.0))
        return most
