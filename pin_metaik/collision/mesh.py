"""Triangle meshes, read from a file or given as arrays; refused if they are not the surface of a solid."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import coal
import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.collision.numbers import real
from pin_metaik.errors import InvalidGeometry
from pin_metaik.mesh_files import check_mesh, is_ply
from pin_metaik.notice import notice
from pin_metaik.ply import read_ply
from pin_metaik.said import warn

FLAT = 1e-9  # thickness of a set of points, in its lengths, below which it has none
GROWTH = 1e-4  # of their distance from the centre that points may move outward, so as not to lie in one plane
FARTHEST = 1e6  # m; of larger bodies coal's distances are rounded to more than a tenth of a millimetre
DENT = 1e-6  # m that the surface of a mesh may be below its hull's, so that the hull stands for it
PAIRS, NEIGHBOURS = (
    20_000_000,
    16,
)  # of triangles and planes that are all compared, or planes of each
HUGE = 20.0  # m; a mesh larger than this was probably drawn in millimetres


class MeshSize(UserWarning):
    """A mesh so large that its file is probably in millimetres."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface of triangles, or the convex hull of points.

    Attributes:
        vertices: (k, 3) m.
        triangles: (m, 3) indices of their vertices; ``None`` means the convex hull of the vertices.
        name: Its name in messages.

    Raises:
        InvalidGeometry: If there are no triangles or vertices, a vertex is not finite, a triangle has an index without
            a vertex, the points of a hull lie in a plane, or the surface is not closed.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64] | None = None
    name: str = "mesh"
    hull: Any = field(init=False, repr=False)  # coal.Convex

    def __post_init__(self) -> None:
        """Check the surface once, where it enters."""
        if isinstance(self.vertices, str | Path):
            raise InvalidGeometry(f"a mesh has vertices (k, 3); to read a file use Mesh.read({str(self.vertices)!r})")
        if not isinstance(self.name, str) or not self.name:
            raise InvalidGeometry(f"the name of a mesh is a text, got {self.name!r}")
        vertices = _vertices(self.vertices, self.name)
        object.__setattr__(self, "vertices", vertices)
        if self.triangles is not None:
            triangles = _triangles(self.triangles)
            if not len(triangles) or triangles.min() < 0 or triangles.max() >= len(vertices):
                raise InvalidGeometry(
                    f"{self.name} has no triangles (m, 3), or triangles with indices outside its vertices"
                )
            object.__setattr__(self, "triangles", triangles)
            _check_closed(vertices, triangles, self.name)
        object.__setattr__(self, "hull", convex_hull(vertices, self.name))
        extent = float(np.ptp(vertices, axis=0).max())
        if extent > HUGE:
            warn(
                f"{self.name} is {extent:.4g} m large: if its file is in millimetres, read it with scale=0.001",
                MeshSize,
            )

    @staticmethod
    def read(path: str | Path, scale: float = 1.0) -> Mesh:
        """Read a mesh from a file in a format that coal reads: .stl, .obj, .dae, .ply and others.

        Of a .dae, its unit and its upward axis are left out, as Pinocchio leaves them out.

        Args:
            path: The file.
            scale: Factor from its numbers to metres: 0.001 for millimetres.

        Raises:
            InvalidGeometry: If there is no such file, it cannot be read, or it is not a closed surface.
        """
        file = existing_file(path, "mesh")
        if not 0.0 < real(scale) < np.inf:
            raise InvalidGeometry(f"the scale of a mesh is a finite number above 0, got {scale!r}")
        with notice(f"reading {file.name}"):
            return _read(file, float(scale))

    @cached_property
    def convex(self) -> bool:
        """Whether the solid is convex: no point of its surface is more than ``DENT`` inside its convex hull."""
        return self.triangles is None or _covers(self.vertices[self.triangles].mean(axis=1), self.hull)

    def geometry(self) -> Any:
        """The shape as coal has it: a hull where the solid is convex, else its surface."""
        if self.convex:
            return self.hull
        assert self.triangles is not None
        return surface(self.vertices, self.triangles)


def surface(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> Any:
    """Vertices (k, 3) and triangles (m, 3) as a ``coal.BVHModelOBBRSS``."""
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(triangles), len(vertices))
    model.addVertices(vertices)
    model.addTriangles(triangles)
    model.endModel()
    return model


def _read(file: Path, scale: float) -> Mesh:
    if is_ply(file):
        vertices, triangles = read_ply(file, InvalidGeometry)
        return Mesh(scale * vertices, triangles, file.name)
    check_mesh(file, InvalidGeometry)
    try:
        model = coal.MeshLoader(coal.BV_OBBRSS).load(str(file), np.full(3, scale))
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).rpartition("message: ")[2].split())
        raise InvalidGeometry(f"{file} cannot be read as a mesh: {reason}") from None
    corners = [[model.tri_indices(i)[c] for c in range(3)] for i in range(model.num_tris)]
    return Mesh(np.array(model.vertices()), np.array(corners, dtype=np.int64).reshape(-1, 3), file.name)


def existing_file(path: object, what: str) -> Path:
    """A file that is there.

    Raises:
        InvalidGeometry: If it is not, or the path is none.
    """
    if not isinstance(path, str | Path):
        raise InvalidGeometry(f"the file of a {what} is a path, got {path!r}")
    try:
        file = Path(path).expanduser()
        there = file.is_file()
    except (OSError, RuntimeError, ValueError) as error:  # no permission, no home, a null character
        raise InvalidGeometry(f"{str(path)!r} is not the path of a {what}: {error}") from None
    if not there:
        raise InvalidGeometry(f"there is no {what} {file}")
    return file


