"""Obstacles in the scene: added, dragged, taken away, and read from a scene's file."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from pin_metaik.collision import Obstacle, load_scene, scene_names
from pin_metaik.collision.drawing import surface
from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import json_values, read_text
from pin_metaik.gui.look.robot import pose_of, put
from pin_metaik.gui.pages.arms.arm import Scenery
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.toml import toml_values

NODE = f"{ROOT}/obstacles"
WOOD = (184, 135, 89)
SIZES: dict[str, dict[str, Any]] = {
    "box": {"size": [0.2, 0.2, 0.2]},
    "sphere": {"radius": 0.1},
    "cylinder": {"radius": 0.08, "length": 0.3},
    "capsule": {"radius": 0.08, "length": 0.3},
}
NONE = "none"
GIZMO = 0.15  # m
WHERE = [0.5, 0.0, 0.3]  # m, a place in front of most arms


class ObstacleControls:
    """A folder with what stands around, and the gizmos to move it.

    Args:
        tab: The tab.
        scenery: The obstacles.
        changed: Called after every change.
    """

    def __init__(self, tab: Tab, scenery: Scenery, changed: Callable[[], None]) -> None:
        self._tab, self._scenery, self._changed = tab, scenery, changed
        self._nodes: list[Any] = []
        gui = tab.client.gui
        shape = gui.add_dropdown("Shape", tuple(SIZES), hint="Of an obstacle to add.")
        add = gui.add_button("Add an obstacle")
        add.on_click(tab.doing(lambda: self._add({"shape": shape.value, **SIZES[shape.value], "position": WHERE})))
        self._which = gui.add_dropdown("Obstacle", (NONE,), hint="One of those that are there.")
        self._which.on_update(tab.doing(self._show_place))
        self._place = gui.add_vector3("Its x, y, z, m", (0.0, 0.0, 0.0), step=0.001, disabled=True)
        self._place.on_update(tab.doing(self._put))
        self._away = gui.add_button("Take it away", disabled=True)
        self._away.on_click(tab.doing(self._take_away))
        known = gui.add_dropdown("Scene", tuple(scene_names()), hint="Scenes that come with the package.")
        take = gui.add_button("Put up this scene")
        take.on_click(tab.doing(lambda: self._replace(entries_of(known.value), tab.folder)))
        upload = gui.add_upload_button("Open a scene: .toml, .json", mime_type=".toml,.json,.zip")
        upload.on_upload(
            tab.doing(lambda: self._open(tab.received(upload, ".toml", ".json")), "That scene is not taken")
        )
        clear = gui.add_button("Take all away")
        clear.on_click(tab.doing(lambda: self._replace([], tab.folder)))
        save = gui.add_button("Download the scene")
        save.on_click(tab.doing(lambda: tab.download("obstacles.json", scenery.to_json())))
        self.draw()

    def draw(self) -> None:
        """Draw the obstacles, each with a gizmo."""
        scene = self._tab.client.scene
        for node in self._nodes:
            node.remove()
        obstacles = self._scenery.obstacles()
        self._nodes = [self._drawn(scene, number, obstacle) for number, obstacle in enumerate(obstacles)]
        names = tuple(obstacle.name for obstacle in obstacles)
        if names != self._which.options:
            self._which.options = names or (NONE,)
            self._which.value = names[-1] if names else NONE
        self._place.disabled = self._away.disabled = not names
        self._show_place()

    def _drawn(self, scene: Any, number: int, obstacle: Obstacle) -> Any:
        gizmo = scene.add_transform_controls(f"{NODE}/{number}", scale=GIZMO, line_width=2.0, depth_test=False)
        put(gizmo, obstacle.pose)
        vertices, triangles = surface(obstacle.shape.geometry())
        scene.add_mesh_simple(
            f"{NODE}/{number}/shape",
            vertices.astype(np.float32),
            triangles.astype(np.uint32),
            color=WOOD,
            flat_shading=True,
            side="double",
        )
        gizmo.on_update(self._tab.doing(lambda: self._move(number, pose_of(gizmo))))
        return gizmo

    def _move(self, number: int, pose: pin.SE3) -> None:
        entry = self._scenery.entries[number]
        entry["position"] = pose.translation.tolist()
        entry["rpy"] = pin.rpy.matrixToRpy(pose.rotation).tolist()
        self._show_place()
        self._changed()

    @property
    def _number(self) -> int | None:
        """Of the one that is chosen; None where there is none."""
        return self._which.options.index(self._which.value) if self._nodes else None

    def _show_place(self) -> None:
        if self._number is not None:
            x, y, z = self._nodes[self._number].position
            self._place.value = (round(x, 6), round(y, 6), round(z, 6))

    def _put(self) -> None:
        """Move the chosen one to where was typed."""
        if self._number is not None:
            gizmo = self._nodes[self._number]
            gizmo.position = self._place.value
            self._move(self._number, pose_of(gizmo))

    def _take_away(self) -> None:
        if self._number is not None:
            left = [entry for k, entry in enumerate(self._scenery.entries) if k != self._number]
            self._replace(left, self._scenery.folder)

    def _add(self, entry: dict[str, Any]) -> None:
        self._scenery.add(entry)
        self.draw()
        self._changed()

    def _open(self, path: Path) -> None:
        self._replace(entries_in(path), path.parent)

    def _replace(self, entries: list[dict[str, Any]], folder: Path) -> None:
        """Put up other obstacles, if all of them make sense."""
        trial = Scenery(folder, entries)
        trial.obstacles()
        self._scenery.folder, self._scenery.entries[:] = folder, entries
        self.draw()
        self._changed()


def entries_in(path: Path) -> list[dict[str, Any]]:
    """The entries of a scene's file; what is wrong in it is told when obstacles are made of it.

    Raises:
        InvalidGeometry: It is neither TOML nor JSON, or has no list of obstacles.
    """
    values = toml_values if path.suffix.lower() == ".toml" else json_values
    content = values(read_text(path, InvalidGeometry), path.name, InvalidGeometry)
    entries = content.get("obstacle") if isinstance(content, dict) else None
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise InvalidGeometry(f"{path.name} has no list of obstacles: [[obstacle]] above each")
    return entries


def entries_of(name: str) -> list[dict[str, Any]]:
    """The entries of a scene that comes with the package."""
    from importlib.resources import files

    load_scene(name)
    shipped = files("pin_metaik.collision") / "scenes" / f"{name}.toml"
    entries: list[dict[str, Any]] = tomllib.loads(shipped.read_text(encoding="utf-8"))["obstacle"]
    return entries
