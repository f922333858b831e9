"""The quickest motion along a path: planned in a process, played by a robot on the map."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, get_args

import shapely

from pin_metaik.errors import InvalidGeometry
from pin_metaik.gui.look.curves import CurvePlot
from pin_metaik.gui.look.map import MapDrawing
from pin_metaik.gui.look.player import Player
from pin_metaik.gui.pages.paths.state import PathsState
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.mobile import VEHICLES, Path, PathPlan, TrajectoryPlan, plan_trajectory
from pin_metaik.mobile.motion.result import Method
from pin_metaik.processes import Run
from pin_metaik.watching import Watch

ROBOT = (30, 90, 160)
SAMPLE = 0.02  # s, of the curves of a motion
EXACT = "dp"

Paths = Mapping[str, Callable[[], PathPlan | None]]
"""What can be driven along, by name, and where it is."""


@dataclass(frozen=True, eq=False)
class Driving:
    """A motion along a path, planned in another process.

    Attributes:
        path: The path.
        obstacles: What it keeps clear of.
        vehicle: Name of whose limits it keeps.
        speeds: How its speeds are found.
    """

    path: Path
    obstacles: tuple[shapely.Geometry, ...]
    vehicle: str
    speeds: Method

    def __call__(self, watch: Watch) -> tuple[TrajectoryPlan, TrajectoryPlan]:
        """Plan it; and the one with the best speeds, to compare with."""
        robot = VEHICLES[self.vehicle]
        best = plan_trajectory(self.path, robot, self.obstacles, watch=watch)
        if self.speeds == EXACT:
            return best, best
        return plan_trajectory(self.path, robot, self.obstacles, method=self.speeds, watch=watch), best


class MotionControls:
    """Controls that plan a motion and play it.

    Args:
        tab: The tab.
        drawing: The map.
        state: What is chosen at first.
        paths: What can be driven along.
    """

    def __init__(self, tab: Tab, drawing: MapDrawing, state: PathsState, paths: Paths) -> None:
        self._tab, self._map, self._paths = tab, drawing, paths
        self._motion: TrajectoryPlan | None = None
        self._robot: Any = None
        gui = tab.client.gui
        self._along = gui.add_dropdown("Along", tuple(paths))
        self._vehicle = gui.add_dropdown("Vehicle", tuple(VEHICLES), initial_value=state.vehicle)
        self._speeds = gui.add_dropdown(
            "Speeds by",
            get_args(Method),
            initial_value=state.speeds,
            hint="dp: the best ones; de: searched; ann: searched with tangent lengths that a network has learned.",
        )
        drive = gui.add_button("Plan a motion")
        drive.on_click(tab.doing(self._drive))
        self._words = gui.add_markdown("")
        self._player = Player(tab, self._show_moment)
        self._speed_plot = CurvePlot(gui, "time, s", "speed, m/s", height=170)
        self._turn_plot = CurvePlot(gui, "time, s", "turning, rad/s", height=170)

    @property
    def kept(self) -> dict[str, Any]:
        """What is chosen, by fields of the page's state."""
        return {"vehicle": self._vehicle.value, "speeds": self._speeds.value}

    def close(self) -> None:
        """Hold the robot."""
        self._player.close()

    def _drive(self) -> None:
        plan = self._paths[self._along.value]()
        if plan is None or not plan.collision_free:
            free = "; ".join(name for name, path in self._paths.items() if (there := path()) and there.collision_free)
            raise InvalidGeometry(f"{self._along.value}: there is none that is free; there is: {free or 'nothing'}")
        self._words.content = "waits for a process"
        task = Driving(plan.path, plan.problem.scene.obstacles, self._vehicle.value, self._speeds.value)
        self._tab.begin(task, lambda told: None, self._driven)

    def _driven(self, run: Run) -> None:
        if run.result is None:
            return
        plan, best = run.result
        self._motion = plan
        free = "keeps clear" if plan.collision_free else "does not keep clear"
        longer = f", {100 * (plan.time / best.time - 1):+.3f} % against the best speeds" if plan is not best else ""
        self._words.content = (
            f"{plan.time:.6f} s{longer}; {plan.stop_and_turn:.4g} s with a stop at every corner; {free}\n\n"
            + "\n".join(f"- {note}" for note in plan.notes)
        )
        samples = plan.trajectory.sample(SAMPLE)
        self._speed_plot.show({"speed": (samples.t, samples.v)})
        self._turn_plot.show({"turning": (samples.t, samples.omega)})
        scene, radius = self._tab.client.scene, VEHICLES[self._vehicle.value].radius
        self._robot = scene.add_cylinder(f"{ROOT}/robot", max(radius, 1e-3), 0.3 * max(radius, 0.05), color=ROBOT)
        self._map.path("driven", samples.xy, ROBOT, 2.0)
        self._player.take(plan.time)

    def _show_moment(self, seconds: float) -> None:
        if self._motion is None or self._robot is None:
            return
        at = self._motion.trajectory.at([min(seconds, self._motion.time)])
        half = 0.5 * float(at.heading[0])
        self._robot.position = (float(at.x[0]), float(at.y[0]), 0.2)
        self._robot.wxyz = (math.cos(half), 0.0, 0.0, math.sin(half))
