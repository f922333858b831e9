"""Checks in two layers: coarse solids first; where they touch, the geometry as it is has the last word.

Free of the coarse solids is free: they enclose. So the answers are those of the original geometry at the price, nearly
always, of the coarse one.
"""

from __future__ import annotations

import math
from collections.abc import Container
from dataclasses import dataclass
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.contact import Contact, Distance, Near
from pin_metaik.collision.layer import Layer


@dataclass(frozen=True, eq=False)
class Checker:
    """The pairs of bodies that move against each other, and their two layers.

    Attributes:
        bodies: All bodies.
        pairs: Numbers of the two bodies of each pair; those that collide most often come first.
        coarse: The first layer ...
        fine: ... and the second, with the same pairs.
        wide: The first again, with more margin: what is near.
        fixed: Contacts of what cannot move: then every configuration collides.
        exact: Whether the second layer is asked.
    """

    bodies: tuple[Body, ...]
    pairs: tuple[tuple[int, int], ...]
    coarse: Layer
    fine: Layer
    wide: Layer
    fixed: tuple[Contact, ...]
    exact: bool

    def collides(self, q: NDArray[np.float64]) -> bool:
        """Whether anything collides at q (nq,)."""
        if self.fixed:
            return True
        # The second layer as a whole: to read from Python which pairs of the first collide takes longer.
        return self.coarse.collides(q) and (not self.exact or self.fine.collides(q))

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
        suspects = [k for k in self.coarse.colliding(q) if joints is None or all(j in joints for j in self._joints(k))]
        found = []
        for k in self._confirmed(q, suspects) if self.exact else suspects:
            at = self._hulls(q, k)
            depth = max(0.0, float(self.fine.margins[k]) - at.distance)
            found.append((Contact(at.first, at.second, depth), self._joints(k)))
        return found

    def nearest(self, q: NDArray[np.float64]) -> Distance:
        """The two bodies nearest to each other at q (nq,), of all that move against each other."""
        distances = self.coarse.distances(q)
        if not self.exact:
            return self._named(int(distances.argmin()), self.coarse.result(int(distances.argmin())))
        best = Distance(math.inf, "", "", np.full(3, np.nan), np.full(3, np.nan))
        self.fine.place(q)
        for k in np.argsort(distances, kind="stable").tolist():
            if distances[k] >= best.distance:
                break  # coarse solids enclose: nothing beyond can be nearer
            self.fine.distance(k)
            at = self._named(k, self.fine.result(k))
            if at.distance <= 0.0 or self.fine.touches(k):  # surfaces that cross have no depth; their hulls have
                at = self._hulls(q, k)
            best = min(best, at, key=lambda one: one.distance)
        return best

    def depth(self, q: NDArray[np.float64]) -> float:
        """By how much (m, summed over the pairs) coarse solids undercut the margin at q: what a search descends on."""
        margins = self.fine.margins
        return sum(max(0.0, float(margins[k]) - self.coarse.distance(k)) for k in self.coarse.colliding(q))

    def near(self, q: NDArray[np.float64]) -> list[Near]:
        """The pairs of coarse solids that are near each other at q (nq,)."""
        found = []
        for k in self.wide.colliding(q):
            distance, result = self.wide.distance(k), self.wide.result(k)
            normal = np.array(result.normal)
            if 0.5 < float(normal @ normal) < 2.0:  # surfaces that cross have none
                points = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
                found.append(Near(distance - float(self.fine.margins[k]), normal, points, self._joints(k)))
        return found

    def _confirmed(self, q: NDArray[np.float64], suspects: list[int]) -> list[int]:
        """Those of the suspected pairs that collide in the second layer at q (nq,)."""
        if suspects:
            self.fine.place(q)
        return [k for k in suspects if self.fine.touches(k)]

    def _joints(self, pair: int) -> tuple[int, int]:
        i, j = self.pairs[pair]
        return self.bodies[i].joint, self.bodies[j].joint

    def _hulls(self, q: NDArray[np.float64], pair: int) -> Distance:
        """Distance of the convex hulls of a pair at q (nq,)."""
        data = self.fine.scratch.data
        pin.forwardKinematics(self.fine.model, data, q)
        bodies = [self.bodies[i] for i in self.pairs[pair]]
        return hull_distance(*bodies, *(data.oMi[body.joint] * body.placement for body in bodies))

    def _named(self, pair: int, result: Any) -> Distance:
        first, second = (self.bodies[i].link for i in self.pairs[pair])
        points = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
        return Distance(float(result.min_distance), first, second, *points)


def hull_distance(a: Body, b: Body, M_a: pin.SE3, M_b: pin.SE3) -> Distance:
    """Distance of the convex hulls of two bodies placed in the world; minus their depth when they overlap."""
    result = coal.DistanceResult()
    poses = [coal.Transform3s(M.rotation, M.translation) for M in (M_a, M_b)]
    distance = coal.distance(a.solid.hull, poses[0], b.solid.hull, poses[1], coal.DistanceRequest(), result)
    points = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
    return Distance(float(distance), a.link, b.link, *points)
