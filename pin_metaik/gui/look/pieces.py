"""The pieces of a robot as triangles, read once for all tabs."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any, Literal, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.drawing import surface
from pin_metaik.robots import Robot

Drawn = Literal["links", "meshes", "axes"]
"""A robot by the shapes that collide, by those that are for the eye, or by the axes of its joints."""

ROBOTS_KEPT = 8
LOCK = threading.Lock()  # two tabs that open the same robot read it once


class Piece(NamedTuple):
    """A rigid piece.

    Attributes:
        link: Name of its link, as collisions have it.
        joint: Number of the joint it moves with.
        vertices: (k, 3) in the joint's frame, m.
        triangles: (m, 3).
        colour: Red, green, blue, 0 to 255.
    """

    link: str
    joint: int
    vertices: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    colour: tuple[int, int, int]


def pieces_of(robot: Robot, drawn: Drawn) -> tuple[Piece, ...]:
    """The pieces of a robot; drawn by its axes it has none.

    Raises:
        InvalidModel: A mesh is missing or unreadable.
    """
    with LOCK:
        return () if drawn == "axes" else _pieces(robot, drawn)


@lru_cache(ROBOTS_KEPT)
def _pieces(robot: Robot, drawn: Drawn) -> tuple[Piece, ...]:
    models = (
        (robot.visual_model, robot.collision_model)
        if drawn == "meshes"
        else (robot.collision_model, robot.visual_model)
    )
    geometry = next((model for model in models if model.ngeoms), models[0])
    return tuple(_piece(robot.model, one) for one in geometry.geometryObjects if _bounded(one))


def _bounded(one: Any) -> bool:
    return type(one.geometry).__name__ not in ("Halfspace", "Plane")


def _piece(model: pin.Model, one: Any) -> Piece:
    vertices, triangles = _triangles(one)
    placed = vertices @ one.placement.rotation.T + one.placement.translation
    red, green, blue = (int(255 * value) for value in np.clip(one.meshColor[:3], 0.0, 1.0))
    return Piece(
        model.frames[one.parentFrame].name,
        int(one.parentJoint),
        placed.astype(np.float32),
        triangles.astype(np.uint32),
        (red, green, blue),
    )


def _triangles(one: Any) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles; of a mesh from its file, which is far quicker than asking coal for each triangle."""
    read = READERS.get(one.meshPath.rpartition(".")[2].lower())
    if read is not None:
        with suppress(Exception):  # trimesh stumbles, in many ways, over files that coal has read
            mesh = read(one.meshPath)
            return np.array(mesh.vertices) * np.array(one.meshScale), np.array(mesh.faces)
    return surface(one.geometry)


def _loaded(path: str) -> Any:
    import trimesh

    return trimesh.load(path, force="mesh")


READERS: dict[str, Callable[[str], Any]] = {"dae": _loaded, "stl": _loaded, "obj": _loaded}
