"""Platforms and poses the tests of stewart share."""

from __future__ import annotations

import numpy as np

from pin_metaik.stewart import Geometry, Mechanism, Servos, forward, load_mechanism, pose_at, transmission

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


def general_servos(branches: int | tuple[int, ...] = (1, -1, 1, 1, -1, 1)) -> Geometry:
    """Joints at any heights; horns, rods, axes and branches of their own."""
    rng = np.random.default_rng(7)
    base = load_mechanism("servo_sg90").geometry
    joints = base.base_joints + rng.uniform(-0.006, 0.006, (6, 3))
    moving = base.platform_joints + rng.uniform(-0.004, 0.004, (6, 3))
    u, _, a = base.servos.frames.transpose(1, 0, 2)
    lengths = {"horn": rng.uniform(0.018, 0.026, 6), "rod": rng.uniform(0.112, 0.128, 6)}
    middle = np.broadcast_to(branches, 6)[:, None] * u  # on the other branch horns point the other way
    ways = {"axes": a + rng.uniform(-0.4, 0.4, (6, 3)), "zeros": middle + rng.uniform(-0.3, 0.3, (6, 3))}
    given = {name: tuple(value.tolist()) for name, value in lengths.items()}
    given |= {name: tuple(map(tuple, value.tolist())) for name, value in ways.items()}
    return Geometry.of_joints(joints, moving, servos=Servos(branches=branches, **given))


def servo_platforms() -> dict[str, Geometry]:
    """The makers' two, and the general one."""
    named = {name: load_mechanism(name).geometry for name in ("servo_sg90", "servo_esp32")}
    return {**named, "general": general_servos()}


def servo_poses(count: int, geometry: Geometry, seed: int = 0) -> np.ndarray:
    """Poses (count, 4, 4) round about a level one, at which no rod is near to being in line with its horn."""
    home = forward(geometry, np.zeros(6)).pose
    kept = np.empty((0, 4, 4))
    while len(kept) < count:
        poses = home @ some_poses(2 * count, (0.0, 0.0, 0.0), (0.008, 0.008, 0.006), 0.1, seed)
        kept = np.concatenate((kept, poses[np.nan_to_num(transmission(geometry, poses)).min(axis=1) > 0.3]))
        seed += 1000
    return kept[:count]
