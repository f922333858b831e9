"""How far geometries of coal extend: the box around one, and a point inside."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import coal
import numpy as np
from numpy.typing import NDArray

FLAT = coal.Halfspace, coal.Plane
ENDLESS = 1e6  # m; what half-spaces and planes count as wide


def is_flat(geometry: Any) -> bool:
    """Whether a geometry is a half-space or a plane: without end, and met by a mesh where its hull meets it."""
    return isinstance(geometry, FLAT)


def box_of(geometry: Any) -> NDArray[np.float64]:
    """(7,) centre, half of the edges and radius of the ball of the box around a geometry, in its frame, m."""
    if is_flat(geometry):  # whichever way it will be turned
        return np.array([0.0, 0.0, 0.0, ENDLESS, ENDLESS, ENDLESS, math.inf])
    geometry.computeLocalAABB()
    low, high = np.array(geometry.aabb_local.min_), np.array(geometry.aabb_local.max_)
    half = 0.5 * (high - low)
    return np.array([*(0.5 * (low + high)), *half, np.linalg.norm(half)])


def corners_of(geometry: Any) -> NDArray[np.float64]:
    """(k, 3) points whose convex hull is around a geometry, in its frame, m: its corners, or those of its box."""
    if isinstance(geometry, coal.ConvexBase):
        points: NDArray[np.float64] = np.array(geometry.points())
        return points
    box = box_of(geometry)
    corners: NDArray[np.float64] = box[:3] + np.array(list(product((-1.0, 1.0), repeat=3))) * box[3:6]
    return corners


def stand(geometry: Any, box: NDArray[np.float64], row: NDArray[np.float64]) -> NDArray[np.float64]:
    """(16,) the box of what stands, in the world: centre, axes one by one, half of the edges, radius.

    A half-space is a box without end whose top is its surface; a plane one without thickness.

    Args:
        geometry: The geometry.
        box: (7,) its box in its own frame.
        row: (12,) its pose: rotation column by column, then translation.
    """
    turn, shift = row[:9].reshape(3, 3).T, row[9:]
    if not is_flat(geometry):
        return np.array([*(turn @ box[:3] + shift), *row[:9], *box[3:]])
    normal = turn @ np.array(geometry.n)
    surface = (float(geometry.d) + float(normal @ shift)) * normal
    depth = ENDLESS if isinstance(geometry, coal.Halfspace) else 0.0
    across = np.linalg.svd(normal[None])[2][1:]
    return np.array([*(surface - depth * normal), *normal, *across.ravel(), depth, ENDLESS, ENDLESS, math.inf])


def centre(geometry: Any) -> NDArray[np.float64]:
    """(1, 3) a point inside a convex geometry, in its frame, m; the middle of the box of any other."""
    if isinstance(geometry, coal.ConvexBase):
        middle: NDArray[np.float64] = np.array(geometry.points()).mean(axis=0, keepdims=True)
        return middle
    if is_flat(geometry):
        surface: NDArray[np.float64] = float(geometry.d) * np.array(geometry.n)[None]
        return surface
    return box_of(geometry)[None, :3].copy()
