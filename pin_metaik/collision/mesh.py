"""Triangle meshes: read from a file or given as arrays, and refused when they are not the surface of a solid."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import coal
import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import InvalidGeometry

FLAT = 1e-9  # thickness of a set of points, in its lengths, below which it has none
GROWTH = 1e-4  # of their distance from the centre that points may move outward, so as not to lie in one plane
HUGE = 20.0  # m; a mesh larger than this was probably drawn in millimetres


class MeshSize(UserWarning):
    """A mesh so large that its file is probably in millimetres."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface of triangles, or the convex hull of points.

    Attributes:
        vertices: (k, 3) m.
        triangles: (m, 3) numbers of their corners; ``None`` means the convex hull of the vertices.
        name: What to call it in messages.

    Raises:
        InvalidGeometry: If there are no triangles or vertices, a vertex is not finite, a triangle names a corner that
            does not exist, the points of a hull lie in a plane, or the surface is not closed.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64] | None = None
    name: str = "mesh"
    hull: Any = field(init=False, repr=False)  # coal.Convex

    def __post_init__(self) -> None:
        """Check the surface once, where it enters."""
        vertices = _vertices(self.vertices, self.name)
        object.__setattr__(self, "vertices", vertices)
        if self.triangles is not None:
            triangles = np.asarray(self.triangles)
            sound = triangles.ndim == 2 and triangles.shape[1] == 3 and triangles.dtype.kind in "iu"
            if not sound or not len(triangles) or triangles.min() < 0 or triangles.max() >= len(vertices):
                raise InvalidGeometry(f"{self.name} has no triangles, or corners that are none of its vertices")
            object.__setattr__(self, "triangles", triangles.astype(np.int64))
            _check_closed(vertices, triangles, self.name)
        object.__setattr__(self, "hull", convex_hull(vertices, self.name))
        extent = float(np.ptp(vertices, axis=0).max())
        if extent > HUGE:
            warnings.warn(
                f"{self.name} is {extent:.4g} m large: if its file is in millimetres, read it with scale=0.001",
                MeshSize,
                stacklevel=3,
            )

    @staticmethod
    def read(path: str | Path, scale: float = 1.0) -> Mesh:
        """The mesh in a file that coal's reader knows: .stl, .obj, .dae, .ply and others.

        Args:
            path: The file.
            scale: What its numbers are multiplied with to get metres: 0.001 for millimetres.

        Raises:
            InvalidGeometry: If there is no such file, it cannot be read, or it is not a closed surface.
        """
        file = Path(path).expanduser()
        if not file.is_file():
            raise InvalidGeometry(f"there is no mesh {file}")
        if not 0.0 < scale < np.inf:
            raise InvalidGeometry(f"the scale of a mesh is a finite number above 0, got {scale!r}")
        try:
            model = coal.MeshLoader(coal.BV_OBBRSS).load(str(file), np.full(3, float(scale)))
        except (ValueError, RuntimeError) as error:
            reason = " ".join(str(error).rpartition("message: ")[2].split())
            raise InvalidGeometry(f"{file} cannot be read as a mesh: {reason}") from None
        triangles = [[model.tri_indices(i)[c] for c in range(3)] for i in range(model.num_tris)]
        return Mesh(np.array(model.vertices()), np.array(triangles, dtype=np.int64).reshape(-1, 3), file.name)

    @property
    def convex(self) -> bool:
        """Whether the solid is its own convex hull, to a hundredth of its volume."""
        return self.triangles is None or _volume(self.vertices, self.triangles) > 0.99 * float(
            self.hull.computeVolume()
        )

    def geometry(self) -> Any:
        """The shape as coal has it: a hull where the solid is convex, else its surface."""
        if self.convex:
            return self.hull
        model = coal.BVHModelOBBRSS()
        assert self.triangles is not None
        model.beginModel(len(self.triangles), len(self.vertices))
        model.addVertices(self.vertices)
        model.addTriangles(self.triangles)
        model.endModel()
        return model


def convex_hull(points: NDArray[np.float64], name: str = "mesh") -> Any:
    """The convex hull of points (k, 3), as a ``coal.Convex``; a little larger where coal cannot hold it otherwise.

    Raises:
        InvalidGeometry: If they all lie in one plane.
    """
    if flat(points):  # coal's hull takes the process down with it
        raise InvalidGeometry(f"{name} has no volume: its {len(points)} points lie in one plane")
    try:
        return _qhull(points)
    except RuntimeError:  # a corner with more than 255 neighbours, where hundreds of points lie in one plane
        grown = 1.0 + GROWTH * np.random.default_rng(0).random((len(points), 1))
        centre = points.mean(axis=0)
        return _qhull(centre + grown * (points - centre))


def _qhull(points: NDArray[np.float64]) -> Any:
    column = coal.StdVec_Vec3s()
    column.extend(list(points))
    return coal.Convex.convexHull(column, True, "Qt")


def flat(points: NDArray[np.float64]) -> bool:
    """Whether points (k, 3) lie in one plane."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return len(points) < 4 or bool(spread[2] <= FLAT * spread[0])


def _vertices(vertices: ArrayLike, name: str) -> NDArray[np.float64]:
    try:
        array = np.array(vertices, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 3 or not len(array):
        raise InvalidGeometry(f"{name} is empty: a mesh has vertices (k, 3)")
    if not np.isfinite(array).all():
        raise InvalidGeometry(f"{name} has vertices that are not finite")
    return array


def _check_closed(vertices: NDArray[np.float64], triangles: NDArray[np.int64], name: str) -> None:
    """Every edge of a closed surface belongs to an even number of triangles; vertices at one place count as one."""
    _, same = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
    corners = same.reshape(-1)[triangles]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]  # slivers have no area
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    gaps = int((counts % 2 == 1).sum())
    if gaps or not len(corners):
        raise InvalidGeometry(
            f"{name} is not closed: {gaps} of its {len(counts)} edges belong to one triangle only; close it, or give "
            "Mesh(vertices) alone for the convex hull"
        )


def _volume(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> float:
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return abs(float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum())) / 6.0
