"""The page of path planning: a map, its shortest path and others beside it, and the quickest motion along one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from pin_metaik.errors import InvalidGeometry, MetaIKError
from pin_metaik.gui.kept import plain_of, state_of
from pin_metaik.gui.latest import Latest
from pin_metaik.gui.look.map import look_down
from pin_metaik.gui.pages.paths.drawing import MapEditor
from pin_metaik.gui.pages.paths.driving import MotionControls, Paths
from pin_metaik.gui.pages.paths.hand import HandPath
from pin_metaik.gui.pages.paths.rounds import WaysRound
from pin_metaik.gui.pages.paths.search import PathSearch
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.tab import Tab
from pin_metaik.gui.uploads import only_inside
from pin_metaik.gui.words import in_words, told
from pin_metaik.mobile import PathPlan, PathProblem, Scene, load_scene, plan_path, random_scene, scene_names

SHORTEST = (40, 150, 70)


class PathsPage:
    """One map.

    Args:
        tab: The tab.
        values: What the page keeps.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        self._tab = tab
        self._state = state = state_of(PathsState, values, "the page of path planning")
        self._planning = Latest[PathProblem | MetaIKError](self._plan)
        self._closed = False
        self._shortest: PathPlan | None = None
        gui = tab.client.gui
        with gui.add_folder("Map"):
            self._furnish_map(gui)
            self._editor = MapEditor(tab, state.world, self._ask, lambda place: self._hand.append(place))
        drawing = self._editor.map
        with gui.add_folder("Robot"):
            self._radius = gui.add_number("Radius, m", state.radius, min=0.0, step=0.01)
            self._margin = gui.add_number("Margin, m", state.margin, min=0.0, step=0.01)
            for handle in (self._radius, self._margin):
                handle.on_update(tab.doing(self._ask))
        with gui.add_folder("Shortest path"):
            self._exact = gui.add_markdown("")
        with gui.add_folder("Other ways round", expand_by_default=False):
            self._rounds = WaysRound(tab, drawing, state.ways)
        with gui.add_folder("Way by hand", expand_by_default=False):
            self._hand = HandPath(tab, drawing, state.hand)
        with gui.add_folder("Metaheuristic beside it", expand_by_default=False):
            self._search = PathSearch(tab, drawing, state)
        with gui.add_folder("Quickest motion"):
            paths: Paths = {
                "shortest path": lambda: self._shortest,
                "way round": lambda: self._rounds.plan,
                "way by hand": lambda: self._hand.plan,
            }
            self._motion = MotionControls(tab, drawing, state, paths)
        look_down(tab, state.world)
        self._ask()

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        return plain_of(
            replace(
                self._state,
                scene=json.loads(json.dumps(self._editor.world.as_dict())),
                radius=self._radius.value,
                margin=self._margin.value,
                hand=tuple(self._hand.via),
                ways=self._rounds.count,
                **self._search.kept,
                **self._motion.kept,
            )
        )

    def close(self) -> None:
        """See ``Page``."""
        self._closed = True
        self._planning.close()
        self._motion.close()
        self._editor.close()

    # --- the map ---------------------------------------------------------------------------------------------------

    def _furnish_map(self, gui: Any) -> None:
        tab = self._tab
        known = gui.add_dropdown("From the list", tuple(scene_names()))
        take = gui.add_button("Take this map")
        take.on_click(tab.doing(lambda: self._take(load_scene(known.value))))
        count = gui.add_number("Obstacles", 15, min=0, max=500, step=1)
        seed = gui.add_number("Seed of the map", 0, min=0, step=1)
        draw = gui.add_button("Random map")
        draw.on_click(tab.doing(lambda: self._take(random_scene(int(count.value), int(seed.value)))))
        upload = gui.add_upload_button("Open a map: GeoJSON, ROS, scene", mime_type=".json,.geojson,.wkt,.yaml,.zip")
        kinds = (".json", ".geojson", ".wkt", ".yaml", ".yml")
        upload.on_upload(tab.doing(lambda: self._open(tab.received(upload, *kinds)), "That map is not taken"))
        save = gui.add_button("Download the map")
        save.on_click(tab.doing(lambda: tab.download("map.json", json.dumps(self._editor.world.as_dict()))))

    def _open(self, path: Path) -> None:
        if path.suffix.lower() in (".yaml", ".yml"):
            only_inside([_image_of(path)], path.name)
        try:
            world = load_scene(path)
        except InvalidGeometry:  # it may only lack a start and a goal
            world = load_scene(path, self._editor.world.start, self._editor.world.goal)
        self._take(world)

    def _take(self, world: Scene) -> None:
        PathProblem.of(world)
        self._editor.take(world)
        look_down(self._tab, world)

    # --- the shortest path -----------------------------------------------------------------------------------------

    def _ask(self) -> None:
        """Plan anew; what the robot cannot stand in is said where the answer would be."""
        self._shortest = None
        try:
            asked: PathProblem | MetaIKError = PathProblem.of(
                self._editor.world, self._radius.value, self._margin.value
            )
        except MetaIKError as error:
            asked = error
        for part in (self._rounds, self._hand, self._search):
            part.show(None)
        self._planning.ask(asked)

    def _plan(self, asked: PathProblem | MetaIKError) -> None:
        """In the page's own thread: the shortest path, or why there is none."""
        with told(self._tab.client):
            plan: PathPlan | None = None
            try:
                if isinstance(asked, MetaIKError):
                    raise asked
                plan = plan_path(asked)
                words = f"**{plan.status}**: length {plan.length:.6f}, found in {1e3 * plan.seconds:.3g} ms"
            except MetaIKError as error:
                words = f"**None**: {in_words(error)}"
            with self._tab.lock:
                if not self._closed:
                    self._show(None if isinstance(asked, MetaIKError) else asked, plan, words)

    def _show(self, problem: PathProblem | None, plan: PathPlan | None, words: str) -> None:
        self._shortest = plan
        self._exact.content = words
        self._editor.map.lines("shortest", [] if plan is None else [plan.path.points], SHORTEST, 5.0)
        for part in (self._rounds, self._hand, self._search):
            part.show(problem)


def _image_of(path: Path) -> str:
    """The image that a ROS map names; what else is wrong with it is told when it is read."""
    try:
        content = yaml.safe_load(path.read_bytes())
    except (yaml.YAMLError, ValueError, RecursionError) as reason:
        raise InvalidGeometry(f"{path.name} is not YAML: {reason}") from None
    return str(content.get("image", "")) if isinstance(content, dict) else ""
