"""The robot of the page, read through the library's own gates, and what it stands among."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from pin_metaik.collision import CollisionWorld, Obstacle, load_scene
from pin_metaik.errors import InvalidModel
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.uploads import only_inside
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot, load_robot
from pin_metaik.robots.library import catalogue, example_robots
from pin_metaik.robots.macros import is_xacro
from pin_metaik.robots.text import read_text

FILES = re.compile(r"""\bfile(?:name)?\s*=\s*["']([^"']*)["']""")
KEPT = 12  # robots by name that all tabs share


@dataclass(frozen=True, eq=False)
class Arm:
    """A robot, the chain to its tip, and the Python that makes them.

    Attributes:
        robot: The robot.
        chain: The chain to its default tip.
        code: Lines of Python that load it.
    """

    robot: Robot
    chain: Chain
    code: str

    @staticmethod
    def of(state: ArmsState, folder: Path) -> Arm:
        """The arm of a state; files are written to the folder.

        Raises:
            MetaIKError: No such robot, or a table or URDF that makes no sense.
        """
        if state.table:
            path = folder / "table.toml"
            path.write_text(state.table, encoding="utf-8")
            robot, code = load_robot(path), 'robot = mik.load_robot("table.toml")'
        elif state.urdf:
            path = folder / "robot.urdf"
            path.write_text(state.urdf, encoding="utf-8")
            only_plain(path)
            robot, code = load_robot(path), 'robot = mik.load_robot("robot.urdf")'
            only_inside(FILES.findall(robot.urdf), robot.name)
        elif state.parameters:
            robot = load_robot(state.robot, parameters=state.parameters)
            code = f"robot = mik.load_robot({state.robot!r}, parameters={dict(state.parameters)})"
        else:
            return named(state.robot)
        return Arm(robot, Chain(robot.model, robot.frame), code)

    def world(self, obstacles: Iterable[Obstacle]) -> CollisionWorld:
        """The robot among obstacles.

        Raises:
            MetaIKError: Its geometry cannot be read, or an obstacle makes no sense.
        """
        return CollisionWorld(self.robot, obstacles)


def only_plain(path: Path) -> None:
    """Make sure that a URDF is none that runs something when it is read.

    Raises:
        InvalidModel: It is xacro, whose expressions are Python, and whose includes are any files.
    """
    if is_xacro(read_text(path), path.name):
        raise InvalidModel("this is xacro, whose expressions are Python: expand it first, with the command `xacro`")


@lru_cache(KEPT)
def named(name: str) -> Arm:
    """A robot by its name, the same for all tabs."""
    robot = load_robot(name)
    return Arm(robot, Chain(robot.model, robot.frame), f"robot = mik.load_robot({name!r})")


def names() -> tuple[str, ...]:
    """The robots that can be loaded by name, the catalogue first."""
    return (*catalogue(), *example_robots())


@dataclass
class Scenery:
    """The obstacles of the page as the entries of a scene's file.

    Attributes:
        folder: Where files are that entries name.
        entries: The obstacles.
    """

    folder: Path
    entries: list[dict[str, Any]] = field(default_factory=list)

    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles.

        Raises:
            MetaIKError: An entry makes no sense, or names a file outside of the folder.
        """
        if not self.entries:
            return ()
        for entry in self.entries:
            if "file" in entry:
                only_inside([str(entry["file"])], str(entry.get("name", "an obstacle")))
        path = self.folder / "obstacles.json"
        path.write_text(self.to_json(), encoding="utf-8")
        return load_scene(path)

    def to_json(self) -> str:
        """The obstacles as a scene's JSON file."""
        return json.dumps({"obstacle": self.entries}, indent=1)

    def add(self, entry: Mapping[str, Any]) -> None:
        """Add an obstacle, under a name that no other has.

        Raises:
            MetaIKError: It makes no sense; then it is not added.
        """
        taken = {one.get("name") for one in self.entries}
        base = str(entry.get("name", entry.get("shape", "obstacle")))
        name = next(name for name in (base, *(f"{base}_{k}" for k in range(2, len(taken) + 3))) if name not in taken)
        before = list(self.entries)
        self.entries.append({**entry, "name": name})
        try:
            self.obstacles()
        except Exception:
            self.entries[:] = before
            raise
