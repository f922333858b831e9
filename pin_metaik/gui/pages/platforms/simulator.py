"""The simulator: a pose, the legs there, all assemblies of leg lengths, the workspace, and a motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, floor
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import InvalidConfiguration
from pin_metaik.gui.forms import fine
from pin_metaik.gui.look import scale
from pin_metaik.gui.look.curves import CurvePlot
from pin_metaik.gui.look.platform import PlatformDrawing
from pin_metaik.gui.look.player import Player
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.processes import Run, Told
from pin_metaik.stewart import (
    Assemblies,
    Mechanism,
    Motion,
    Trajectory,
    Workspace,
    all_forward,
    follow,
    inverse,
    pose_at,
    read_trajectory,
    singularities,
    straight,
)
from pin_metaik.stewart.kinematics.forward import level
from pin_metaik.stewart.show.report import along, assess, at_pose
from pin_metaik.watching import Watch

RED = (217, 31, 26)
TILT = 0.8  # rad, as far as the sliders go
SECONDS = 2.0  # of a straight motion

Pose = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Surveying:
    """A survey in another process.

    Attributes:
        mechanism: Of what.
    """

    mechanism: Mechanism

    def __call__(self, watch: Watch) -> Workspace:
        """Survey it."""
        return self.mechanism.survey(watch=watch)


def home_of(mechanism: Mechanism) -> Pose:
    """A level pose in which legs are about half extended."""
    geometry = mechanism.geometry
    halfway = np.full((1, geometry.n), 0.5 * sum(mechanism.limits.span))
    return np.asarray(level(geometry, halfway)[0])


class Simulator:
    """What shows one mechanism.

    Args:
        tab: The tab.
        mechanism: The mechanism.
        pose: Where its platform is at first (4, 4).
    """

    def __init__(self, tab: Tab, mechanism: Mechanism, pose: Pose) -> None:
        self._tab, self._mechanism = tab, mechanism
        self._drawing = PlatformDrawing(tab, f"{ROOT}/platform", mechanism)
        self._ghost: PlatformDrawing | None = None
        self._assemblies: Assemblies | None = None
        self._motion: Motion | None = None
        gui = tab.client.gui
        with gui.add_folder("Pose"):
            self._furnish_pose(gui, pose)
        with gui.add_folder("Forward kinematics", expand_by_default=False):
            self._furnish_forward(gui, pose)
        with gui.add_folder("Workspace", expand_by_default=False):
            self._furnish_workspace(gui)
        with gui.add_folder("Motion", expand_by_default=False):
            self._furnish_motion(gui)
        self._show()

    @property
    def pose(self) -> Pose:
        """Where the platform is (4, 4)."""
        return pose_at(self.xyz, self.rpy)

    @property
    def xyz(self) -> tuple[float, float, float]:
        """Where P is, m."""
        x, y, z = (handle.value for handle in self._sliders[:3])
        return x, y, z

    @property
    def rpy(self) -> tuple[float, float, float]:
        """Roll, pitch and yaw, rad."""
        roll, pitch, yaw = (handle.value for handle in self._sliders[3:])
        return roll, pitch, yaw

    def close(self) -> None:
        """End its motion."""
        self._player.close()

    # --- the pose --------------------------------------------------------------------------------------------------

    def _furnish_pose(self, gui: Any, pose: Pose) -> None:
        reach = float(self._drawing.size)
        home = home_of(self._mechanism)[:3, 3]
        self._sliders = []
        turns = pin.rpy.matrixToRpy(pose[:3, :3])
        for number, name in enumerate(("x, m", "y, m", "z, m", "roll, rad", "pitch, rad", "yaw, rad")):
            value = float(pose[number, 3] if number < 3 else turns[number - 3])
            low, high = (home[number] - reach, home[number] + reach) if number < 3 else (-TILT, TILT)
            low, high = min(low, value), max(high, value)
            step, decimals = fine(low, high)
            low, high = (round(edge(end / step) * step, decimals) for edge, end in ((floor, low), (ceil, high)))
            handle = gui.add_slider(name, min=low, max=high, step=step, initial_value=round(value, decimals))
            handle.value = value  # all of its digits: only what is shown is rounded
            handle.on_update(self._tab.doing(self._show))
            self._sliders.append(handle)
        level_it = gui.add_button("Back to the middle")
        level_it.on_click(self._tab.doing(lambda: self._go(home_of(self._mechanism))))
        self._words = gui.add_markdown("")

    def _go(self, pose: Pose) -> None:
        """Put the sliders at a pose."""
        turns = pin.rpy.matrixToRpy(pose[:3, :3])
        for handle, value in zip(self._sliders, (*pose[:3, 3], *turns), strict=True):
            handle.min, handle.max = min(handle.min, float(value)), max(handle.max, float(value))
            handle.value = float(value)
        self._show()

    def _show(self) -> None:
        pose = self.pose
        with self._tab.client.atomic():
            self._drawing.show(pose)
            rows = [(name, value) for name, value in at_pose(self._mechanism, pose) if value and "Jacobian" not in name]
            self._words.content = _table([row for row in rows if not row[1].startswith("leg ")])

    # --- assemblies ------------------------------------------------------------------------------------------------

    def _furnish_forward(self, gui: Any, pose: Pose) -> None:
        shown = self._mechanism.coordinate
        q = inverse(self._mechanism.geometry, pose).coordinates.ravel() / shown.one
        self._coordinates = gui.add_text(f"Legs, {shown.unit}", ", ".join(f"{value:.6g}" for value in q))
        find = gui.add_button("Find all assemblies")
        find.on_click(self._tab.doing(self._find))
        self._which = gui.add_slider("Assembly", min=0, max=1, step=1, initial_value=0, disabled=True)
        self._which.on_update(self._tab.doing(self._show_assembly))
        take = gui.add_button("Go there")
        take.on_click(self._tab.doing(self._go_there))
        self._forward_words = gui.add_markdown("")

    def _find(self) -> None:
        try:
            q = [float(part) for part in self._coordinates.value.split(",")]
        except ValueError:
            raise InvalidConfiguration("coordinates of legs are numbers with commas between them") from None
        found = all_forward(self._mechanism.geometry, np.array(q) * self._mechanism.coordinate.one)
        self._assemblies = found
        proved = "proved to be all" if found.complete else "perhaps not all"
        self._forward_words.content = f"{len(found)} assemblies, {proved}; {found.solutions} real and complex"
        self._which.disabled, self._which.max = len(found) < 2, max(1, len(found) - 1)
        self._which.value = 0
        self._show_assembly()

    def _show_assembly(self) -> None:
        if self._assemblies is None or not len(self._assemblies):
            return
        if self._ghost is None:
            self._ghost = PlatformDrawing(self._tab, f"{ROOT}/assembly", self._mechanism, ghost=True)
        self._ghost.show(self._chosen())

    def _chosen(self) -> Pose:
        assert self._assemblies is not None
        return np.asarray(self._assemblies[min(int(self._which.value), len(self._assemblies) - 1)])

    def _go_there(self) -> None:
        if self._assemblies is not None and len(self._assemblies):
            self._go(self._chosen())

    # --- workspace -------------------------------------------------------------------------------------------------

    def _furnish_workspace(self, gui: Any) -> None:
        cells = gui.add_number("Cells along an axis", 24, min=4, max=120, step=1)
        survey = gui.add_button("Survey")
        survey.on_click(self._tab.doing(lambda: self._survey(int(cells.value))))
        scale.legend(gui, "local dexterity nu, no unit", "singular", "isotropic")
        self._survey_words = gui.add_markdown("")

    def _survey(self, cells: int) -> None:
        mechanism = replace(self._mechanism, grid=replace(self._mechanism.grid, counts=(cells,) * 3))
        self._survey_words.content = "waits for a process"
        self._tab.begin(Surveying(mechanism), self._tell, self._surveyed)

    def _tell(self, told: Told) -> None:
        self._survey_words.content = f"{told.progress.done:,.0f} of {told.progress.total:,.0f}"

    def _surveyed(self, run: Run) -> None:
        if run.result is None:
            return
        workspace: Workspace = run.result
        index = np.argwhere(workspace.reached.any(axis=-1))
        colours = scale.colours(workspace.nu.max(axis=-1)[tuple(index.T)])
        scene = self._tab.client.scene
        points = workspace.position_of(index).astype(np.float32)
        size = 0.25 * float(workspace.cells.volume) ** (1.0 / 3.0)
        scene.add_point_cloud(f"{ROOT}/workspace", points, colours, point_size=size, point_shape="circle")
        found = singularities(workspace)
        singular = np.concatenate([found.poses, found.crossings])[:, :3, 3].astype(np.float32)
        scene.add_point_cloud(f"{ROOT}/singular", singular, RED, point_size=1.5 * size, point_shape="diamond")
        self._survey_words.content = _table(assess(self._mechanism, workspace))

    # --- motion ----------------------------------------------------------------------------------------------------

    def _furnish_motion(self, gui: Any) -> None:
        tab = self._tab
        go = gui.add_button("Straight to this pose", hint="From the middle to where the sliders are.")
        go.on_click(tab.doing(lambda: self._move(straight(home_of(self._mechanism), self.pose, SECONDS))))
        upload = gui.add_upload_button("Open a way: .csv", mime_type=".csv")
        upload.on_upload(
            tab.doing(
                lambda: self._move(read_trajectory(tab.received(upload, ".csv"), self._mechanism.metres)),
                "That way is not taken",
            )
        )
        self._player = Player(tab, self._show_moment)
        shown = self._mechanism.coordinate
        self._curves = CurvePlot(gui, "time, s", f"legs, {shown.unit}", height=190)
        self._motion_words = gui.add_markdown("")

    def _move(self, way: Trajectory) -> None:
        mechanism = self._mechanism
        motion = follow(mechanism.geometry, way, mechanism.limits, mechanism.dexterity)
        self._motion = motion
        one, times = mechanism.coordinate.one, way.times - way.times[0]
        self._curves.show({f"leg {k}": (times, column / one) for k, column in enumerate(motion.coordinates.T, start=1)})
        self._motion_words.content = _table(along(mechanism, way))
        self._player.take(float(times[-1]))

    def _show_moment(self, seconds: float) -> None:
        if self._motion is not None:
            way = self._motion.trajectory
            self._drawing.show(np.asarray(way.at([way.times[0] + seconds])[0]))


def _table(rows: list[tuple[str, str]]) -> str:
    return "| | |\n|---|---|\n" + "\n".join(f"| {name} | {value} |" for name, value in rows)
