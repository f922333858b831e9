"""Copies of the files of users' own robots in the folder of a comparison, so that it can be run again anywhere."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from pin_metaik.compare.trials.suite import Suite
from pin_metaik.errors import InvalidSetting
from pin_metaik.output import replaced
from pin_metaik.robots import Robot, load_robot
from pin_metaik.robots.library import catalogue, example_robots

ROBOTS = "robots"
MESH = re.compile(r"""<mesh\b[^>]*\bfilename\s*=\s*["']([^"']+)["']""")


def copy_robots(folder: Path, suite: Suite) -> dict[str, str]:
    """Keep the files of the robots that do not come by name.

    Args:
        folder: Of the comparison.
        suite: The comparison; meshes are copied, too, if one of its cases has a world.

    Returns:
        Paths in the folder by the robots' names.

    Raises:
        InvalidSetting: The folder has rows of another robot of that name.
    """
    worlds = any(case.world is not None for case in suite.cases_by_name.values())
    copied = {}
    for number, (name, spec) in enumerate(suite.robots_by_name.items()):
        if spec in catalogue() or spec in example_robots():
            continue
        robot = load_robot(spec)
        source = robot.source if robot.source is not None and robot.source.suffix.lower() == ".toml" else None
        content = robot.urdf.encode() if source is None else source.read_bytes()
        stem = re.sub(r"[^\w.-]", "_", name) or f"robot_{number}"
        path = folder / ROBOTS / f"{stem}{'.urdf' if source is None else '.toml'}"
        if path.exists() and path.read_bytes() != content:
            raise InvalidSetting(f"{folder} has rows of another {name!r}, kept in {path}: choose another folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        with replaced(path) as partial:
            partial.write_bytes(content)
        if worlds:
            _copy_meshes(robot, path.parent)
        copied[name] = path.relative_to(folder).as_posix()
    return copied


def _copy_meshes(robot: Robot, folder: Path) -> None:
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
