"""Simpler solids that enclose a mesh: its convex hull, or a capsule around that.

Nothing that is free of the simpler solid can touch the mesh: a hull contains every vertex, and with them the triangles
between; a capsule's radius is the largest distance of any vertex from its axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.cache import Arrays, kept
from pin_metaik.collision.extent import box_of
from pin_metaik.collision.interior import Interior
from pin_metaik.collision.mesh import convex_hull, flat

Simplify: TypeAlias = Literal["none", "convex", "capsule"]

ROUNDING = 1e-9  # m that a capsule is larger than it need be
THICK = 1e-5  # m that a sheet is thickened by, each way
STEPS = 400  # of the fit, from each of the three principal axes


@dataclass(frozen=True, eq=False)
class Solid:
    """One piece of geometry at three levels of detail, each inside the next.

    Attributes:
        original: As the robot's file or the user has it; a mesh is a surface, not a solid.
        hull: Its convex hull; what is no mesh stays as it is.
        coarse: What is checked first.
        offset: Placement of ``coarse`` in the frame of the others.
    """

    original: Any
    hull: Any
    coarse: Any
    offset: pin.SE3

    @cached_property
    def box(self) -> NDArray[np.float64]:
        """(7,) centre, half of the edges and radius of the ball of the box around it, in its frame, m."""
        return box_of(self.hull)

    @cached_property
    def interior(self) -> Interior:
        """What the original, if it is a mesh, has inside."""
        return Interior.of(self.original)


def solid_of(geometry: Any, simplify: Simplify, *, robot: bool = True) -> Solid:
    """The three levels of a geometry of coal; an obstacle (not ``robot``) that is a concave mesh stays a mesh."""
    here = pin.SE3.Identity()
    if not isinstance(geometry, coal.BVHModelBase):
        convex = isinstance(geometry, coal.Convex) and simplify == "capsule" and robot
        capsule = _capsule(np.array(geometry.points())) if convex else None
        return Solid(geometry, geometry, *(capsule or (geometry, here)))
    vertices = np.array(geometry.vertices())
    shapes = kept("solid", vertices.tobytes(), lambda: _enclose(vertices))
    hull = _convex(shapes["points"], shapes["faces"])
    match simplify:
        case "convex" if robot:
            return Solid(geometry, hull, hull, here)
        case "capsule" if robot:
            return Solid(geometry, hull, *_placed(shapes["axis"], float(shapes["radius"])))
        case _:
            return Solid(geometry, hull, geometry, here)


def _enclose(vertices: NDArray[np.float64]) -> Arrays:
    """Hull and capsule of the vertices (k, 3) as arrays; a sheet is given some thickness."""
    if flat(vertices):
        vertices = (vertices[:, None] + THICK * np.vstack([np.eye(3), -np.eye(3)])).reshape(-1, 3)
    hull = convex_hull(vertices)
    points = np.array(hull.points())
    faces = np.array([[hull.polygons(i)[c] for c in range(3)] for i in range(hull.num_polygons)], dtype=float)
    axis, radius = fit_capsule(points)
    return {"points": points, "faces": faces, "axis": axis, "radius": np.array(radius)}


def _convex(points: NDArray[np.float64], faces: NDArray[np.float64]) -> Any:
    corners, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    corners.extend(list(points))
    triangles.extend([coal.Triangle(*map(int, face)) for face in faces])
    return coal.Convex(corners, triangles)


def _capsule(points: NDArray[np.float64]) -> tuple[Any, pin.SE3]:
    return _placed(*fit_capsule(points))


def _placed(axis: NDArray[np.float64], radius: float) -> tuple[Any, pin.SE3]:
    """A capsule of coal, and where it stands; ``axis`` (2, 3) are the ends of its segment."""
    along = axis[1] - axis[0]
    length = float(np.linalg.norm(along))
    up = np.array([0.0, 0.0, 1.0])
    turn = pin.Quaternion.FromTwoVectors(up, along / length if length > 0.0 else up).matrix()
    return coal.Capsule(radius, length), pin.SE3(turn, axis.mean(axis=0))


def fit_capsule(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The ends (2, 3) of the axis and the radius of a small capsule that encloses points (k, 3).

    The axis turns and shifts to the least volume (Nelder and Mead 1965), from each of the principal axes.
    """
    from scipy.optimize import minimize  # takes a fifth of a second to import, and the cache makes it rare

    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    size = float(np.ptp(points, axis=0).max())
    best: tuple[float, NDArray[np.float64]] = (math.inf, np.zeros((2, 3)))
    for k in range(3):
        u, v, w = axes[k], axes[k - 1], axes[k - 2]

        def segment(p: NDArray[np.float64], u: Any = u, v: Any = v, w: Any = w) -> NDArray[np.float64]:
            direction = u + p[0] * v + p[1] * w
            return _shortest(points, centre + size * (p[2] * v + p[3] * w), direction / np.linalg.norm(direction))

        def volume(p: NDArray[np.float64], segment: Any = segment) -> float:
            ends = segment(p)
            r = _radius(points, ends)
            return math.pi * r * r * (float(np.linalg.norm(ends[1] - ends[0])) + 4.0 / 3.0 * r)

        simplex = np.vstack([np.zeros(4), 0.1 * np.eye(4)])
        found = minimize(
            volume, np.zeros(4), method="Nelder-Mead", options={"initial_simplex": simplex, "maxfev": STEPS}
        )
        if found.fun < best[0]:
            best = float(found.fun), segment(found.x)
    return best[1], _radius(points, best[1]) + ROUNDING


def _shortest(points: NDArray[np.float64], at: NDArray[np.float64], u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ends (2, 3) of the shortest segment on a line, through ``at`` along u, whose capsule of least radius encloses."""
    s = (points - at) @ u
    away = ((points - at) ** 2).sum(axis=1) - s * s
    cap = np.sqrt(np.maximum(away.max() - away, 0.0))  # how far beyond its end the ball still covers a point
    low, high = float((s + cap).min()), float((s - cap).max())
    if low > high:
        low = high = 0.5 * (low + high)
    return at + np.outer([low, high], u)


def _radius(points: NDArray[np.float64], ends: NDArray[np.float64]) -> float:
    """The largest distance of points (k, 3) from a segment (2, 3)."""
    along = ends[1] - ends[0]
    square = float(along @ along)
    t = np.clip((points - ends[0]) @ along / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(points))
    return float(np.sqrt((((points - ends[0]) - t[:, None] * along) ** 2).sum(axis=1).max()))
