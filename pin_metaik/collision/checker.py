"""Checks in two layers: coarse solids first; where they touch, the geometry as it is has the last word.

Free of the coarse solids is free: they enclose. So the answers are those of the original geometry at the price, nearly
always, of the coarse one. Some pairs are treated apart. Where the coarse solids of two bodies mostly overlap while the
originals do not, they decide nothing, and the first layer has the originals of that pair, too. A half-space meets a
mesh where it meets its hull, which is sooner found out. And where an obstacle is so small that it could hide inside the
surface of a link's mesh, the link counts as its convex hull.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container
from dataclasses import dataclass, replace
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.contact import Contact, Distance, Near
from pin_metaik.collision.layer import Layer
from pin_metaik.collision.touch import SEED, random_configurations

FLAT = coal.Halfspace, coal.Plane
ROUNDING = 1e-6  # m added to the margin of coarse solids: what coal's distances may be off by
NEAR = 0.05  # m beyond the margin: pairs farther apart do not concern a step
SAMPLES = 50
MOSTLY = 0.5  # of the samples: coarse solids that overlap so much more often than the originals decide nothing


@dataclass(frozen=True, eq=False)
class Checker:
    """The pairs of bodies that move against each other, and their two layers.

    Attributes:
        bodies: All bodies.
        pairs: Numbers of the two bodies of each pair; those that collide most often come first.
        margin: Distance at or below which a pair collides, m.
        coarse: The first layer ...
        fine: ... and the second, with the same pairs.
        wide: The first again, with ``NEAR`` more margin.
        fixed: Contacts of what cannot move: then every configuration collides.
        exact: Whether the second layer is asked.
    """

    bodies: tuple[Body, ...]
    pairs: tuple[tuple[int, int], ...]
    margin: float
    coarse: Layer
    fine: Layer
    wide: Layer
    fixed: tuple[Contact, ...]
    exact: bool

    @staticmethod
    def of(
        model: pin.Model, bodies: tuple[Body, ...], allowed: Callable[[Body, Body], bool], margin: float, exact: bool
    ) -> Checker:
        """Lay out the checks of all pairs that are not ``allowed`` to touch."""
        every = [(i, j) for j in range(len(bodies)) for i in range(j) if not allowed(bodies[i], bodies[j])]
        pairs = [(i, j) for i, j in every if bodies[i].joint != bodies[j].joint]
        margins = np.full(len(pairs), margin)
        fine_shapes, fine_pairs = _fine(bodies, pairs)
        coarse_shapes = [(body, body.solid.coarse, body.placement * body.solid.offset) for body in bodies]
        trial = Layer.of(model, coarse_shapes, pairs, margins)
        Q = random_configurations(model, np.random.default_rng(SEED), SAMPLES)
        hits = np.zeros((SAMPLES, len(pairs)), dtype=bool)
        for k, q in enumerate(Q):
            hits[k, trial.colliding(q)] = True
        share = hits.mean(axis=0)
        last = Layer.of(model, fine_shapes, fine_pairs, margins)
        vain = share - _shares(last, Q, np.flatnonzero(share >= MOSTLY))
        order = np.argsort(-share, kind="stable").tolist()
        first, n = [], len(bodies)
        for k in order:
            i, j = fine_pairs[k]
            first.append((n + i, n + j) if vain[k] >= MOSTLY else pairs[k])
        if any(i >= n for i, _ in first):
            coarse_shapes += fine_shapes
        coarse = Layer.of(model, coarse_shapes, first, margins + ROUNDING)
        return Checker(
            bodies,
            tuple(pairs[k] for k in order),
            margin,
            coarse,
            Layer.of(model, fine_shapes, [fine_pairs[k] for k in order], margins),
            replace(coarse, margins=margins + NEAR),
            _fixed(bodies, every),
            exact,
        )

    def collides(self, q: NDArray[np.float64]) -> bool:
        """Whether anything collides at q (nq,)."""
        if self.fixed:
            return True
        if not self.coarse.collides(q):
            return False
        return not self.exact or self._confirmed(q, first=True) != []

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
        found = []
        for k in self._confirmed(q) if self.exact else self.coarse.colliding(q):
            a, b = (self.bodies[i].joint for i in self.pairs[k])
            if joints is None or (a in joints and b in joints):
                at = self._hulls(q, k)
                found.append((Contact(at.first, at.second, max(0.0, self.margin - at.distance)), (a, b)))
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
        return sum(max(0.0, self.margin - self.coarse.distance(k)) for k in self.coarse.colliding(q))

    def near(self, q: NDArray[np.float64]) -> list[Near]:
        """The pairs of coarse solids less than ``NEAR`` beyond the margin apart at q (nq,)."""
        found = []
        for k in self.wide.colliding(q):
            distance, result = self.wide.distance(k), self.wide.result(k)
            normal = np.array(result.normal)
            if 0.5 < float(normal @ normal) < 2.0:  # surfaces that cross have none
                joints = (self.bodies[self.pairs[k][0]].joint, self.bodies[self.pairs[k][1]].joint)
                points = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
                found.append(Near(distance, normal, points, joints))
        return found

    def _confirmed(self, q: NDArray[np.float64], first: bool = False) -> list[int]:
        """Numbers of the pairs that collide in both layers at q (nq,); with ``first`` at most one."""
        suspects = self.coarse.colliding(q)
        found: list[int] = []
        if suspects:
            self.fine.place(q)
        for k in suspects:
            if self.fine.touches(k):
                found.append(k)
                if first:
                    break
        return found

    def _hulls(self, q: NDArray[np.float64], pair: int) -> Distance:
        """Distance of the convex hulls of a pair at q (nq,)."""
        data, _ = self.fine.scratch
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


def _fixed(bodies: tuple[Body, ...], pairs: list[tuple[int, int]]) -> tuple[Contact, ...]:
    """Overlaps of the robot's base with what stands in the world; they need no margin, as neither can come nearer."""
    contacts = {}
    for a, b in ((bodies[i], bodies[j]) for i, j in pairs):
        if a.joint == b.joint == 0 and a.part != b.part:
            at = hull_distance(a, b, a.placement, b.placement)
            if at.distance < 0.0 and _overlap(a, b):
                contacts[a.link, b.link] = Contact(a.link, b.link, -at.distance)
    return tuple(contacts.values())


