"""Platforms and poses the tests of stewart share."""

from __future__ import annotations

import numpy as np

from pin_metaik.stewart import Geometry, Mechanism, load_mechanism, pose_at

STROKES = (50, 100, 150, 200, 250)
OCTAHEDRON = ((0, 2), (0, 0), (1, 0), (1, 1), (2, 1), (2, 2))  # "311223": B1-M3 B1-M1 B2-M1 ...


def stroke(mm: int) -> Mechanism:
    return load_mechanism(f"stroke_{mm}")


def reference() -> Mechanism:
    return load_mechanism("reference_6x6")


def cube(a: float, **changes: object) -> Geometry:
    """Three corners of a cube about one end of a diagonal, and three about the other: the legs are edges."""
    r = a * np.sqrt(2 / 3)
    given = {"base_angles": np.radians([0, 120, 240]), "platform_angles": np.radians([60, 180, 300])}
    return Geometry(r, r, legs=OCTAHEDRON, **(given | changes))


def similar_hexagons() -> Geometry:
    """Regular hexagons, joint above joint: singular wherever it goes."""
    angles = np.radians(np.arange(0, 360, 60))
    return Geometry(0.25, 0.12, angles, angles, tuple((i, i) for i in range(6)))


def some_poses(
    count: int, centre: tuple[float, float, float], spread: tuple[float, float, float], turn: float, seed: int = 0
) -> np.ndarray:
    """Poses (count, 4, 4) round about a level one; m and rad."""
    rng = np.random.default_rng(seed)
    return np.array(
        [pose_at(centre + rng.uniform(-1, 1, 3) * spread, rng.uniform(-turn, turn, 3)) for _ in range(count)]
    )


def home_poses(count: int, seed: int = 0) -> np.ndarray:
    """Poses round about the home of the 6x6 reference."""
    return some_poses(count, (0.0, 0.0, 0.37), (0.06, 0.06, 0.042), 0.3, seed)
