"""The page of path planning: a map, its shortest path, a metaheuristic's, and the quickest motion along the first."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import yaml

from pin_metaik.errors import InvalidGeometry, MetaIKError
from pin_metaik.gui.kept import plain_of, state_of
from pin_metaik.gui.latest import Latest
from pin_metaik.gui.look.curves import CurvePlot
from pin_metaik.gui.look.map import look_down
from pin_metaik.gui.look.player import Player
from pin_metaik.gui.pages.algorithms import AlgorithmForm, population
from pin_metaik.gui.pages.heuristics.tasks import PathTask
from pin_metaik.gui.pages.paths.drawing import MapEditor
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.gui.uploads import only_inside
from pin_metaik.gui.words import in_words, told
from pin_metaik.mobile import (
    FITNESSES,
    VEHICLES,
    PathPlan,
    PathProblem,
    Scene,
    TrajectoryPlan,
    load_scene,
    plan_path,
    plan_trajectory,
    random_scene,
    scene_names,
)
from pin_metaik.processes import Run, Told
from pin_metaik.watching import Watch

SHORTEST, SEARCHED, SWARM, ROBOT = (40, 150, 70), (210, 70, 50), (60, 120, 210), (30, 90, 160)
SAMPLE = 0.02  # s, of the curves of a motion


class Driving:
    """A motion along the shortest path, planned in another process.

    Args:
        problem: The map and the robot.
        vehicle: Name of whose limits it keeps.
    """

    def __init__(self, problem: PathProblem, vehicle: str) -> None:
        self.scene, self.clearance, self.vehicle = problem.scene, problem.space.clearance, vehicle

    def __call__(self, watch: Watch) -> TrajectoryPlan:
        """Plan it."""
        path = plan_path(PathProblem.of(self.scene, self.clearance)).path
        return plan_trajectory(path, VEHICLES[self.vehicle], self.scene.obstacles, watch=watch)


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
        self._problem: PathProblem | None = None
        self._run: Run | None = None
        self._motion: TrajectoryPlan | None = None
        gui = tab.client.gui
        with gui.add_folder("Map"):
            self._furnish_map(gui)
            self._editor = MapEditor(tab, state.world, self._map_changed)
        with gui.add_folder("Robot"):
            self._radius = gui.add_number("Radius, m", state.radius, min=0.0, step=0.01)
            self._margin = gui.add_number("Margin, m", state.margin, min=0.0, step=0.01)
            for handle in (self._radius, self._margin):
                handle.on_update(tab.doing(self._ask))
        with gui.add_folder("Shortest path"):
            self._exact = gui.add_markdown("")
        with gui.add_folder("Metaheuristic beside it", expand_by_default=False):
            self._furnish_search(gui)
        with gui.add_folder("Quickest motion along the shortest path"):
            self._furnish_motion(gui)
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
                algorithm=self._form.name,
                settings=self._form.changed,
                via=int(self._via.value),
                fitness=self._fitness.value,
                penalty=self._penalty.value,
                iterations=int(self._iterations.value),
                seed=int(self._seed.value),
                vehicle=self._vehicle.value,
            )
        )

    def close(self) -> None:
        """See ``Page``."""
        self._closed = True
        self._planning.close()
        self._player.close()
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

    def _map_changed(self, world: Scene) -> None:
        self._editor.map.clear("swarm")
        self._editor.map.clear("searched")
        self._ask()

    # --- the shortest path -----------------------------------------------------------------------------------------

    def _ask(self) -> None:
        """Plan anew; what the robot cannot stand in is said where the answer would be."""
        self._problem = None
        try:
            asked: PathProblem | MetaIKError = PathProblem.of(
                self._editor.world, self._radius.value, self._margin.value
            )
        except MetaIKError as error:
            asked = error
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
                    self._problem = None if plan is None or isinstance(asked, MetaIKError) else asked
                    self._exact.content = words
                    if plan is None:
                        self._editor.map.clear("shortest")
                    else:
                        self._editor.map.path("shortest", plan.path.points, SHORTEST, 5.0)

    # --- a metaheuristic beside it ---------------------------------------------------------------------------------

    def _furnish_search(self, gui: Any) -> None:
        tab, state = self._tab, self._state
        self._form = AlgorithmForm(tab, "Algorithm", state.algorithm, state.settings, expanded=False)
        self._via = gui.add_number("Via points", state.via, min=1, step=1)
        self._fitness = gui.add_dropdown("Objective", tuple(FITNESSES), initial_value=state.fitness)
        self._penalty = gui.add_number("Penalty, widths", state.penalty, min=0.0, step=0.1)
        self._iterations = gui.add_number("Iterations", state.iterations, min=1, step=1)
        self._seed = gui.add_number("Seed", state.seed, min=0, step=1)
        search = gui.add_button("Search")
        search.on_click(tab.doing(self._search))
        stop = gui.add_button("Stop")
        stop.on_click(tab.doing(lambda: self._run.stop() if self._run is not None else None))
        self._found = gui.add_markdown("")

    def _search(self) -> None:
        if self._run is not None:
            self._run.stop()
        algorithm = self._form.algorithm
        evaluations = int(self._iterations.value) * population(algorithm)
        task = PathTask(
            self._editor.world,
            self._radius.value + self._margin.value,
            algorithm,
            self._fitness.value,
            self._penalty.value,
            int(self._via.value),
            evaluations,
            int(self._seed.value),
        )
        self._found.content = "waits for a process"
        self._run = self._tab.begin(task, self._tell, partial(self._searched, task))

    def _tell(self, told: Told) -> None:
        at = told.progress
        if at.population is not None and self._problem is not None:
            ways = [self._problem.through(x).points for x in at.population.X[:100]]
            self._editor.map.lines("swarm", ways, SWARM, 1.0)
        self._found.content = f"{at.done:,.0f} of {at.total:,.0f} paths, best {at.best:.6g}"

    def _searched(self, task: PathTask, run: Run) -> None:
        if run.result is None:
            return
        ended = task.outcome(run.result)
        self._editor.map.path("searched", run.result.path.points, SEARCHED, 5.0)
        self._found.content = (
            f"**{ended.status}**: objective {ended.cost:.6f}; {ended.words}; {ended.evaluations:,} paths in "
            f"{ended.seconds:.3g} s"
        )

    # --- a motion --------------------------------------------------------------------------------------------------

    def _furnish_motion(self, gui: Any) -> None:
        tab = self._tab
        self._vehicle = gui.add_dropdown("Vehicle", tuple(VEHICLES), initial_value=self._state.vehicle)
        drive = gui.add_button("Plan a motion")
        drive.on_click(tab.doing(self._drive))
        self._motion_words = gui.add_markdown("")
        self._player = Player(tab, self._show_moment)
        self._speeds = CurvePlot(gui, "time, s", "speed, m/s", height=170)
        self._turns = CurvePlot(gui, "time, s", "turning, rad/s", height=170)
        self._robot: Any = None

    def _drive(self) -> None:
        if self._problem is None:
            raise InvalidGeometry("there is no path to drive along")
        self._motion_words.content = "waits for a process"
        self._tab.begin(Driving(self._problem, self._vehicle.value), lambda told: None, self._driven)

    def _driven(self, run: Run) -> None:
        if run.result is None:
            return
        plan: TrajectoryPlan = run.result
        self._motion = plan
        free = "keeps clear" if plan.collision_free else "does not keep clear"
        self._motion_words.content = (
            f"{plan.time:.6f} s, {plan.stop_and_turn:.4g} s with a stop at every corner; {free}\n\n"
            + "\n".join(f"- {note}" for note in plan.notes)
        )
        samples = plan.trajectory.sample(SAMPLE)
        self._speeds.show({"speed": (samples.t, samples.v)})
        self._turns.show({"turning": (samples.t, samples.omega)})
        scene, radius = self._tab.client.scene, VEHICLES[self._vehicle.value].radius
        self._robot = scene.add_cylinder(f"{ROOT}/robot", max(radius, 1e-3), 0.3 * max(radius, 0.05), color=ROBOT)
        self._editor.map.path("driven", samples.xy, ROBOT, 2.0)
        self._player.take(plan.time)

    def _show_moment(self, seconds: float) -> None:
        if self._motion is None or self._robot is None:
            return
        at = self._motion.trajectory.at([min(seconds, self._motion.time)])
        half = 0.5 * float(at.heading[0])
        self._robot.position = (float(at.x[0]), float(at.y[0]), 0.2)
        self._robot.wxyz = (math.cos(half), 0.0, 0.0, math.sin(half))


def _image_of(path: Path) -> str:
    """The image that a ROS map names; what else is wrong with it is told when it is read."""
    try:
        content = yaml.safe_load(path.read_bytes())
    except (yaml.YAMLError, ValueError, RecursionError) as reason:
        raise InvalidGeometry(f"{path.name} is not YAML: {reason}") from None
    return str(content.get("image", "")) if isinstance(content, dict) else ""
