"""Scenes: obstacles in a TOML or JSON file; a few come with the package."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, fields
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.clouds import HeightField, Octree, PointCloud
from pin_metaik.collision.mesh import Mesh, existing_file
from pin_metaik.collision.numbers import three
from pin_metaik.collision.obstacle import Obstacle
from pin_metaik.collision.shapes import Box, Capsule, Cone, Cylinder, HalfSpace, Plane, Shape, Sphere
from pin_metaik.errors import InvalidGeometry, UnknownName
from pin_metaik.files import read_array, read_json
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.lookup import lookup
from pin_metaik.toml import read_toml


class Kind(NamedTuple):
    """A kind of shape as scenes have it.

    Attributes:
        make: What makes the shape, of the values of its keys.
        needed: Keys that must be there.
        known: All its keys. The value of ``file`` is a path relative to the scene's.
    """

    make: Callable[..., Shape]
    needed: tuple[str, ...]
    known: tuple[str, ...]


def _sizes(shape: type[Shape]) -> Kind:
    """A shape whose keys are its own fields."""
    needed = tuple(field.name for field in fields(shape) if field.init and field.default is MISSING)
    return Kind(shape, needed, tuple(field.name for field in fields(shape) if field.init))


def _cloud(shape: Callable[[Any, Any], Shape], size: str) -> Kind:
    """A shape of points, in the scene itself or in a .npy file (k, 3)."""

    def make(points: Any = None, file: Path | None = None, **sizes: Any) -> Shape:
        if (points is None) == (file is None):
            raise InvalidGeometry("its points are in 'points' or in a .npy 'file'")
        return shape(points if file is None else read_points(file), sizes[size])

    return Kind(make, (size,), ("points", "file", size))


def read_points(path: str | Path) -> NDArray[np.float64]:
    """The points (k, 3) in a .npy file.

    Raises:
        InvalidGeometry: If there is no such file, or it holds no array.
    """
    file = existing_file(path, "point cloud")
    return read_array(file, InvalidGeometry, "a .npy file of points")


KINDS: dict[str, Kind] = {
    "box": _sizes(Box),
    "sphere": _sizes(Sphere),
    "cylinder": _sizes(Cylinder),
    "capsule": _sizes(Capsule),
    "cone": _sizes(Cone),
    "halfspace": _sizes(HalfSpace),
    "plane": _sizes(Plane),
    "point_cloud": _cloud(PointCloud, "radius"),
    "octree": _cloud(Octree, "resolution"),
    "height_field": _sizes(HeightField),
    "mesh": Kind(lambda file, scale=1.0: Mesh.read(file, scale), ("file",), ("file", "scale")),
}
KEYS = ("name", "shape", "position", "rpy", "touching", "padding")


def scene_names() -> list[str]:
    """The scenes that come with the package."""
    return sorted(_shipped())


def load_scene(source: str | Path) -> tuple[Obstacle, ...]:
    """The obstacles of a scene, by its name or from a TOML or JSON file.

    Each ``[[obstacle]]`` has a ``name``, a ``shape`` with its sizes in m, a ``position`` in m, perhaps ``rpy`` in rad
    (Rz(yaw) Ry(pitch) Rx(roll)), ``touching``, names that may touch it, and ``padding``, a distance in m that is added
    to the margin, or a table of one for each of some names. A mesh has a ``file``, relative to the
    scene's, and perhaps a ``scale``; a ``point_cloud`` has ``points`` or a .npy ``file``, and a ``radius``; an
    ``octree`` the same with a ``resolution``; a ``height_field`` ``size``, ``heights`` and ``base``.

    Raises:
        UnknownName: If no scene has that name, or the file has a key that is not among these.
        InvalidGeometry: If the file is missing or malformed, or an obstacle makes no sense; the message names it.
    """
    if not isinstance(source, str | Path):
        raise InvalidGeometry(f"a scene is a name or the path of a TOML or JSON file, got {source!r}")
    path = Path(source)
    if isinstance(source, Path) or path.suffix.lower() in READERS or len(path.parts) > 1:
        return _obstacles(_read(path), str(path), path.parent)
    return _obstacles(_read(lookup("scene", source, _shipped())), source, Path())


def _shipped() -> dict[str, Traversable]:
    folder = files("pin_metaik.collision") / "scenes"
    return {entry.name.removesuffix(".toml"): entry for entry in folder.iterdir() if entry.name.endswith(".toml")}


READERS: dict[str, Callable[[Path | Traversable, type[InvalidGeometry]], Any]] = {
    ".toml": read_toml,
    ".json": read_json,
}


def _read(path: Path | Traversable) -> Any:
    suffix = Path(path.name).suffix.lower()
    if suffix not in READERS:
        raise InvalidGeometry(f"cannot read the scene {path}: a scene is a .toml or a .json file")
    return READERS[suffix](path, InvalidGeometry)


def _obstacles(scene: Any, name: str, folder: Path) -> tuple[Obstacle, ...]:
    entries = scene.get("obstacle") if isinstance(scene, Mapping) else None
    if not isinstance(entries, list) or not all(isinstance(entry, Mapping) for entry in entries):
        raise InvalidGeometry(f"{name} is not a scene: it has no [[obstacle]] tables (in JSON a list 'obstacle')")
    _check_keys(scene, ("obstacle",), name)
    return tuple(_obstacle(entry, f"{name}, obstacle {i + 1}", folder) for i, entry in enumerate(entries))


def _obstacle(entry: Mapping[str, Any], where: str, folder: Path) -> Obstacle:
    for key in ("name", "shape"):
        if not isinstance(entry.get(key), str):
            raise InvalidGeometry(f"{where}: its {key} is a text, got {entry.get(key)!r}")
    where = f"{where}, {entry['name']!r}"
    kind = lookup(f"shape of {where},", entry["shape"], KINDS)
    _check_keys(entry, (*KEYS, *kind.known), f"{where}, a {entry['shape']},")
    lacking = [key for key in kind.needed if key not in entry]
    if lacking:
        raise InvalidGeometry(f"{where}: a {entry['shape']} needs {' and '.join(lacking)}")
    values = {key: entry[key] for key in kind.known if key in entry}
    if isinstance(values.get("file"), str):
        values["file"] = folder / values["file"]
    pose = pin.SE3(rpy_matrix(*_three(entry, "rpy", where)), _three(entry, "position", where))
    try:
        return Obstacle(entry["name"], kind.make(**values), pose, entry.get("touching", ()), entry.get("padding", 0.0))
    except InvalidGeometry as error:
        raise InvalidGeometry(f"{where}: {error}") from None


def _check_keys(entry: Mapping[str, Any], known: Iterable[str], where: str) -> None:
    for key in entry:
        if key not in known:
            raise UnknownName(f"key of {where}", key, known)


def _three(entry: Mapping[str, Any], key: str, where: str) -> NDArray[np.float64]:
    numbers = three(entry.get(key, [0.0, 0.0, 0.0]))
    if numbers is None:
        raise InvalidGeometry(f"{where}: {key} is three numbers, got {entry[key]!r}")
    return np.array(numbers)
