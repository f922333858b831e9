"""Sensor data as solids: points with a radius, occupied cells, and height fields.

Each is a closed surface of triangles, so that worlds check it as they check any mesh: what is inside collides, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.mesh import FARTHEST, surface
from pin_metaik.collision.numbers import real
from pin_metaik.errors import InvalidGeometry

MOST_POINTS = 50_000  # with a radius each; 20 triangles a point
MOST_CELLS = 1_000_000  # of an octree from the origin along an axis, so that all of its box can be numbered; of a field
GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Balls around points, each replaced by an icosahedron around it, whose corners are at 1.25 times the radius.

    Attributes:
        points: (k, 3) m; at most 50,000, more are for an ``Octree``.
        radius: Radius of the balls, m.
    """

    points: NDArray[np.float64]
    radius: float

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless there are points, all finite, and a radius above 0."""
        object.__setattr__(self, "points", _points("a point cloud", self.points))
        object.__setattr__(self, "radius", _length("radius of a point cloud", self.radius))
        if len(self.points) > MOST_POINTS:
            raise InvalidGeometry(
                f"a point cloud has at most {MOST_POINTS:,} points, got {len(self.points):,}: use an Octree"
            )

    def geometry(self) -> Any:
        """The shape as coal has it."""
        corners, faces = _icosahedron()
        vertices = self.points[:, None] + self.radius * corners
        triangles = 12 * np.arange(len(self.points))[:, None, None] + faces
        return surface(vertices.reshape(-1, 3), triangles.reshape(-1, 3))


@dataclass(frozen=True, eq=False)
class Octree:
    """The cells of a regular grid that hold a point, as OctoMap has them at its resolution; solid.

    Attributes:
        points: (k, 3) m, such as a depth camera's, or the centres of occupied cells.
        resolution: Edge of a cell, m; cells begin at multiples of it.
    """

    points: NDArray[np.float64]
    resolution: float

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless there are points, all finite, and a resolution that their box can hold."""
        object.__setattr__(self, "points", _points("an octree", self.points))
        object.__setattr__(self, "resolution", _length("resolution of an octree", self.resolution))
        if np.abs(self.points).max() / self.resolution > MOST_CELLS:
            raise InvalidGeometry(
                f"an octree has at most {MOST_CELLS:,} cells along an edge: the resolution is too fine"
            )

    def cells(self) -> NDArray[np.int64]:
        """Numbers (n, 3) of the occupied cells: cell i covers [i, i + 1] resolutions along each axis."""
        cells: NDArray[np.int64] = np.unique(np.floor(self.points / self.resolution).astype(np.int64), axis=0)
        return cells

    def geometry(self) -> Any:
        """The shape as coal has it: those sides of the cells that no other cell covers."""
        cells = self.cells() + 1
        low = cells.min(axis=0) - 1
        shape = cells.max(axis=0) - low + 3
        keys = _keys(cells - low, shape)
        sides = []
        for axis in range(3):
            for side in (0, 1):
                beside = cells.copy()
                beside[:, axis] += 2 * side - 1
                bare = cells[~np.isin(_keys(beside - low, shape), keys)]
                sides.append(_sides(bare, axis, side))
        corners, triangles = np.unique(np.concatenate(sides).reshape(-1, 3), axis=0, return_inverse=True)
        return surface(self.resolution * (corners - 1.0).astype(float), triangles.reshape(-1, 3))


