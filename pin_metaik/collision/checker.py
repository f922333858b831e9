"""Checks in three steps: boxes, then coarse solids, then the original geometry, which decides.

No contact between the boxes, or between the coarse solids, implies no contact between the bodies that they enclose. So
the results are those of the original geometry, nearly always at the cost of the coarse one.
"""

from __future__ import annotations

import math
from collections.abc import Container
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.contact import Contact, Distance, Near
from pin_metaik.collision.narrow import TOUCH
from pin_metaik.collision.padding import Padding
from pin_metaik.collision.solids import Level, Pairs, Placed, Solids

ENCLOSED = 1e-6  # m added to the margin of coarse solids: what coal's distances may be off by
INEXACT = 1.0 - 1e-6  # of a distance, what coal's may be off by
NEAR = 0.05  # m beyond the margin: pairs farther apart do not concern a step
REACH = 0.1, 0.5, math.inf  # m; how far the nearest pair is looked for, when no boxes overlap


@dataclass(frozen=True, eq=False)
class Checker:
    """The pairs of moving bodies, and how each is checked.

    Attributes:
        solids: All bodies; those that move are numbered first.
        asked: The pairs; those of bodies that move stand in the order of how often they collide.
        padding: How far bodies are kept from what stands.
        direct: For each pair of bodies that move, whether its coarse solids decide nothing and are left out.
        fixed: Contacts of what cannot move: then every configuration collides.
        exact: Whether the original geometry is asked.
    """

    solids: Solids
    asked: Pairs
    padding: Padding
    direct: tuple[bool, ...]
    fixed: tuple[Contact, ...]
    exact: bool

    @property
    def bodies(self) -> tuple[Body, ...]:
        """All bodies."""
        return (*self.solids.moving, *self.solids.standing)

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Numbers of the two bodies of every pair."""
        moving, standing = np.nonzero(self.asked.against)
        own = [(i, j) for i, j in self.asked.own.tolist()]
        return (*own, *zip(moving.tolist(), (len(self.solids.moving) + standing).tolist(), strict=True))

    def collides(self, q: NDArray[np.float64]) -> bool:
        """Whether anything collides at q (nq,)."""
        return bool(self.fixed) or self.collides_placed(self.solids.place(q))

    def collides_placed(self, placed: Placed) -> bool:
        """Whether anything that moves collides where the bodies are placed."""
        for i, j, own in placed.near(self.asked):  # noqa: SIM110  # a generator takes a tenth of a check
            if self.collide(placed, i, j, own):
                return True
        return False

    def contacts(self, q: NDArray[np.float64]) -> tuple[Contact, ...]:
        """What collides at q (nq,), the deepest first; two bodies count once."""
        deepest: dict[tuple[str, str], Contact] = {(c.first, c.second): c for c in self.fixed}
        for contact, _ in self.contacts_of(q):
            names = contact.first, contact.second
            if names not in deepest or deepest[names].depth < contact.depth:
                deepest[names] = contact
        return tuple(sorted(deepest.values(), key=lambda contact: (-contact.depth, contact)))

    def contacts_of(
        self, q: NDArray[np.float64], joints: Container[int] | None = None
    ) -> list[tuple[Contact, tuple[int, int]]]:
        """Every pair that collides at q (nq,), with the ids of the joints that carry the two.

        With ``joints`` only pairs that such joints carry, both of them.
        """
        placed = self.solids.place(q)
        found = []
        for i, j, own in placed.near(self.asked):
            carriers = self.joint_of(i), self.joint_of(j)
            wanted = joints is None or all(joint in joints for joint in carriers)
            if wanted and self.collide(placed, i, j, own):
                depth = max(0.0, self.margin_of(i, j, own) - self._hulls(placed, i, j).distance)
                found.append((Contact(self._name(i), self._name(j), depth), carriers))
        return found

    def nearest(self, q: NDArray[np.float64], of: Container[str] | None = None) -> Distance:
        """The two bodies nearest to each other at q (nq,), of all that move against each other or of these."""
        placed = self.solids.place(q)
        best = Distance(math.inf, "", "", np.full(3, np.nan), np.full(3, np.nan))
        done: set[tuple[int, int]] = set()
        for reach in (0.0, *REACH):
            near = placed.near(self._bare, min(reach, best.distance))
            new = [(i, j, own) for i, j, own in near if (i, j) not in done]
            if of is not None:
                new = [(i, j, own) for i, j, own in new if self._name(i) in of or self._name(j) in of]
            done.update((i, j) for i, j, _ in new)
            coarse = [(placed.gap(*self.levels_of(*pair)[:2]), pair) for pair in new]
            for gap, pair in sorted(coarse):
                if gap > TOUCH and gap >= best.distance:
                    break  # coarse solids enclose: nothing beyond can be nearer
                best = self._nearer(placed, *pair, best)
            if best.distance <= reach:
                break
        return best

    def depth(self, q: NDArray[np.float64]) -> float:
        """By how much (m, summed over the pairs) coarse solids undercut the margin at q: what a search descends on."""
        placed = self.solids.place(q)
        total = 0.0
        for i, j, own in placed.near(self.asked):
            a, b, *_ = self.levels_of(i, j, own)
            gap = placed.gap(a, b)
            if gap <= 0.0 and (a.mesh or b.mesh):
                gap = self._hulls(placed, i, j).distance
            total += max(0.0, self.margin_of(i, j, own) - gap)
        return total

    def near(self, q: NDArray[np.float64]) -> list[Near]:
        """The pairs of coarse solids that are near each other at q (nq,)."""
        placed = self.solids.place(q)
        found = []
        for i, j, own in placed.near(self.asked, NEAR):
            room = placed.distance(*self.levels_of(i, j, own)[:2]) - self.margin_of(i, j, own)
            normal = placed.normal
            if room <= NEAR and 0.5 < float(normal @ normal) < 2.0:  # surfaces that cross have none
                found.append(Near(room, normal, placed.points, (self.joint_of(i), self.joint_of(j))))
        return found

    @cached_property
    def _bare(self) -> Pairs:
        """The pairs without their margins."""
        return replace(self.asked, margins=np.zeros(len(self.asked.margins)), margin=0.0)

    def margin_of(self, i: int, j: int, own: int) -> float:
        """The distance at or below which a pair collides, m."""
        if own >= 0:
            return self._margins[own]
        return self.padding.between(self._name(i), self._name(j)) if self.padding.by else self.padding.margin

    @cached_property
    def _margins(self) -> list[float]:
        """The margins of the pairs that move, m."""
        margins: list[float] = self.asked.margins.tolist()
        return margins

    def joint_of(self, number: int) -> int:
        """Id of the joint that carries a body; 0 is the world."""
        moving = self.solids.moving
        return moving[number].joint if number < len(moving) else 0

    def _name(self, number: int) -> str:
        moving = self.solids.moving
        return (moving[number] if number < len(moving) else self.solids.standing[number - len(moving)]).link

    def levels_of(self, i: int, j: int, own: int) -> tuple[Level, Level, Level, Level]:
        """The levels of two bodies that are asked first, and those that have the last word."""
        a, b = self.solids.levels[i], self.solids.levels[j]
        c, d = a.last[b.flat], b.last[a.flat]
        if own >= 0 and self.direct[own]:
            return c, d, c, d
        return a.first[b.flat], b.first[a.flat], c, d

    def collide(self, placed: Placed, i: int, j: int, own: int) -> bool:
        """Whether a pair collides where the bodies are placed."""
        margin = self.margin_of(i, j, own)
        a, b, c, d = self.levels_of(i, j, own)
        if not self.exact or (a is c and b is d):
            return placed.overlap(a, b, margin)
        return placed.overlap(a, b, margin + ENCLOSED) and placed.overlap(c, d, margin)

    def _nearer(self, placed: Placed, i: int, j: int, own: int, best: Distance) -> Distance:
        """The distance of two bodies where it is less than the best, else that."""
        levels = self.levels_of(i, j, own)
        last = levels[2:] if self.exact else levels[:2]
        gap = placed.gap(*last)
        if gap > TOUCH and gap >= best.distance:
            return best
        solid = last[0].mesh is None and last[1].mesh is None
        if solid or gap > TOUCH:
            at = Distance(gap if gap > TOUCH else min(gap, 0.0), self._name(i), self._name(j), *placed.points)
        else:  # surfaces that cross have no depth; their hulls have
            at = self._hulls(placed, i, j)
            at = replace(at, distance=min(at.distance, 0.0))
        return min(best, at, key=lambda one: one.distance)

    def room(self, placed: Placed, i: int, j: int, own: int, needed: float) -> float:
        """A distance (m) beyond its margin that a pair has at least; all of it, where that is not more than needed.

        Of bodies that overlap it is below 0, and minus the depth to which the coarse solids do.
        """
        a, b, c, d = self.levels_of(i, j, own)
        taken = self.margin_of(i, j, own) + ENCLOSED
        room = INEXACT * placed.gap(a, b) - taken
        if room > needed or not self.exact or (a is c and b is d):
            return room
        fine = INEXACT * placed.gap(c, d) - taken
        return fine if fine > 0.0 else min(fine, room)

    def _hulls(self, placed: Placed, i: int, j: int) -> Distance:
        """Distance of the convex hulls of two bodies; minus their depth when they overlap."""
        distance = placed.distance(self.solids.levels[i].hull, self.solids.levels[j].hull)
        return Distance(distance, self._name(i), self._name(j), *placed.points)
