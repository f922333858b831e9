"""Shapes of coal as triangles, for drawing only."""

from __future__ import annotations

from typing import Any

import coal
import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.mesh import triangles_of

Triangles = tuple[NDArray[np.float64], NDArray[np.int64]]
SHEET = 3.0  # m; how much of a plane is drawn


def surface(shape: Any) -> Triangles:
    """Vertices (k, 3) and triangles (m, 3) of a shape; of planes a square around the point nearest to the origin."""
    from trimesh import creation

    match shape:
        case coal.Halfspace() | coal.Plane():
            across = np.linalg.svd(np.array(shape.n)[None])[2][1:]
            signs = 0.5 * SHEET * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
            return shape.d * np.array(shape.n) + signs @ across, np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]])
        case coal.Box():
            return _of(creation.box(2.0 * np.array(shape.halfSide)))
        case coal.Sphere():
            return _of(creation.icosphere(radius=shape.radius))
        case coal.Cylinder():
            return _of(creation.cylinder(shape.radius, 2.0 * shape.halfLength))
        case coal.Capsule():
            return _of(creation.capsule(2.0 * shape.halfLength, shape.radius))
        case coal.Cone():
            return _of(creation.cone(shape.radius, 2.0 * shape.halfLength))
        case coal.Ellipsoid():
            vertices, triangles = _of(creation.icosphere())
            return vertices * np.array(shape.radii), triangles
        case coal.BVHModelBase():
            corners = [[shape.tri_indices(i)[c] for c in range(3)] for i in range(shape.num_tris)]
            return np.array(shape.vertices()), np.array(corners, dtype=np.int64)
        case _:
            return np.array(shape.points()), triangles_of(shape)


def _of(mesh: Any) -> Triangles:
    """A mesh of trimesh, with the origin half-way up: its cones stand on theirs."""
    vertices = np.array(mesh.vertices)
    return vertices - [0.0, 0.0, 0.5 * (vertices[:, 2].min() + vertices[:, 2].max())], np.array(mesh.faces)