@dataclass(frozen=True, eq=False)
class HeightField:
    """Ground with heights on a regular grid, interpolated by triangles; solid down to its base.

    Attributes:
        size: Extent along x and y, m; the grid is centred at the origin.
        heights: (ny, nx) m, at least 2 x 2: a row for each y, from the least; a column for each x, from the least.
        base: Height of its flat bottom, m, below all heights.
    """

    size: tuple[float, float]
    heights: NDArray[np.float64]
    base: float
    _shape: tuple[int, int] = field(init=False, repr=False, default=(0, 0))

    def __post_init__(self) -> None:
        """Raises InvalidGeometry unless the heights are finite, two each way at least, and above the base."""
        given = self.size.ravel() if isinstance(self.size, np.ndarray) else self.size
        size = list(given) if isinstance(given, list | tuple | np.ndarray) else []
        if len(size) != 2:
            raise InvalidGeometry(f"the size of a height field is two lengths in m, got {self.size!r}")
        object.__setattr__(self, "size", tuple(_length("size of a height field", edge) for edge in size))
        heights, base = _array(self.heights), real(self.base)
        if heights.ndim != 2 or min(heights.shape) < 2 or not np.isfinite(heights).all():
            raise InvalidGeometry("the heights of a height field are (ny, nx) finite numbers, 2 x 2 at least")
        if max(np.abs(heights).max(), abs(base)) > FARTHEST or heights.size > MOST_CELLS:
            raise InvalidGeometry(f"a height field has heights to {FARTHEST:g} m, and at most {MOST_CELLS:,} of them")
        if not base < heights.min():
            raise InvalidGeometry(f"the base of a height field is below its heights, got {self.base!r}")
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "base", base)
        object.__setattr__(self, "_shape", heights.shape)

    def geometry(self) -> Any:
        """The shape as coal has it."""
        rows, columns = self._shape
        x, y = np.linspace(-0.5, 0.5, columns) * self.size[0], np.linspace(-0.5, 0.5, rows) * self.size[1]
        flat = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        top = np.column_stack([flat, self.heights.ravel()])
        bottom = np.column_stack([flat, np.full(len(flat), self.base)])
        number = np.arange(len(flat)).reshape(rows, columns)
        a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
        up = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
        rim = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
        ahead, under = np.roll(rim, -1), len(flat)
        wall = np.concatenate(
            [np.stack([rim + under, ahead + under, ahead], -1), np.stack([rim + under, ahead, rim], -1)]
        )
        return surface(np.concatenate([top, bottom]), np.concatenate([up, up[:, ::-1] + under, wall]))


def _icosahedron() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Corners (12, 3) and triangles (20, 3) of the icosahedron around the unit ball."""
    from itertools import combinations

    corners = np.array([p for s in (-1.0, 1.0) for t in (-GOLDEN, GOLDEN) for p in ((0, s, t), (s, t, 0), (t, 0, s))])
    near = np.linalg.norm(corners[:, None] - corners, axis=2) < 2.1  # edges have length 2
    faces = [f for f in combinations(range(12), 3) if near[f[0], f[1]] and near[f[1], f[2]] and near[f[0], f[2]]]
    outward = [f if np.linalg.det(corners[list(f)]) > 0.0 else f[::-1] for f in faces]
    inner = float(np.linalg.norm(corners[list(faces[0])].mean(axis=0)))
    return corners / inner, np.array(outward)


def _sides(cells: NDArray[np.int64], axis: int, side: int) -> NDArray[np.int64]:
    """Two triangles (2 n, 3, 3) for the low or high side of each cell (n, 3) along an axis, as corners of the grid."""
    u, v = np.eye(3, dtype=np.int64)[(axis + 1) % 3], np.eye(3, dtype=np.int64)[(axis + 2) % 3]
    first = cells + side * np.eye(3, dtype=np.int64)[axis]
    corners = [first, first + u, first + u + v, first + v] if side else [first, first + v, first + u + v, first + u]
    a, b, c, d = corners
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _keys(cells: NDArray[np.int64], shape: NDArray[np.int64]) -> NDArray[np.int64]:
    """One number (n,) for each cell (n, 3) of a box."""
    keys: NDArray[np.int64] = (cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2]
    return keys


def _array(values: object) -> NDArray[np.float64]:
    """Numbers as floats; empty, where that is not what was given."""
    try:
        array = np.array(values)
    except ValueError:
        array = np.empty(0)
    return array.astype(float) if array.dtype.kind in "iuf" else np.empty(0)


def _points(what: str, values: object) -> NDArray[np.float64]:
    points = _array(values)
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        raise InvalidGeometry(f"{what} has points (k, 3) in m, one at least")
    if not (np.abs(points) <= FARTHEST).all():
        raise InvalidGeometry(f"{what} has points that are not finite, or more than {FARTHEST:g} m from its origin")
    return points


def _length(what: str, value: object) -> float:
    number = real(value)
    if not 0.0 < number <= FARTHEST:
        raise InvalidGeometry(f"the {what} is a length above 0 in m, got {value!r}")
    return number
