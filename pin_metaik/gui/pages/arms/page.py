"""The page of arms: it puts the parts together and keeps the robot where the answers say."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import InvalidConfiguration, InvalidModel
from pin_metaik.gui.kept import plain_of, state_of
from pin_metaik.gui.latest import Latest
from pin_metaik.gui.look.camera import aim
from pin_metaik.gui.look.robot import RobotDrawing, pose_of, put
from pin_metaik.gui.pages.arms import arm as arms
from pin_metaik.gui.pages.arms.gaps import GapLines
from pin_metaik.gui.pages.arms.joints import JointSliders
from pin_metaik.gui.pages.arms.obstacles import ObstacleControls
from pin_metaik.gui.pages.arms.solving import Answer, Question, all_answers, answered, code_of, target_of
from pin_metaik.gui.pages.arms.source import SourceControls
from pin_metaik.gui.pages.arms.state import ArmsState
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.gui.words import in_words, say, told
from pin_metaik.ik import IKSolutions

GHOST, OTHERS = (120, 160, 210), (150, 150, 160)


class ArmsPage:
    """One robot, one target.

    Args:
        tab: The tab.
        values: What the page keeps.
    """

    def __init__(self, tab: Tab, values: Mapping[str, Any]) -> None:
        self._tab = tab
        self._state = state_of(ArmsState, values, "the page of arms")
        self._scenery = arms.Scenery(tab.folder, [dict(entry) for entry in self._state.obstacles])
        self._asking = Latest[Question](self._solve)
        self._collecting = Latest[Question](self._collect)
        self._closed = False
        self._answer: Answer | None = None
        self._ghosts: list[RobotDrawing] = []
        self._solutions: IKSolutions | None = None
        gui = tab.client.gui
        with gui.add_folder("Robot"):
            self._source = SourceControls(tab, self._state, self._take)
        with gui.add_folder("Answer"):
            self._words = gui.add_markdown("Drag the target.")
        with gui.add_folder("Target"):
            self._furnish_target(gui)
        with gui.add_folder("All solutions", expand_by_default=False):
            self._furnish_solutions(gui)
        self._sliders_folder = gui.add_folder("Joints", expand_by_default=False)
        self._sliders: JointSliders | None = None
        self._sliders_box: Any = None
        with gui.add_folder("Obstacles", expand_by_default=False):
            self._avoid = gui.add_checkbox("Avoid collisions", self._state.avoid, hint="With itself and obstacles.")
            self._avoid.on_update(tab.doing(self._world_changed))
            self._obstacles = ObstacleControls(tab, self._scenery, self._world_changed)
        with gui.add_folder("Code", expand_by_default=False):
            self._code = gui.add_markdown("")
        tab.client.scene.add_grid(f"{ROOT}/ground", width=6.0, height=6.0, cell_size=0.5, plane="xy")
        self._gaps = GapLines(tab)
        self._gizmo: Any = None
        self._robot: RobotDrawing | None = None
        self._last_good: RobotDrawing | None = None
        self._world: Any = None
        self._put_up(arms.Arm.of(self._state, tab.folder), self._state)

    def kept(self) -> dict[str, Any]:
        """See ``Page``."""
        pose = pin.SE3ToXYZQUAT(pose_of(self._gizmo))
        return plain_of(
            replace(
                self._state,
                target=tuple(map(float, pose)),
                q=tuple(map(float, self._q)),
                obstacles=tuple(self._scenery.entries),
                orientation=self._orientation.value,
                avoid=self._avoid.value,
            )
        )

    def close(self) -> None:
        """See ``Page``."""
        self._closed = True
        self._asking.close()
        self._collecting.close()

    def _furnish_target(self, gui: Any) -> None:
        tab = self._tab
        self._orientation = gui.add_checkbox("Orientation counts", self._state.orientation)
        self._orientation.on_update(tab.doing(self._ask))
        self._position = gui.add_vector3("x, y, z, m", (0.0, 0.0, 0.0), step=0.001)
        self._position.on_update(tab.doing(self._typed))
        self._rpy = gui.add_vector3("roll, pitch, yaw, rad", (0.0, 0.0, 0.0), step=0.001)
        self._rpy.on_update(tab.doing(self._typed))
        home = gui.add_button("Target to the tip", hint="Put the target where the robot's tip is.")
        home.on_click(tab.doing(self._target_to_tip))

    def _furnish_solutions(self, gui: Any) -> None:
        tab = self._tab
        find = gui.add_button("Find all")
        find.on_click(tab.doing(lambda: self._collecting.ask(self._question())))
        self._which = gui.add_slider("Solution", min=0, max=1, step=1, initial_value=0, disabled=True)
        self._which.on_update(tab.doing(self._step))
        hide = gui.add_button("Hide them")
        hide.on_click(tab.doing(self._hide_all))
        self._all_words = gui.add_markdown("")

    # --- the robot -------------------------------------------------------------------------------------------------

    def _take(self, state: ArmsState) -> None:
        """Take another robot, or the same one drawn in another way; if it makes no sense, the old one stays."""
        arm = arms.Arm.of(state, self._tab.folder)
        same = len(self._q) == arm.robot.model.nq
        self._put_up(arm, replace(state, q=tuple(self._q) if same else (), target=()))

    def _put_up(self, arm: arms.Arm, state: ArmsState) -> None:
        scene, robot = self._tab.client.scene, arm.robot
        try:
            drawing = RobotDrawing(scene, f"{ROOT}/robot", robot, state.drawn)
            ghost = RobotDrawing(scene, f"{ROOT}/last", robot, state.drawn, colour=GHOST, opacity=0.35)
        except InvalidModel as error:
            say(self._tab.client, robot.name, f"{in_words(error)}; it is drawn by its axes")
            state = replace(state, drawn="axes")
            drawing = RobotDrawing(scene, f"{ROOT}/robot", robot, "axes")
            ghost = RobotDrawing(scene, f"{ROOT}/last", robot, "axes", colour=GHOST)
        self._hide_all()
        self._state, self._arm, self._robot, self._last_good = state, arm, drawing, ghost
        self._q = self._configuration(state)
        drawing.show(self._q)
        ghost.show(self._q)
        ghost.visible = False
        scale = float(np.clip(0.25 * drawing.size, 0.05, 50.0))
        self._gizmo = scene.add_transform_controls(f"{ROOT}/target", scale=scale, line_width=3.0, depth_test=False)
        self._gizmo.on_update(self._tab.doing(self._dragged))
        self._make_sliders()
        self._world = None
        if state.target:
            put(self._gizmo, pin.XYZQUATToSE3(np.array(state.target)))
        else:
            put(self._gizmo, self._tip())
        aim(self._tab, drawing.size * np.array([1.7, 1.5, 1.2]), drawing.size * np.array([0.0, 0.0, 0.4]))
        self._show_target()
        self._ask()

    def _configuration(self, state: ArmsState) -> NDArray[np.float64]:
        """Where the robot begins: where the state says, if that is one of its configurations."""
        try:
            return self._arm.chain.inside(self._arm.chain.configuration(state.q or self._arm.chain.reference))
        except InvalidConfiguration as error:
            say(self._tab.client, self._arm.robot.name, in_words(error))
            return self._arm.chain.reference.copy()

    def _make_sliders(self) -> None:
        if self._sliders_box is not None:
            self._sliders_box.remove()
        with self._sliders_folder:
            self._sliders_box = self._tab.client.gui.add_folder(None)
        with self._sliders_box:
            chain = self._arm.chain
            self._sliders = JointSliders(self._tab, chain, chain.x(self._q), self._slid)

    def _tip(self) -> pin.SE3:
        """Pose of the tip where the robot is."""
        return pin.SE3(self._arm.chain.placements(self._q)[0])

    # --- questions and answers -------------------------------------------------------------------------------------

    def _dragged(self) -> None:
        self._show_target()
        self._ask()

    def _typed(self) -> None:
        put(self._gizmo, pin.SE3(pin.rpy.rpyToMatrix(*self._rpy.value), np.array(self._position.value)))
        self._ask()

    def _slid(self, x: NDArray[np.float64]) -> None:
        self._q = self._arm.chain.q(x, self._q)
        self._target_to_tip()

    def _target_to_tip(self) -> None:
        put(self._gizmo, self._tip())
        self._dragged()

    def _show_target(self) -> None:
        pose = pose_of(self._gizmo)
        self._position.value = tuple(np.round(pose.translation, 6).tolist())
        self._rpy.value = tuple(np.round(pin.rpy.matrixToRpy(pose.rotation), 6).tolist())

    def _question(self) -> Question:
        asked = time.perf_counter()
        if self._avoid.value and self._world is None:
            self._world = self._arm.world(self._scenery.obstacles())
        target = target_of(pose_of(self._gizmo), self._orientation.value)
        world = self._world if self._avoid.value else None
        return Question(self._arm, target, self._q, world, asked)

    def _ask(self) -> None:
        self._asking.ask(self._question())

    def _world_changed(self) -> None:
        self._world = None
        self._ask()

    def _solve(self, question: Question) -> None:
        """In the page's own thread: ask the library, and show what it says."""
        with told(self._tab.client):
            answer = answered(question)
            with self._tab.lock:
                if not self._closed and question.arm is self._arm:
                    with self._tab.client.atomic():
                        self._show(answer)
                    self._tab.client.flush()

    def _show(self, answer: Answer) -> None:
        assert self._robot is not None and self._last_good is not None and self._sliders is not None
        self._answer = answer
        result = answer.result
        if result.success:
            self._q = result.q
        self._robot.show(result.q)
        self._robot.redden(set(answer.colliding))
        self._gaps.show(answer.nearest)
        self._last_good.visible = not result.success
        if not result.success:
            self._last_good.show(self._q)
        self._sliders.show(result.x)
        self._words.content = answer.words()
        self._code.content = f"```python\n{code_of(answer.question, bool(self._scenery.entries))}\n```"

    # --- all solutions ---------------------------------------------------------------------------------------------

    def _collect(self, question: Question) -> None:
        """In a thread of its own: find all solutions, and show them as ghosts."""
        with told(self._tab.client):
            found = all_answers(question)
            with self._tab.lock:
                if not self._closed and question.arm is self._arm:
                    with self._tab.client.atomic():
                        self._show_all(found)

    def _show_all(self, found: IKSolutions) -> None:
        self._hide_all()
        self._solutions = found
        proved = f", proved to be all ({found.complete})" if found.complete is not None else ", perhaps not all"
        self._all_words.content = (
            f"{len(found)} solutions{proved}; {found.evaluations:,} evaluations in {1e3 * found.seconds:.3g} ms"
        )
        scene = self._tab.client.scene
        for number, q in enumerate(found):
            ghost = RobotDrawing(
                scene, f"{ROOT}/all/{number}", self._arm.robot, self._state.drawn, colour=OTHERS, opacity=0.2
            )
            ghost.show(q)
            self._ghosts.append(ghost)
        if len(found):
            self._which.disabled = len(found) < 2
            self._which.max = max(1, len(found) - 1)

    def _step(self) -> None:
        """Go to the solution that is chosen."""
        if self._solutions is not None and len(self._solutions):
            self._q = self._solutions.q[min(int(self._which.value), len(self._solutions) - 1)]
            self._ask()

    def _hide_all(self) -> None:
        for ghost in self._ghosts:
            ghost.remove()
        self._ghosts, self._solutions = [], None
        self._which.value, self._which.disabled = 0, True
        self._all_words.content = ""
