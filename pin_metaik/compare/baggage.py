"""Robots of one's own travel with a comparison: their files are kept in its folder, to be run again anywhere."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from pin_metaik.compare.suite import Suite
from pin_metaik.errors import InvalidSetting
from pin_metaik.robots import Robot, load_robot
from pin_metaik.robots.library import catalogue, example_robots

ROBOTS = "robots"
MESH = re.compile(r"""<mesh\b[^>]*\bfilename\s*=\s*["']([^"']+)["']""")


def pack(folder: Path, suite: Suite) -> dict[str, str]:
    """Keep the files of the robots that do not come by name.

    Args:
        folder: Of the comparison.
        suite: What is compared; meshes are kept, too, if a case of it has a world.

    Returns:
        Paths in the folder by the robots' names.

    Raises:
        InvalidSetting: The folder has rows of another robot of that name.
    """
    worlds = any(case.world is not None for case in suite.tasks.values())
    packed = {}
    for number, (name, spec) in enumerate(suite.arms.items()):
        if spec in catalogue() or spec in example_robots():
            continue
        robot = load_robot(spec)
        table = robot.source.suffix.lower() == ".toml"
        content = robot.source.read_bytes() if table else robot.urdf.encode()
        stem = re.sub(r"[^\w.-]", "_", name) or f"robot_{number}"
        path = folder / ROBOTS / f"{stem}{'.toml' if table else '.urdf'}"
        if path.exists() and path.read_bytes() != content:
            raise InvalidSetting(f"{folder} has rows of another {name!r}, kept in {path}: choose another folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        if worlds:
            _pack_meshes(robot, path.parent)
        packed[name] = path.relative_to(folder).as_posix()
    return packed


def _pack_meshes(robot: Robot, folder: Path) -> None:
    """Keep the meshes of the collision geometry where the robot's file, in the same folder, says that they are.

    A mesh with an absolute path is not kept, nor one far above the robot's file.
    """
    found = {Path(piece.meshPath).as_posix() for piece in robot.collision_model.geometryObjects if piece.meshPath}
    for written in set(MESH.findall(robot.urdf)):
        tail = os.path.normpath(re.sub(r"^\w+://", "", written))
        copy = Path(os.path.normpath(folder / tail))
        source = next((path for path in found if path.endswith("/" + tail.lstrip("./"))), None)
        if source is not None and not Path(tail).is_absolute() and copy.is_relative_to(folder.parent):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, copy)