def convex_hull(points: NDArray[np.float64], name: str = "mesh") -> Any:
    """The convex hull of points (k, 3), as a ``coal.Convex``; a little larger where coal cannot hold it otherwise.

    Qhull is asked through scipy, whose errors are exceptions; where coal asks it, sets of points that are nearly flat
    end the process.

    Raises:
        InvalidGeometry: If they all lie in one plane, as far as floating-point numbers can tell.
    """
    from scipy.spatial import ConvexHull, QhullError  # takes a fifth of a second to import

    centre, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    normalised = (points - centre) / (size or 1.0)
    if flat(normalised):
        raise InvalidGeometry(f"{name} has no volume: its {len(points)} points lie in one plane")
    for growth in (0.0, GROWTH):  # grown, if a corner has more than 255 neighbours, as hundreds of points in a plane do
        outward = 1.0 + growth * np.random.default_rng(0).random((len(points), 1))
        try:
            hull = ConvexHull(normalised * outward, qhull_options="Qt")
            return convex(centre + size * (normalised * outward)[hull.vertices], _outward_triangles(hull))
        except QhullError:
            raise InvalidGeometry(f"{name} has no volume: its {len(points)} points nearly lie in one plane") from None
        except RuntimeError:
            continue
    raise InvalidGeometry(
        f"{name} has a convex hull with a corner of more than 255 edges, which coal cannot store: simplify it"
    )


def convex(corners: NDArray[np.float64], triangles: NDArray[Any]) -> Any:
    """A ``coal.Convex`` with corners (k, 3) and triangles (m, 3) whose corners go round the outward normal."""
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(list(corners))
    faces.extend([coal.Triangle(*face) for face in triangles.astype(int).tolist()])
    return coal.Convex(points, faces)


def _outward_triangles(hull: Any) -> NDArray[np.int64]:
    """Triangles (m, 3) of a hull of scipy, as numbers of its vertices, that go round the outward normal."""
    a, b, c = (hull.points[hull.simplices[:, i]] for i in range(3))
    inward = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    triangles = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    place = np.zeros(len(hull.points), dtype=np.int64)
    place[hull.vertices] = np.arange(len(hull.vertices))
    numbered: NDArray[np.int64] = place[triangles]
    return numbered


def flat(points: NDArray[np.float64]) -> bool:
    """Whether points (k, 3) lie in one plane."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return len(points) < 4 or bool(spread[2] <= FLAT * spread[0])


def _vertices(vertices: ArrayLike, name: str) -> NDArray[np.float64]:
    try:
        array = np.array(vertices)
    except ValueError:
        array = np.empty(0)
    if array.dtype.kind not in "iuf":
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 3 or not len(array):
        raise InvalidGeometry(f"{name} is empty: a mesh has vertices (k, 3)")
    if not np.isfinite(array).all():
        raise InvalidGeometry(f"{name} has vertices that are not finite")
    if np.abs(array).max() > FARTHEST:
        raise InvalidGeometry(f"{name} has vertices more than {FARTHEST:g} m from its origin")
    return array.astype(float)


def _triangles(triangles: object) -> NDArray[np.int64]:
    """Numbers of corners (m, 3); none, where that is not what was given."""
    try:
        array = np.array(triangles)
    except ValueError:
        array = np.empty(0)
    sound = array.ndim == 2 and array.shape[1] == 3 and array.dtype.kind in "iu"
    return array.astype(np.int64) if sound else np.empty((0, 3), dtype=np.int64)


def _check_closed(vertices: NDArray[np.float64], triangles: NDArray[np.int64], name: str) -> None:
    """Every edge of a closed surface belongs to an even number of triangles; vertices at one place count as one."""
    corners = _places(np.round(vertices, 9))[triangles]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]  # slivers have no area
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges[:, 0] * len(vertices) + edges[:, 1], return_counts=True)
    gaps = int((counts % 2 == 1).sum())
    if gaps or not len(corners):
        raise InvalidGeometry(
            f"{name} is not closed: {gaps} of its {len(counts)} edges belong to one triangle only; close it, or give "
            "Mesh(vertices) alone for the convex hull"
        )


def _places(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Numbers (k,) of points (k, 3), the same for those at one place: ``np.unique`` in a tenth of its time."""
    order = np.lexsort(points.T)
    new = np.concatenate([[False], (points[order[1:]] != points[order[:-1]]).any(axis=1)])
    place = np.empty(len(points), dtype=np.int64)
    place[order] = np.cumsum(new)
    return place


def _covers(centroids: NDArray[np.float64], hull: Any) -> bool:
    """Whether triangles with these centroids (m, 3) lie in the surface of their convex hull.

    Over a triangle in a hull the depth below the hull is concave, so that it is nowhere more than three times what it
    is at the centroid. That is at most the distance from any plane of the hull: where pairs are many, only from the
    planes whose centroids are near, and a mesh may then count as concave that is not, which costs time only.
    """
    corners, faces = np.array(hull.points()), triangles_of(hull)
    a, b, c = (corners[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    offsets = (normals * a).sum(axis=1)
    if len(centroids) * len(faces) <= PAIRS:
        return bool((np.abs(centroids @ normals.T - offsets).min(axis=1) <= DENT / 3.0).all())
    from scipy.spatial import cKDTree

    near = cKDTree((a + b + c) / 3.0).query(centroids, k=min(NEIGHBOURS, len(faces)))[1]
    depths = np.abs((normals[near] * centroids[:, None]).sum(axis=2) - offsets[near]).min(axis=1)
    return bool((depths <= DENT / 3.0).all())


def triangles_of(hull: Any) -> NDArray[np.int64]:
    """Numbers (m, 3) of the corners of the triangles of a ``coal.Convex``."""
    return np.array([[hull.polygons(i)[c] for c in range(3)] for i in range(hull.num_polygons)], dtype=np.int64)
