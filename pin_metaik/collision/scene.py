"""Scenes: obstacles in a TOML file; a few come with the package."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from pin_metaik.collision.mesh import Mesh
from pin_metaik.collision.obstacle import Obstacle
from pin_metaik.collision.shapes import Box, Capsule, Cone, Cylinder, HalfSpace, Plane, Shape, Sphere
from pin_metaik.errors import InvalidGeometry, UnknownName
from pin_metaik.kinematics.pose import rpy_matrix

SHAPES: dict[str, Callable[..., Shape]] = {
    "box": Box,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "capsule": Capsule,
    "cone": Cone,
    "halfspace": HalfSpace,
    "plane": Plane,
}
KEYS = {"name", "shape", "position", "rpy", "touching"}


def scene_names() -> list[str]:
    """The scenes that come with the package."""
    return sorted(_shipped())


def load_scene(source: str | Path) -> tuple[Obstacle, ...]:
    """The obstacles of a scene, by its name or from a TOML file.

    Each ``[[obstacle]]`` has a ``name``, a ``shape`` with its sizes in m, a ``position`` in m, perhaps ``rpy`` in rad
    (Rz(yaw) Ry(pitch) Rx(roll)) and ``touching``, names that may touch it. A mesh has a ``file``, relative to the
    scene's, and perhaps a ``scale``.

    Raises:
        UnknownName: If no scene has that name.
        InvalidGeometry: If the file is missing or malformed, or an obstacle makes no sense; the message names it.
    """
    path = Path(source).expanduser()
    if isinstance(source, Path) or path.suffix.lower() == ".toml" or len(path.parts) > 1:
        return _obstacles(_read(path), str(path), path.parent)
    if source not in _shipped():
        raise UnknownName("scene", str(source), _shipped())
    return _obstacles(_read(_shipped()[source]), source, Path())


def _shipped() -> dict[str, Traversable]:
    folder = files("pin_metaik.collision") / "scenes"
    return {entry.name.removesuffix(".toml"): entry for entry in folder.iterdir() if entry.name.endswith(".toml")}


def _read(path: Path | Traversable) -> Mapping[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidGeometry(f"cannot read the scene {path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidGeometry(f"{path} is not TOML: {error}") from None


def _obstacles(scene: Mapping[str, Any], name: str, folder: Path) -> tuple[Obstacle, ...]:
    entries = scene.get("obstacle")
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise InvalidGeometry(f"{name} is not a scene: it has no [[obstacle]] tables")
    return tuple(_obstacle(entry, f"{name}, obstacle {i + 1}", folder) for i, entry in enumerate(entries))


def _obstacle(entry: dict[str, Any], where: str, folder: Path) -> Obstacle:
    for key in ("name", "shape"):
        if not isinstance(entry.get(key), str):
            raise InvalidGeometry(f"{where}: has no {key}")
    kind, sizes = entry["shape"], {key: value for key, value in entry.items() if key not in KEYS}
    pose = pin.SE3(rpy_matrix(*_vector(entry, "rpy", where)), _vector(entry, "position", where))
    try:
        if kind == "mesh":
            shape: Shape = Mesh.read(folder / sizes.pop("file"), **sizes)
        elif kind in SHAPES:
            shape = SHAPES[kind](**sizes)
        else:
            raise UnknownName("shape", kind, {*SHAPES, "mesh"})
    except (TypeError, KeyError) as error:
        raise InvalidGeometry(f"{where}: the sizes of a {kind} are not {sorted(sizes)} ({error})") from None
    return Obstacle(entry["name"], shape, pose, tuple(entry.get("touching", ())))


def _vector(entry: dict[str, Any], key: str, where: str) -> Any:
    value = np.array(entry.get(key, (0.0, 0.0, 0.0)), dtype=object)
    if value.shape != (3,) or not all(isinstance(number, (int, float)) for number in value):
        raise InvalidGeometry(f"{where}: {key} is three numbers, got {entry[key]!r}")
    return value.astype(float)
