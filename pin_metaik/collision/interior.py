"""Whether points lie inside a mesh: for coal a mesh is a surface, which a body well inside does not touch.

A mesh falls into components, the triangles that share corners. Where every edge of a component belongs to an even
number of triangles, it is closed, and has an inside; a component that is not closed is a sheet, and counts by its
surface alone. A closed component that lies within another one is a hollow of it, like the inner wall of a room: what is
inside the hollow is free. Closed components that cross each other are solid together.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

SAME = 9  # decimals, of metres, to which corners at one place agree
SPREAD = 64  # corners of a component that are looked at to see whether it lies within another one


@dataclass(frozen=True, eq=False)
class Interior:
    """The components of a mesh, in its frame.

    Attributes:
        points: (k, 3) a corner of every component, closed or not, m.
        triangles: (t, 9) the corners of the triangles of closed components, m.
        starts: (c + 1,) where the triangles of each closed component begin.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.float64]
    starts: NDArray[np.int64]

    @staticmethod
    def of(mesh: Any) -> Interior:
        """The components of a ``coal.BVHModelBase``."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        vertices, triangles = np.array(mesh.vertices()), _triangles_of(mesh)
        _, same = np.unique(np.round(vertices, SAME), axis=0, return_inverse=True)
        corners = same.reshape(-1)[triangles]
        area = (corners != np.roll(corners, 1, axis=1)).all(axis=1)  # the others are needles without any
        corners, triangles = corners[area], triangles[area]
        edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
        count = int(same.max()) + 1
        links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
        component = connected_components(links, directed=False)[1]
        sides, times = np.unique(edges, axis=0, return_counts=True)
        of_triangle = component[corners[:, 0]]
        ids, first = np.unique(of_triangle, return_index=True)
        sheets = component[sides[times % 2 == 1, 0]]
        closed = ids[~np.isin(ids, sheets)]
        order = np.argsort(of_triangle, kind="stable")
        order = order[np.isin(of_triangle[order], closed)]
        return Interior(
            np.ascontiguousarray(vertices[triangles[first, 0]]),
            vertices[triangles[order]].reshape(-1, 9),
            np.append(np.searchsorted(of_triangle[order], closed), len(order)).astype(np.int64),
        )

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """Least and greatest corner (c, 6) of the box around each closed component, m."""
        parts = [part.reshape(-1, 3) for part in np.split(self.triangles, self.starts[1:-1])]
        return np.array([[*part.min(axis=0), *part.max(axis=0)] for part in parts if len(part)]).reshape(-1, 6)

    @cached_property
    def signs(self) -> NDArray[np.int64]:
        """1 for each closed component (c,) that is solid, -1 for one that is a hollow of others."""
        from pin_metaik.collision.rays import enclosed

        signs = np.ones(len(self.boxes), dtype=np.int64)
        if len(self.boxes) < 2:
            return signs
        for c, part in enumerate(np.split(self.triangles, self.starts[1:-1])):
            corners = part.reshape(-1, 3)
            looked_at = np.ascontiguousarray(corners[:: max(1, len(corners) // SPREAD)])
            inside = np.zeros((len(looked_at), len(self.boxes)), dtype=bool)
            enclosed(self.triangles, self.starts, self.boxes, looked_at, inside)
            around = np.delete(inside.all(axis=0), c)
            signs[c] = 1 - 2 * (int(around.sum()) % 2)
        return signs

    def contains_any(self, pose: NDArray[np.float64], points: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
        """Whether any of the points (k, 3) of another body is inside.

        Both poses are rotations column by column, then translations, (12,).
        """
        from pin_metaik.collision.rays import contains_any

        if not len(self.boxes):
            return False
        return bool(contains_any(self.triangles, self.starts, self.boxes, self.signs, pose, points, other))


def _triangles_of(mesh: Any) -> NDArray[np.int64]:
    """Numbers (t, 3) of the corners of a coal mesh's triangles."""
    corners = (mesh.tri_indices(i) for i in range(mesh.num_tris))
    flat = np.fromiter((corner[k] for corner in corners for k in range(3)), dtype=np.int64, count=3 * mesh.num_tris)
    return flat.reshape(-1, 3)
