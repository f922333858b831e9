"""A layer: bodies at one level of detail, and the pairs of them that are checked, as Pinocchio and coal take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from threading import local
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body


class Scratch(NamedTuple):
    """What Pinocchio and coal write into; their results as lists, which are read in a twentieth of a vector's time."""

    data: pin.Data
    shapes: pin.GeometryData
    collisions: list[Any]
    distances: list[Any]


@dataclass(frozen=True, eq=False)
class Layer:
    """Geometry and pairs, with Pinocchio's scratch for each thread.

    Attributes:
        model: The robot's model.
        geometry: Pinocchio's geometry; its collision pairs are the pairs.
        margins: (p,) the distance of each pair at or below which it collides, m.
    """

    model: pin.Model
    geometry: pin.GeometryModel
    margins: NDArray[np.float64]
    _local: local = field(init=False, default_factory=local, repr=False)

    @staticmethod
    def of(
        model: pin.Model,
        shapes: Sequence[tuple[Body, Any, pin.SE3]],
        pairs: Sequence[tuple[int, int]],
        margins: NDArray[np.float64] | None = None,
    ) -> Layer:
        """A layer of shapes (body, geometry of coal, placement in the joint's frame) and pairs of their numbers."""
        geometry = pin.GeometryModel()
        for i, (body, shape, placement) in enumerate(shapes):
            geometry.addGeometryObject(pin.GeometryObject(f"{i}", body.joint, placement, shape))
        for i, j in pairs:
            geometry.addCollisionPair(pin.CollisionPair(i, j))
        return Layer(model, geometry, np.zeros(len(pairs)) if margins is None else margins)

    @property
    def scratch(self) -> Scratch:
        """Room for results, one a thread, with the margins set."""
        try:
            scratch: Scratch = self._local.scratch
        except AttributeError:
            shapes = self.geometry.createData()
            for request, margin in zip(shapes.collisionRequests, self.margins.tolist(), strict=True):
                request.security_margin = margin
            results = list(shapes.collisionResults), list(shapes.distanceResults)
            scratch = self._local.scratch = Scratch(self.model.createData(), shapes, *results)
        return scratch

    def place(self, q: NDArray[np.float64]) -> None:
        """Put every shape where it is at q (nq,): what ``touches``, ``distance`` and ``contact`` look at."""
        data, shapes, *_ = self.scratch
        pin.updateGeometryPlacements(self.model, data, self.geometry, shapes, q)

    def collides(self, q: NDArray[np.float64]) -> bool:
        """Whether any pair collides at q (nq,); stops at the first."""
        data, shapes, *_ = self.scratch
        return bool(pin.computeCollisions(self.model, data, self.geometry, shapes, q, True))

    def colliding(self, q: NDArray[np.float64]) -> list[int]:
        """Numbers of the pairs that collide at q (nq,)."""
        data, shapes, collisions, _ = self.scratch
        pin.computeCollisions(self.model, data, self.geometry, shapes, q, False)
        return [k for k, result in enumerate(collisions) if result.isCollision()]

    def touches(self, pair: int) -> bool:
        """Whether a pair collides where the shapes were placed."""
        return bool(pin.computeCollision(self.geometry, self.scratch.shapes, pair))

    def distance(self, pair: int) -> float:
        """Distance of a pair where the shapes were placed, m; of solids that overlap minus their depth."""
        return float(pin.computeDistance(self.geometry, self.scratch.shapes, pair).min_distance)

    def distances(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distances (p,) of all pairs at q (nq,), m."""
        data, shapes, _, distances = self.scratch
        pin.computeDistances(self.model, data, self.geometry, shapes, q)
        return np.array([result.min_distance for result in distances])

    def result(self, pair: int) -> Any:
        """What coal found when the distance of a pair was last asked for."""
        return self.scratch.distances[pair]
