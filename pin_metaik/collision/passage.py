"""The search along one straight joint move: parts of it proved free by distances, or cut in two.

In the middle of a part, bodies that are farther apart than their margin and all that they can move until its ends are
free in the whole part. What is nearer leaves the outer rests of the part, down to the resolution. A collision is one of
a configuration that the world's own check calls one.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, cast

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.checker import ENCLOSED, Checker
from pin_metaik.collision.screws import Screws
from pin_metaik.collision.solids import Placed

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
    def screws(self) -> Screws:
        """How the joints move."""
        return Screws(self.checker.solids.model)

    @cached_property
    def supports(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The joints (m, D) that carry each moving body, from the base on, and how many (m,)."""
        model, bodies = self.checker.solids.model, self.checker.solids.moving
        ways = [list(model.supports[body.joint])[1:] for body in bodies]
        supports = np.zeros((len(ways), max(map(len, ways), default=0) + 1), dtype=np.int64)
        for row, way in zip(supports, ways, strict=True):
            row[: len(way)] = way
        return supports, np.array([len(way) for way in ways], dtype=np.int64)

    @cached_property
    def common(self) -> NDArray[np.int64]:
        """How many joints (p,) carry both bodies of a pair that moves."""
        supports, depths = self.supports
        shared = [
            int((supports[i, :d] == supports[j, :d]).cumprod().sum())
            for i, j in self.checker.asked.own.tolist()
            for d in [min(depths[i], depths[j])]
        ]
        return np.array(shared, dtype=np.int64)

    @cached_property
    def balls(self) -> NDArray[np.float64]:
        """(m, 5) a ball around each moving body in its joint's frame, and how far it reaches from that joint's axis."""
        rows = []
        for body in self.checker.solids.moving:
            box, axis = body.solid.box, self.screws.axes[body.joint]
            corners = body.solid.corners
            middle = body.placement.act(box[:3])
            points = corners @ body.placement.rotation.T + body.placement.translation
            radius = np.linalg.norm(points - middle, axis=1).max()
            lever = np.linalg.norm(np.cross(points - axis[:3], axis[3:]), axis=1).max()
            rows.append([*middle, radius, math.inf if np.isnan(lever) else lever])
        return np.array(rows).reshape(-1, 5)

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
        from pin_metaik.collision.spans import span

        solids, asked = self._checker.solids, self._checker.asked
        self._boxes, self._paddings = solids.boxes.copy(), np.ascontiguousarray(solids.boxes[:, 7])
        self._wide, self._reaches = asked.margins.copy(), np.zeros(len(asked.margins))
        self._asked = replace(asked, margins=self._wide)
        supports, depths = passages.supports
        self._moved = np.zeros(supports.shape)
        bodies = passages.screws.along(way), supports, depths, passages.balls
        pairs = asked.own, passages.common, asked.margins, self._paddings
        self._span = cast(Any, span).compiled()  # a frame less
        self._given = *bodies, *pairs, self._moved, self._reaches, self._wide, self._boxes

    def collides(self, fraction: float) -> bool:
        """Whether the configuration there collides."""
        return self._checker.collides(self._at(fraction))

    def look(self, begin: float, end: float) -> _Look:
        """What the middle of a part says of the whole part."""
        middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
        placed = self._checker.solids.place(self._at(middle))
        near = self._near(placed, half)
        reaches = [self._reaches[own] if own >= 0 else self._moved[i, 0] for i, _, own in near]
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

    def _near(self, placed: Placed, half: float) -> list[list[int]]:
        """The pairs whose boxes are not farther apart than their margin and what they can move in half of a part."""
        self._span(half, placed.joints, *self._given)
        return placed.near(self._asked, boxes=self._boxes)

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
