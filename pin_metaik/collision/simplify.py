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
from pin_metaik.collision.extent import box_of, corners_of
from pin_metaik.collision.interior import Interior
from pin_metaik.collision.mesh import convex, convex_hull, flat, triangles_of

Simplify: TypeAlias = Literal["none", "convex", "capsule"]

ROUNDING = 1e-9  # m that a capsule is larger than it need be
THICK = 1e-5  # m that a sheet is thickened by, each way
STEPS = 400  # of the fit, from each of the three principal axes
SETTLED = 1e-3  # rad, and share of the size, below which the fit no longer moves
DIRECTIONS = 200  # in which the points that decide the fit are outermost


@dataclass(frozen=True, eq=False)
class Solid:
    """One piece of geometry at three levels of detail, each inside the next.

    Attributes:
        original: As the robot's file or the user has it; a mesh is a surface, not a solid.
        hull: Its convex hull; the shape itself, if it is no mesh.
        coarse: The solid that is checked first.
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

    @property
    def corners(self) -> NDArray[np.float64]:
        """(k, 3) points whose convex hull is around it, in its frame, m: the corners of its hull, or of its box."""
        return corners_of(self.hull)

    @cached_property
    def interior(self) -> Interior:
        """The interior of the original, if it is a mesh."""
        return Interior.of(self.original)


def solid_of(geometry: Any, simplify: Simplify, *, robot: bool = True) -> Solid:
    """The three levels of a geometry of coal; an obstacle (not ``robot``) that is a concave mesh stays a mesh.

    Only what is asked for is fitted: every mesh has a hull, capsules are looked for where they are checked.
    """
    mesh = isinstance(geometry, coal.BVHModelBase)
    hull = _hull(np.array(geometry.vertices())) if mesh else geometry
    match simplify:
        case "capsule" if robot and isinstance(hull, coal.Convex):
            return Solid(geometry, hull, *_capsule(np.array(hull.points())))
        case "convex" if robot:
            return Solid(geometry, hull, hull, pin.SE3.Identity())
        case _:
            return Solid(geometry, hull, geometry, pin.SE3.Identity())


def _hull(vertices: NDArray[np.float64]) -> Any:
    """The convex hull of the vertices (k, 3) of a mesh, as a ``coal.Convex``, kept on disk."""
    hull = kept("hull", vertices.tobytes(), lambda: _faces(vertices))
    return convex(hull["points"], hull["faces"])


def _faces(vertices: NDArray[np.float64]) -> Arrays:
    """Corners and triangles of the convex hull of vertices (k, 3); a sheet is given some thickness."""
    if flat(vertices):
        vertices = (vertices[:, None] + THICK * np.vstack([np.eye(3), -np.eye(3)])).reshape(-1, 3)
    hull = convex_hull(vertices)
    return {"points": np.array(hull.points()), "faces": triangles_of(hull).astype(float)}


def _capsule(points: NDArray[np.float64]) -> tuple[Any, pin.SE3]:
    """A capsule of coal around points (k, 3), and where it stands; its fit is kept on disk."""

    def fitted() -> Arrays:
        ends, radius = fit_capsule(points)
        return {"ends": ends, "radius": np.array(radius)}

    capsule = kept("capsule", points.tobytes(), fitted)
    axis, radius = capsule["ends"], float(capsule["radius"])
    along = axis[1] - axis[0]
    length = float(np.linalg.norm(along))
    up = np.array([0.0, 0.0, math.copysign(1.0, along[2])])  # a capsule has no up and down: never turn by a half circle
    turn = pin.Quaternion.FromTwoVectors(up, along / length if length > 0.0 else up).matrix()
    return coal.Capsule(radius, length), pin.SE3(turn, axis.mean(axis=0))


def fit_capsule(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The ends (2, 3) of the axis and the radius of a small capsule that encloses points (k, 3).

    The axis turns and shifts to the least volume (Nelder and Mead 1965), from each of the principal axes. Of many
    points those decide that are outermost in some direction; all of them are enclosed.
    """
    from scipy.optimize import minimize  # takes a fifth of a second to import, and the cache makes it rare

    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    size = float(np.ptp(points, axis=0).max())
    outermost = _outermost(points)

    def segment(p: NDArray[np.float64], k: int, around: NDArray[np.float64]) -> NDArray[np.float64]:
        u, v, w = axes[k], axes[k - 1], axes[k - 2]
        direction = u + p[0] * v + p[1] * w
        return _shortest(around, centre + size * (p[2] * v + p[3] * w), direction / np.linalg.norm(direction))

    def volume(p: NDArray[np.float64], k: int, around: NDArray[np.float64]) -> float:
        ends = segment(p, k, around)
        r = _radius(around, ends)
        return math.pi * r * r * (float(np.linalg.norm(ends[1] - ends[0])) + 4.0 / 3.0 * r)

    options = {"initial_simplex": np.vstack([np.zeros(4), 0.1 * np.eye(4)]), "maxfev": STEPS, "xatol": SETTLED}
    found = [
        minimize(volume, np.zeros(4), args=(k, outermost), method="Nelder-Mead", options=options).x for k in range(3)
    ]
    best = min(range(3), key=lambda k: volume(found[k], k, points))
    ends = segment(found[best], best, points)
    return ends, _radius(points, ends) + ROUNDING


def _outermost(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of points (k, 3) those that are the farthest in one of ``DIRECTIONS`` directions; all, if they are few."""
    if len(points) <= DIRECTIONS:
        return points
    turn = np.arange(DIRECTIONS) * math.pi * (3.0 - math.sqrt(5.0))  # evenly over the sphere, along a spiral
    z = np.linspace(1.0, -1.0, DIRECTIONS)
    directions = np.stack([np.sqrt(1.0 - z * z) * np.cos(turn), np.sqrt(1.0 - z * z) * np.sin(turn), z], axis=1)
    shape = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    round_points = (points - points.mean(axis=0)) @ shape[2].T / shape[1]  # evenly for long and flat bodies, too
    outermost: NDArray[np.float64] = points[np.unique((round_points @ directions.T).argmax(axis=0))]
    return outermost


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
