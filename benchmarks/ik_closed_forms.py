"""What a closed form needs to know of an arm: which of its axes meet or are parallel, and whole turns."""

from __future__ import annotations

import numpy as np
from ik_serial import SerialArm
from numpy.typing import NDArray

TURN = 2.0 * np.pi

Floats = NDArray[np.float64]


class Unsuitable(Exception):
    """The solver cannot take this arm."""


def decomposition(frames: Floats, tolerance: float = 1e-4) -> tuple[Floats, Floats, str]:
    """Axes (6, 3), a point on each (6, 3) shared where axes meet, and ik-geo's name for such an arm."""
    axes, points = frames[:6, :3, 2], frames[:6, :3, 3].copy()

    def parallel(i: int, j: int) -> bool:
        return bool(np.linalg.norm(np.cross(axes[i], axes[j])) < tolerance)

    def meeting(i: int, j: int) -> Floats | None:
        if parallel(i, j):
            return None
        A = np.column_stack((axes[i], -axes[j]))
        along, *_ = np.linalg.lstsq(A, points[j] - points[i], rcond=None)
        gap = A @ along - (points[j] - points[i])
        return points[i] + along[0] * axes[i] if np.linalg.norm(gap) < tolerance else None

    wrist, late, early = meeting(3, 4), meeting(4, 5), meeting(0, 1)
    if wrist is not None and late is not None and np.linalg.norm(wrist - late) < tolerance:
        points[3:] = wrist
        if parallel(1, 2):
            return axes, points, "spherical_two_parallel"
        if early is not None:
            points[:2] = early
            return axes, points, "spherical_two_intersecting"
        return axes, points, "spherical"
    if parallel(1, 2) and parallel(2, 3):
        if late is not None:
            points[4:] = late
            return axes, points, "three_parallel_two_intersecting"
        return axes, points, "three_parallel"
    raise Unsuitable("no closed form for its axes")


def bounds(arm: SerialArm) -> list[tuple[float, float]]:
    """Limits of each joint; none for a continuous one."""
    pairs = zip(arm.kinds, arm.lower.tolist(), arm.upper.tolist(), strict=True)
    return [(-np.inf, np.inf) if kind == "continuous" else (low, high) for kind, low, high in pairs]


def unwrapped(x: list[float], bounds: list[tuple[float, float]]) -> list[float] | None:
    """Angles, each moved by a turn where that takes it inside its limits; None if one stays outside."""
    inside = []
    for v, (low, high) in zip(x, bounds, strict=True):
        if v < low:
            v += TURN
        elif v > high:
            v -= TURN
        if not low <= v <= high:
            return None
        inside.append(v)
    return inside
