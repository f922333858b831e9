"""Robots, obstacles and configurations that collision checks are tried on: much of it aligned, some of it concave."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.collision import Box, Capsule, Cone, Cylinder, HalfSpace, Mesh, Obstacle, Sphere

Floats = NDArray[np.float64]


def aligned(model: pin.Model, rng: np.random.Generator, count: int) -> Floats:
    """Configurations (count, nq) on a raster: turns by multiples of 45 degrees, slides of 1 cm; the first is home."""
    Q = np.repeat(pin.neutral(model)[None], count, axis=0)
    for joint in list(model.joints)[1:]:
        if joint.nq != 1:
            continue
        i = joint.idx_q
        step = 0.01 if "P" in joint.shortname() else rng.choice([0.25, 0.5]) * math.pi
        low, high = model.lowerPositionLimit[i], model.upperPositionLimit[i]
        low, high = (low if low > -1e3 else -math.pi), (high if high < 1e3 else math.pi)
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        Q[1:, i] = step * rng.integers(first, last + 1, count - 1)
    return Q


def around_an_arm() -> list[Obstacle]:
    """A floor, posts, boxes, a wall, a bin and a concave block."""
    turned = pin.SE3(pin.utils.rotate("z", 0.25 * math.pi), np.array([-0.5, 0.3, 0.4]))
    return [
        Obstacle("floor", HalfSpace(), (0.0, 0.0, -0.4)),
        Obstacle("post", Cylinder(0.05, 1.0), (0.5, 0.5, 0.5)),
        Obstacle("pole", Capsule(0.04, 0.6), (-0.4, -0.5, 0.5)),
        Obstacle("box", Box((0.2, 0.2, 0.2)), (0.6, 0.0, 0.1)),
        Obstacle("turned box", Box((0.2, 0.3, 0.1)), turned),
        Obstacle("wall", Box((0.01, 0.6, 0.8)), (0.0, 0.75, 0.6)),
        Obstacle("cone", Cone(0.1, 0.3), (0.3, -0.5, 0.15)),
        Obstacle("bin", bin_of(0.4, 0.3, 0.2, 0.01), (0.55, -0.35, 0.0)),
        Obstacle("block", l_block(0.6), (-0.7, 0.0, 0.6)),
    ]


def around_a_gantry() -> list[Obstacle]:
    """Solids on a raster of centimetres, a bin, and a block that the slide fits into."""
    return [
        Obstacle("part", Box((0.04, 0.04, 0.04)), (0.1, 0.0, 0.0)),
        Obstacle("long", Box((0.1, 0.5, 0.1)), (-0.3, 0.0, -0.2)),
        Obstacle("ball", Sphere(0.05), (0.2, 0.3, 0.0)),
        Obstacle("post", Cylinder(0.05, 0.2), (0.2, -0.3, 0.0)),
        Obstacle("pole", Capsule(0.03, 0.1), (0.0, 0.3, 0.0)),
        Obstacle("cone", Cone(0.05, 0.1), (0.0, -0.3, 0.0)),
        Obstacle("bin", bin_of(0.4, 0.3, 0.2, 0.01), (0.2, 0.0, -0.4)),
        Obstacle("block", l_block(0.8), (0.0, 0.0, 0.12)),
    ]


def prism(outline: Floats, height: float) -> tuple[Floats, NDArray[np.int64]]:
    """Vertices and triangles of a prism over an outline (k, 2) that is seen whole from its first corner."""
    k = len(outline)
    vertices = np.concatenate([np.c_[outline, np.zeros(k)], np.c_[outline, np.full(k, height)]])
    fan = [(0, i, i + 1) for i in range(1, k - 1)]
    sides = [(i, (i + 1) % k, (i + 1) % k + k) for i in range(k)]
    more = [(i, (i + 1) % k + k, i + k) for i in range(k)]
    lids = [(c, b, a) for a, b, c in fan] + [(a + k, b + k, c + k) for a, b, c in fan]
    return vertices, np.array(lids + sides + more)


def l_block(size: float) -> Mesh:
    """A block in the form of an L, one closed surface, its middle at the inner corner."""
    h = 0.5 * size
    outline = np.array([[0.0, 0.0], [0.0, h], [-h, h], [-h, -h], [h, -h], [h, 0.0]])
    return Mesh(*prism(outline, h), "block")


def bin_of(x: float, y: float, z: float, wall: float) -> Mesh:
    """An open bin, its bottom at z = 0: a closed surface round its walls."""
    outer = np.array([[-x, -y], [x, -y], [x, y], [-x, y]]) / 2.0
    inner = outer - np.sign(outer) * wall
    rings = ((outer, 0.0), (outer, z), (inner, z), (inner, wall))
    vertices = np.concatenate([np.c_[ring, np.full(4, height)] for ring, height in rings])
    sides = [(4 * r + i, 4 * r + (i + 1) % 4) for r in range(3) for i in range(4)]
    quads = [(a, b, b + 4, a + 4) for a, b in sides] + [(3, 2, 1, 0), (12, 13, 14, 15)]
    return Mesh(vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]), "bin")


GANTRIES = {
    "gantry, box": '<box size="0.1 0.1 0.2"/>',
    "gantry, cylinder": '<cylinder radius="0.05" length="0.1"/>',
    "gantry, concave mesh": "",
}


def gantry(name: str) -> mik.Robot:
    """Three slides and a turn about z that carry one solid."""
    with tempfile.TemporaryDirectory() as folder:
        shape = GANTRIES[name]
        if not shape:
            mesh = l_block(0.2)
            assert mesh.triangles is not None
            lines = [f"v {x} {y} {z}" for x, y, z in mesh.vertices.tolist()]
            lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.triangles.tolist()]
            (Path(folder) / "block.obj").write_text("\n".join(lines) + "\n")
            shape = f'<mesh filename="{folder}/block.obj"/>'
        links = ["base", "x", "y", "z", "tool"]
        collision = f"<collision><geometry>{shape}</geometry></collision>"
        text = "".join(f'<link name="{n}">{collision if n == "tool" else ""}</link>' for n in links)
        for parent, child, kind, axis, reach in (
            ("base", "x", "prismatic", "1 0 0", 0.4),
            ("x", "y", "prismatic", "0 1 0", 0.4),
            ("y", "z", "prismatic", "0 0 1", 0.4),
            ("z", "tool", "revolute", "0 0 1", 3.2),
        ):
            text += (
                f'<joint name="to {child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
                f'<axis xyz="{axis}"/><limit lower="-{reach}" upper="{reach}" effort="1" velocity="1"/></joint>'
            )
        path = Path(folder) / "gantry.urdf"
        path.write_text(f'<robot name="gantry">{text}</robot>')
        robot = mik.load_robot(path)
        assert robot.collision_model.ngeoms  # read while the mesh is there
    return robot


def places(rng: np.random.Generator, count: int) -> list[pin.SE3]:
    """Where things stand around an arm: 0.3 to 0.7 m from its axis, turned about z by multiples of 45 degrees."""
    found = []
    for _ in range(count):
        angle, away = rng.uniform(-math.pi, math.pi), rng.uniform(0.3, 0.7)
        turn = pin.utils.rotate("z", 0.25 * math.pi * rng.integers(8))
        found.append(pin.SE3(turn, np.array([away * math.cos(angle), away * math.sin(angle), rng.uniform(0.1, 0.8)])))
    return found
