"""The border of a region of polygons as flat arrays, as loops over all its vertices want it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from pin_metaik.arrays import Array

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Border:
    """The border of a region, ring after ring; the region is on the left of every edge.

    Attributes:
        vertices: (n, 2).
        before: The vertex before along the ring (n,).
        after: The vertex after along the ring (n,); edge k goes from vertex k to ``after[k]``.
        slack: How far from a line a point still counts as on it.
    """

    vertices: Array
    before: Indices
    after: Indices
    slack: float

    @staticmethod
    def of(region: shapely.Geometry, slack: float) -> Border:
        """The border of polygons."""
        outlines = list(rings(region))
        first = np.cumsum([0, *map(len, outlines)])
        before = [start + (np.arange(len(ring)) - 1) % len(ring) for start, ring in zip(first, outlines, strict=False)]
        vertices = np.ascontiguousarray(np.concatenate([np.empty((0, 2)), *outlines]))
        back = np.concatenate([np.empty(0, dtype=np.int64), *before])
        on = np.empty_like(back)
        on[back] = np.arange(len(back))
        return Border(vertices, back, on, slack)

    def weeded(self) -> Border:
        """The border without the vertices that are no further than the slack from the line between their neighbours.

        Loops take such a vertex for one amid a straight edge. Where several stand so close together that each of them
        seems to be one (a corner rounded by a hair), a corner must be left: so they go one by one, the flattest first,
        and their neighbours are looked at again.
        """
        before, after = self.before.copy(), self.after.copy()
        left = np.arange(len(before))
        while True:
            u, v = (self.vertices[left] - self.vertices[before[left]], self.vertices[after[left]] - self.vertices[left])
            off = np.full(len(before), np.inf)
            off[left] = _off(u, v)
            flattest = (off[left] < off[before[left]]) & (off[left] <= off[after[left]]) & (off[left] <= self.slack)
            gone = left[flattest]
            if not len(gone):
                break
            after[before[gone]], before[after[gone]] = after[gone], before[gone]
            left = left[~flattest]
        number = np.cumsum(np.isin(np.arange(len(before)), left)) - 1
        return Border(self.vertices[left], number[before[left]], number[after[left]], self.slack)

    @property
    def arrays(self) -> tuple[Array, Indices, Indices]:
        """What every kernel takes first."""
        return self.vertices, self.before, self.after

    @cached_property
    def edges(self) -> Array:
        """Vectors along the edges (n, 2)."""
        return np.asarray(self.vertices[self.after] - self.vertices)

    @cached_property
    def bends(self) -> NDArray[np.bool_]:
        """Whether a shortest path can bend at a vertex (n,): the border turns right, by more than rounding."""
        u, v = self.edges[self.before], self.edges
        x, y = (u + v).T
        length = np.hypot(x, y)
        right: NDArray[np.bool_] = np.where(
            length > 0, x * u[:, 1] - y * u[:, 0] > self.slack * length, u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
        )
        return right

    @cached_property
    def corners(self) -> Indices:
        """Indices (c,) of the vertices a shortest path can bend at."""
        return np.flatnonzero(self.bends)


def _off(u: Array, v: Array) -> Array:
    """How far (n,) the point between vectors u and v, (n, 2) both, is from the line from their begin to their end."""
    across = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    length = np.hypot(*(u + v).T)
    return np.asarray(np.where(length > 0, across / np.where(length > 0, length, 1.0), np.hypot(*u.T)))


def rings(region: shapely.Geometry) -> Iterator[Array]:
    """The rings of a polygon or several, each (n, 2) without the repeated vertex and with the inside on its left."""
    for polygon in shapely.get_parts(region):
        for ring, left in ((polygon.exterior, True), *((hole, False) for hole in polygon.interiors)):
            vertices = shapely.get_coordinates(ring)[:-1]
            yield vertices if ring.is_ccw == left else vertices[::-1]
