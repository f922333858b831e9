"""What collides by coal's distances of the original geometry, pair by pair, and by solid angles: the package not asked.

Boxes against boxes are decided by arithmetic (the fifteen directions that can part them), every other pair by
``coal.distance``, which was compared with that arithmetic. A body is inside a closed mesh where the solid angle of the
mesh, seen from a corner of the body, is that of a whole ball.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Floats = NDArray[np.float64]
FAR = 0.02  # m; pairs whose boxes are farther apart are free by more than any margin here


@dataclass(frozen=True, eq=False)
class Thing:
    """A piece of geometry, the joint that carries it, where, and whose it is."""

    name: str
    joint: int
    placement: pin.SE3
    geometry: Any

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        """Centre and half edges of its box, in its frame."""
        if isinstance(self.geometry, coal.Halfspace | coal.Plane):
            return np.zeros(3), np.full(3, 1e9)
        self.geometry.computeLocalAABB()
        low, high = np.array(self.geometry.aabb_local.min_), np.array(self.geometry.aabb_local.max_)
        return 0.5 * (low + high), 0.5 * (high - low)

    @cached_property
    def closed(self) -> Floats:
        """Triangles (t, 3, 3) of the closed components of a mesh."""
        return self._components[0]

    @cached_property
    def corners(self) -> Floats:
        """A corner (k, 3) of every component of a mesh; of anything else its middle."""
        return self._components[1]

    @cached_property
    def _components(self) -> tuple[Floats, Floats]:
        if not isinstance(self.geometry, coal.BVHModelBase):
            inside = np.array(self.geometry.points()).mean(axis=0) if hasattr(self.geometry, "points") else self.box[0]
            return np.empty((0, 3, 3)), inside[None]
        vertices = np.array(self.geometry.vertices())
        faces = [[self.geometry.tri_indices(i)[c] for c in range(3)] for i in range(self.geometry.num_tris)]
        same = np.unique(vertices.round(9), axis=0, return_inverse=True)[1].reshape(-1)
        corners = same[np.array(faces)]
        kept = [len(set(corner)) == 3 for corner in corners.tolist()]
        corners, triangles = corners[kept], vertices[np.array(faces)[kept]]
        edges = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        shape = (same.max() + 1, same.max() + 1)
        label = connected_components(coo_array((np.ones(len(edges)), tuple(edges.T)), shape=shape), directed=False)[1]
        unique, times = np.unique(edges, axis=0, return_counts=True)
        open_ones = set(label[unique[times % 2 == 1][:, 0]].tolist())
        of_triangle = label[corners[:, 0]]
        shut = np.array([component not in open_ones for component in of_triangle.tolist()])
        first = np.unique(of_triangle, return_index=True)[1]
        return triangles[shut], triangles[first, 0]


def winding(triangles: Floats, point: Floats) -> float:
    """How often a surface (t, 3, 3) goes round a point (3,): its solid angle over 4 pi (Oosterom and Strackee 1983)."""
    a, b, c = (triangles[:, k] - point for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    over = np.einsum("ij,ij->i", a, np.cross(b, c))
    under = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(2.0 * np.arctan2(over, under).sum() / (4.0 * math.pi))


def apart(a: Floats, A: pin.SE3, b: Floats, B: pin.SE3) -> float:
    """Distance at least, or minus the depth, of two boxes with half edges (3,), by the directions that can part them.

    Exact where they overlap; where they do not, a distance that they are at least apart.
    """
    directions = [*A.rotation.T, *B.rotation.T, *(np.cross(u, v) for u, v in product(A.rotation.T, B.rotation.T))]
    way, best = B.translation - A.translation, -math.inf
    for direction in directions:
        length = float(np.linalg.norm(direction))
        if length > 1e-9:
            n = direction / length
            reach = np.abs(A.rotation.T @ n) @ a + np.abs(B.rotation.T @ n) @ b
            best = max(best, abs(float(way @ n)) - float(reach))
    return best


@dataclass(frozen=True, eq=False)
class Truth:
    """Pairs of things, judged one by one.

    Attributes:
        model: The robot's model.
        things: All geometry; joint 0 stands.
        exempt: Names of pairs that may touch.
    """

    model: pin.Model
    things: tuple[Thing, ...]
    exempt: Collection[tuple[str, str]]

    @staticmethod
    def of(world: Any) -> Truth:
        """The geometry of a ``CollisionWorld`` as its robot and its obstacles have it, and its exempt pairs."""
        frames = world.model.frames
        things = [
            Thing(frames[o.parentFrame].name, int(o.parentJoint), pin.SE3(o.placement), o.geometry)
            for o in world.robot.collision_model.geometryObjects
        ]
        things += [Thing(o.name, 0, o.pose, o.shape.geometry()) for o in world.obstacles]
        return Truth(world.model, tuple(things), world.disabled)

    @cached_property
    def pairs(self) -> list[tuple[Thing, Thing]]:
        """The pairs that move against each other and are not exempt."""
        return [
            (a, b)
            for j, b in enumerate(self.things)
            for a in self.things[:j]
            if a.joint != b.joint and tuple(sorted((a.name, b.name))) not in self.exempt
        ]

    def least(self, q: Floats) -> float:
        """The least distance (m) of all pairs at q (nq,); minus a depth where any overlap."""
        return min((self.distance(a, b, *poses) for a, b, poses in self.near(q)), default=FAR)

    def near(self, q: Floats) -> list[tuple[Thing, Thing, tuple[pin.SE3, pin.SE3]]]:
        """The pairs whose upright boxes are near each other at q (nq,), with their poses."""
        data = self.model.createData()
        pin.forwardKinematics(self.model, data, q)
        at = {thing: data.oMi[thing.joint] * thing.placement for thing in self.things}
        bounds = {
            thing: (M.rotation @ thing.box[0] + M.translation, np.abs(M.rotation) @ thing.box[1])
            for thing, M in at.items()
        }
        return [
            (a, b, (at[a], at[b]))
            for a, b in self.pairs
            if (np.abs(bounds[a][0] - bounds[b][0]) <= bounds[a][1] + bounds[b][1] + FAR).all()
        ]

    def distance(self, a: Thing, b: Thing, A: pin.SE3, B: pin.SE3) -> float:
        """The distance (m) of two things at poses A and B; minus a depth where they overlap."""
        poses = [coal.Transform3s(M.rotation, M.translation) for M in (A, B)]
        there, back = coal.DistanceResult(), coal.DistanceResult()
        surfaces = max(
            coal.distance(a.geometry, poses[0], b.geometry, poses[1], coal.DistanceRequest(), there),
            coal.distance(b.geometry, poses[1], a.geometry, poses[0], coal.DistanceRequest(), back),
        )
        if isinstance(a.geometry, coal.Box) and isinstance(b.geometry, coal.Box):
            exact = apart(a.geometry.halfSide, A, b.geometry.halfSide, B)
            assert exact <= surfaces + 1e-5 and (exact > 0.0 or abs(exact - surfaces) < 1e-5)
            return surfaces if exact > 0.0 else exact
        inside = surfaces > 0.0 and (self._holds(a, b, A.actInv(B)) or self._holds(b, a, B.actInv(A)))
        return -surfaces if inside else surfaces

    def _holds(self, mesh: Thing, other: Thing, pose: pin.SE3) -> bool:
        if not len(mesh.closed):
            return False
        centre, half = mesh.box
        corners = other.corners @ pose.rotation.T + pose.translation
        within = (np.abs(corners - centre) <= half).all(axis=1)
        return any(abs(winding(mesh.closed, corner)) > 0.5 for corner in corners[within])
