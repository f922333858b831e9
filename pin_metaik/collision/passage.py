"""The search along one straight joint move: parts of it proved free by distances, or cut in two.

In the middle of a part, bodies that are farther apart than their margin and all that they can move until its ends are
free in the whole part. What is nearer leaves the outer rests of the part, down to the resolution. A collision is one of
a configuration that the world's own check calls one.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.checker import ENCLOSED, Checker
from pin_metaik.collision.screws import Screws
from pin_metaik.collision.solids import Placed
from pin_metaik.collision.travel import Carriers, Travel

INEXACT = 1.0 - 1e-6  # of a distance, what coal's may be off by
MANY, FAR = 12, 0.05  # pairs with boxes near each other that may move so far, m: then a part is cut in two at once
USEFUL = 0.25  # of what a pair can move: a distance of hulls below that is not relied on, meshes are asked
GRID = 4  # steps of the distances that meshes are asked about, for each doubling: coal's requests are kept


class Found(NamedTuple):
    """How far a move is proved free, and where it collides (NaN: nowhere that was found), as fractions of it."""

    clear: float
    touch: float


class _Look(NamedTuple):
    """What the middle of a part says.

    Attributes:
        collides: Whether the configuration there collides.
        free: Which share of the part, around its middle, is proved free.
        span: The farthest (m) that any pair that is not proved free moves in half of the part.
    """

    collides: bool
    free: float
    span: float


@dataclass(frozen=True, eq=False)
class Passages:
    """Straight joint moves of a robot in a world, as its checks are laid out now.

    Attributes:
        checker: The checks.
    """

    checker: Checker

    @cached_property
    def carriers(self) -> Carriers:
        """What carries the bodies."""
        return Carriers(self.checker)

    @property
    def screws(self) -> Screws:
        """How the joints move."""
        return self.carriers.screws

    def first(self, q0: NDArray[np.float64], way: NDArray[np.float64], resolution: float) -> Found:
        """How far along a move nothing collides, and where something does.

        Args:
            q0: (nq,) where it starts.
            way: (nv,) the move.
            resolution: m that bodies may move in a part that is not decided.
        """
        passage = _Passage(self, q0, way)
        if passage.collides(0.0):
            return Found(0.0, 0.0)
        clear, touch = math.inf, math.nan
        parts = [(0.0, 1.0)]
        while parts:
            begin, end = parts.pop()
            look = passage.look(begin, end)
            rests = _rests(begin, end, 0.0 if look.collides else look.free)
            if look.collides:
                touch, parts, rests = 0.5 * (begin + end), [], rests[:1]
            if rests and 2.0 * look.span <= resolution:
                clear = min(clear, begin)
                rests = []
            parts += rests[::-1]
        return Found(min(clear, 1.0), touch)

    def free(self, q0: NDArray[np.float64], way: NDArray[np.float64], resolution: float) -> bool:
        """Whether a move is proved free; arguments as for ``first``."""
        passage = _Passage(self, q0, way)
        if passage.collides(0.0) or passage.collides(1.0):
            return False
        parts = deque([(0.0, 1.0)])
        while parts:  # the longest first: where something collides, it is found soon
            begin, end = parts.popleft()
            look = passage.look(begin, end)
            if look.collides or (look.free < 1.0 and 2.0 * look.span <= resolution):
                return False
            parts += _rests(begin, end, look.free)
        return True


def _rests(begin: float, end: float, free: float) -> list[tuple[float, float]]:
    """What is left of a part on both sides of the share that is free."""
    if free >= 1.0:
        return []
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    return [(begin, middle - free * half), (middle + free * half, end)]


class _Passage:
    """One move, and scratch to look at parts of it."""

    def __init__(self, passages: Passages, q0: NDArray[np.float64], way: NDArray[np.float64]) -> None:
        self._checker, self._q0, self._way = passages.checker, q0, way
        self._screws, self._travel = passages.screws.along(way), Travel(passages.carriers)

    def collides(self, fraction: float) -> bool:
        """Whether the configuration there collides."""
        return self._checker.collides(self._at(fraction))

    def look(self, begin: float, end: float) -> _Look:
        """What the middle of a part says of the whole part."""
        middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
        placed = self._checker.solids.place(self._at(middle))
        self._travel.measure(half, placed.joints, self._screws)
        near = self._travel.near(placed)  # the others are free in the whole part
        reaches = [self._travel.of(i, own) for i, _, own in near]
        if len(near) > MANY and max(reaches) > FAR:
            return _Look(self._checker.collides_placed(placed), 0.0, max(reaches))
        free, span = 1.0, 0.0
        for (i, j, own), reach in zip(near, reaches, strict=True):
            share = self._share(placed, i, j, own, reach)
            if share < 0.0 and self._checker.collides_placed(placed):
                return _Look(True, 0.0, reach)
            if share < 1.0:
                free, span = min(free, max(share, 0.0)), max(span, reach)
        return _Look(False, free, span)

    def _share(self, placed: Placed, i: int, j: int, own: int, reach: float) -> float:
        """The share of half of a part in which two bodies are proved free, at most 1; below 0 they may collide."""
        if reach == 0.0:
            return 1.0  # as they are at the start of the move, where nothing collides
        checker = self._checker
        margin = checker.margin_of(i, j, own)
        a, b, c, d = checker.levels_of(i, j, own)
        levels = checker.solids.levels
        hulls = levels[i].hull if a.mesh else a, levels[j].hull if b.mesh else b
        room = INEXACT * placed.distance(*hulls) - margin - ENCLOSED
        if room > USEFUL * reach:
            return min(room / reach, 1.0)
        fine = (c, d) if checker.exact else (a, b)
        finer = fine[0] is not hulls[0] or fine[1] is not hulls[1]
        if finer and not placed.overlap(*fine, margin + _rounded_up(reach)):
            return 1.0
        if checker.collide(placed, i, j, own):
            return -1.0
        return max(room / reach, 0.0)

    def _at(self, fraction: float) -> NDArray[np.float64]:
        q: NDArray[np.float64] = pin.integrate(self._checker.solids.model, self._q0, fraction * self._way)
        return q


def _rounded_up(distance: float) -> float:
    """A distance that is a little more, one of a few: m."""
    step = math.ceil(GRID * math.log2(distance + 2.0 * ENCLOSED))
    return math.pow(2.0, step / GRID) + ENCLOSED