def _shares(layer: Layer, Q: NDArray[np.float64], pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Of the configurations Q (k, nq) in which each of some pairs collides; 1 for the other pairs."""
    share = np.ones(len(layer.margins))
    if len(pairs):
        hits = np.zeros((len(Q), len(pairs)), dtype=bool)
        for k, q in enumerate(Q):
            layer.place(q)
            hits[k] = [layer.touches(int(pair)) for pair in pairs]
        share[pairs] = hits.mean(axis=0)
    return share


def _overlap(a: Body, b: Body) -> bool:
    request, result = coal.CollisionRequest(), coal.CollisionResult()
    poses = [coal.Transform3s(body.placement.rotation, body.placement.translation) for body in (a, b)]
    return bool(coal.collide(_facing(a, b), poses[0], _facing(b, a), poses[1], request, result))


def _fine(
    bodies: tuple[Body, ...], pairs: list[tuple[int, int]]
) -> tuple[list[tuple[Body, Any, pin.SE3]], list[tuple[int, int]]]:
    """The shapes of the second layer, originals then hulls, and which of them each pair checks."""
    n = len(bodies)
    shapes = [(body, body.solid.original, body.placement) for body in bodies]
    shapes += [(body, body.solid.hull, body.placement) for body in bodies]

    def chosen(i: int, j: int) -> int:
        return i if _facing(bodies[i], bodies[j]) is bodies[i].solid.original else n + i

    return shapes, [(chosen(i, j), chosen(j, i)) for i, j in pairs]


def _facing(a: Body, b: Body) -> Any:
    """The shape of a that b is checked against: its hull where that is the same, or b could hide in its mesh."""
    flat = isinstance(b.solid.original, FLAT)
    hides = a.part and not b.part and isinstance(a.solid.original, coal.BVHModelBase) and _size(b) < _size(a)
    return a.solid.hull if flat or hides else a.solid.original


def _size(body: Body) -> float:
    """Diagonal of the box around a body, m; infinite for planes."""
    hull = body.solid.hull
    if isinstance(hull, FLAT):
        return math.inf
    hull.computeLocalAABB()
    return math.dist(hull.aabb_local.max_, hull.aabb_local.min_)
