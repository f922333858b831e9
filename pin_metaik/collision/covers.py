"""Points around which bodies are: the corners of convex polyhedra that, widened by a ball, enclose them.

They tell in no time how far two bodies are apart along a direction (see ``parting``), which is never more than their
distance.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import coal
import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.body import Body
from pin_metaik.collision.checker import Checker
from pin_metaik.collision.extent import corners_of, is_flat

SIDES = 16  # of the prisms and pyramids around what is round

SOLID, HALF_SPACE, PLANE = 0, 1, 2


class Cover(NamedTuple):
    """What encloses one body.

    Attributes:
        points: (k, 3) corners, in the body's frame, m; of a half-space or plane one point of its surface.
        radius: Of the ball that widens them, m.
        normal: (3,) of a half-space, out of it, or of a plane; else zeros.
        kind: ``SOLID``, ``HALF_SPACE`` or ``PLANE``.
    """

    points: NDArray[np.float64]
    radius: float = 0.0
    normal: NDArray[np.float64] = np.zeros(3)  # nobody writes to it
    kind: int = SOLID


class Covers(NamedTuple):
    """The covers of all bodies of a world, one behind the other; in their frames, or, if they stand, in the world.

    Attributes:
        points: (3, P) m.
        starts: (b + 1,) where the points of each begin.
        radii: (b,) m.
        normals: (b, 3).
        kinds: (b,).
    """

    points: NDArray[np.float64]
    starts: NDArray[np.int64]
    radii: NDArray[np.float64]
    normals: NDArray[np.float64]
    kinds: NDArray[np.int64]

    @staticmethod
    def of(checker: Checker) -> Covers:
        """The covers of the bodies of a checker, each around what has the last word there."""
        covers = [_cover(body, checker.exact) for body in checker.solids.moving]
        for body in checker.solids.standing:
            cover, turn = _cover(body, checker.exact), body.placement.rotation
            points = cover.points @ turn.T + body.placement.translation
            covers.append(cover._replace(points=points, normal=turn @ cover.normal))
        return Covers(
            np.ascontiguousarray(np.concatenate([cover.points for cover in covers]).T),
            np.cumsum([0, *(len(cover.points) for cover in covers)]),
            np.array([cover.radius for cover in covers]),
            np.array([cover.normal for cover in covers]),
            np.array([cover.kind for cover in covers], dtype=np.int64),
        )


def _cover(body: Body, exact: bool) -> Cover:
    solid = body.solid
    if exact or isinstance(solid.coarse, coal.BVHModelBase):
        return _around(solid.hull)
    cover = _around(solid.coarse)
    return cover._replace(points=cover.points @ solid.offset.rotation.T + solid.offset.translation)


def _around(geometry: Any) -> Cover:
    """The cover of a geometry of coal, in its frame."""
    if is_flat(geometry):
        normal = np.array(geometry.n)
        kind = HALF_SPACE if isinstance(geometry, coal.Halfspace) else PLANE
        return Cover(float(geometry.d) * normal[None], 0.0, normal, kind)
    match geometry:
        case coal.Sphere():
            return Cover(np.zeros((1, 3)), geometry.radius)
        case coal.Capsule():
            return Cover(np.array([[0.0, 0.0, -geometry.halfLength], [0.0, 0.0, geometry.halfLength]]), geometry.radius)
        case coal.Cylinder():
            ring, up = _ring(geometry.radius), np.array([0.0, 0.0, geometry.halfLength])
            return Cover(np.vstack([ring - up, ring + up]))
        case coal.Cone():
            tip = np.array([[0.0, 0.0, geometry.halfLength]])
            return Cover(np.vstack([_ring(geometry.radius) - tip, tip]))
        case _:
            return Cover(corners_of(geometry))


def _ring(radius: float) -> NDArray[np.float64]:
    """Corners (SIDES, 3) of a polygon around a circle about z, m."""
    turns = 2.0 * math.pi * np.arange(SIDES) / SIDES
    return radius / math.cos(math.pi / SIDES) * np.stack([np.cos(turns), np.sin(turns), np.zeros(SIDES)], axis=1)
