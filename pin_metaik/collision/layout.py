"""Laying out the checks of a world: which shapes of which bodies, at which margin, and in which order.

Most pairs are checked with their coarse solids, then with their originals. Some are treated apart. Where the coarse
solids of two bodies mostly overlap while the originals do not, they decide nothing, and the first layer has the
originals of that pair, too. Two links that are mostly nearer than the margin are built so, and only kept from touching.
A half-space meets a mesh where it meets its hull, which is sooner found out. And where an obstacle is so small that it
could hide inside the surface of a link's mesh, the link counts as its convex hull.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any, TypeAlias

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.checker import Checker, hull_distance
from pin_metaik.collision.contact import Contact
from pin_metaik.collision.layer import Layer
from pin_metaik.collision.touch import SEED, random_configurations

FLAT = coal.Halfspace, coal.Plane
ROUNDING = 1e-6  # m added to the margin of coarse solids: what coal's distances may be off by
NEAR = 0.05  # m beyond the margin: pairs farther apart do not concern a step
SAMPLES = 50
MOSTLY = 0.5  # of the samples


Allowed: TypeAlias = Callable[[Body, Body], bool]


def lay_out(model: pin.Model, bodies: tuple[Body, ...], allowed: Allowed, margin: float, exact: bool) -> Checker:
    """The checks of all pairs of bodies that are not ``allowed`` to touch."""
    moving = [(i, j) for j in range(len(bodies)) for i in range(j) if bodies[i].joint != bodies[j].joint]
    pairs = [(i, j) for i, j in moving if not allowed(bodies[i], bodies[j])]
    n = len(bodies)
    Q = random_configurations(model, np.random.default_rng(SEED), SAMPLES)
    hulls = [(body, body.solid.hull, body.placement) for body in bodies]
    margins = np.full(len(pairs), margin)
    if margin > 0.0:
        near = _hits(Layer.of(model, hulls, pairs, margins), Q).mean(axis=0) >= MOSTLY
        margins[near & [bodies[i].part and bodies[j].part for i, j in pairs]] = 0.0

    fine_shapes = [(body, body.solid.original, body.placement) for body in bodies] + hulls
    fine_pairs = [(_facing(i, j, bodies), _facing(j, i, bodies)) for i, j in pairs]
    coarse_shapes = [(body, body.solid.coarse, body.placement * body.solid.offset) for body in bodies]
    share = _hits(Layer.of(model, coarse_shapes, pairs, margins), Q).mean(axis=0)
    vain = share - _shares(Layer.of(model, fine_shapes, fine_pairs, margins), Q, np.flatnonzero(share >= MOSTLY))

    order = np.argsort(-share, kind="stable").tolist()
    first = []
    for k in order:
        i, j = fine_pairs[k]
        larger = any(f >= n and bodies[b].solid.coarse is bodies[b].solid.original for f, b in ((i, i - n), (j, j - n)))
        first.append((n + i, n + j) if larger or vain[k] >= MOSTLY else pairs[k])
    if any(i >= n for i, _ in first):
        coarse_shapes += fine_shapes
    margins = margins[order]
    coarse = Layer.of(model, coarse_shapes, first, margins + ROUNDING)
    return Checker(
        bodies,
        tuple(pairs[k] for k in order),
        coarse,
        Layer.of(model, fine_shapes, [fine_pairs[k] for k in order], margins),
        replace(coarse, margins=margins + NEAR),
        _fixed(bodies, allowed),
        exact,
    )


def moved(checker: Checker, number: int, placement: pin.SE3, allowed: Allowed) -> Checker:
    """The same checks with an obstacle, body ``number``, put somewhere else; the old checks are no longer good."""
    n, bodies = len(checker.bodies), list(checker.bodies)
    bodies[number] = replace(bodies[number], placement=placement)
    for layer in (checker.coarse, checker.fine):
        for piece in range(number, layer.geometry.ngeoms, n):  # the n coarse solids, originals and hulls, as they come
            layer.geometry.geometryObjects[piece].placement = placement
    return replace(checker, bodies=tuple(bodies), fixed=_fixed(tuple(bodies), allowed))


def _hits(layer: Layer, Q: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which pairs collide (k, p) at configurations Q (k, nq)."""
    hits = np.zeros((len(Q), len(layer.margins)), dtype=bool)
    for k, q in enumerate(Q):
        hits[k, layer.colliding(q)] = True
    return hits


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


def _facing(i: int, j: int, bodies: tuple[Body, ...]) -> int:
    """Number of the shape of body i that body j is checked against: its original, or its hull, ``len(bodies)`` on."""
    return i if _shape_facing(bodies[i], bodies[j]) is bodies[i].solid.original else len(bodies) + i


def _shape_facing(a: Body, b: Body) -> Any:
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


def _fixed(bodies: tuple[Body, ...], allowed: Allowed) -> tuple[Contact, ...]:
    """Overlaps of the robot's base with what stands in the world; they need no margin, as neither can come nearer."""
    contacts = {}
    standing = [body for body in bodies if body.joint == 0]
    for a, b in product((body for body in standing if body.part), [body for body in standing if not body.part]):
        if not allowed(a, b):
            at = hull_distance(a, b, a.placement, b.placement)
            if at.distance < 0.0 and _overlap(a, b):
                contacts[a.link, b.link] = Contact(a.link, b.link, -at.distance)
    return tuple(contacts.values())


def _overlap(a: Body, b: Body) -> bool:
    request, result = coal.CollisionRequest(), coal.CollisionResult()
    poses = [coal.Transform3s(body.placement.rotation, body.placement.translation) for body in (a, b)]
    coal.collide(_shape_facing(a, b), poses[0], _shape_facing(b, a), poses[1], request, result)
    return bool(result.isCollision())
