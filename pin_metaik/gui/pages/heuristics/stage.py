"""Where a search is seen: a map with via points, or an arm with the places that its tip was brought to."""

from __future__ import annotations

from contextlib import suppress
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pin_metaik.gui.look.camera import aim
from pin_metaik.gui.look.map import MapDrawing, beside, look_down
from pin_metaik.gui.look.robot import RobotDrawing
from pin_metaik.gui.pages.heuristics.tasks import ArmTask, PathTask
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.kinematics import Chain
from pin_metaik.mobile import NoPath, PathProblem, Scene
from pin_metaik.robots import load_robot

SWARM, BEST, EXACT, TARGET = (60, 120, 210), (210, 70, 50), (40, 150, 70), (200, 60, 50)
MOST_WAYS = 200  # paths of a population that are drawn as lines


class Stage(Protocol):
    """A place where the populations of one run are drawn."""

    def show(self, X: NDArray[np.float64], best: NDArray[np.float64] | None) -> None:
        """Draw a population (k, n), and the best point (n,)."""
        ...

    def remove(self) -> None:
        """Take it away."""
        ...


class MapStage:
    """A map: every individual is a path through its via points.

    Args:
        tab: The tab.
        number: Of the run beside others, from 0.
        scene: The map.
        radius: Of the robot.
    """

    def __init__(self, tab: Tab, number: int, scene: Scene, radius: float = 0.0) -> None:
        self._map = MapDrawing(tab, f"{ROOT}/stage{number}", scene, number * beside(scene))
        self._problem = PathProblem.of(scene, radius)
        with suppress(NoPath):
            self._map.path("shortest", self._problem.optimum.points, EXACT, 2.0)

    def show(self, X: NDArray[np.float64], best: NDArray[np.float64] | None) -> None:
        """See ``Stage``."""
        ways = [self._problem.through(x).points for x in X[:MOST_WAYS]]
        self._map.lines("swarm", ways, SWARM, 1.0)
        self._map.points("via", X.reshape(-1, 2), SWARM)
        if best is not None:
            self._map.path("best", self._problem.through(best).points, BEST, 5.0)

    def remove(self) -> None:
        """See ``Stage``."""
        self._map.remove()


class ArmStage:
    """An arm: every individual is a place of its tip; the arm itself is where the best has it.

    Args:
        tab: The tab.
        number: Of the run beside others, from 0.
        task: The arm and its goal.
    """

    def __init__(self, tab: Tab, number: int, task: ArmTask) -> None:
        self._scene = tab.client.scene
        self._node = f"{ROOT}/stage{number}"
        robot = load_robot(task.robot, parameters=dict(task.parameters) or None)
        self._chain = Chain(robot.model, robot.frame)
        self._root = self._scene.add_frame(self._node, show_axes=False)
        self._arm = RobotDrawing(self._scene, f"{self._node}/arm", robot, "meshes")
        self._arm.show(self._chain.reference)
        self.size = self._arm.size
        self._root.position = (2.2 * number * self.size, 0.0, 0.0)
        self._scene.add_icosphere(f"{self._node}/goal", 0.02 * self.size, color=TARGET, position=task.goal)
        self._cloud = self._scene.add_point_cloud(
            f"{self._node}/tips",
            np.zeros((0, 3), np.float32),
            SWARM,
            point_size=0.012 * self.size,
            point_shape="circle",
            precision="float32",
        )

    def show(self, X: NDArray[np.float64], best: NDArray[np.float64] | None) -> None:
        """See ``Stage``."""
        self._cloud.points = self._chain.poses(X)[:, 0, :3, 3].astype(np.float32)
        if best is not None:
            self._arm.show(self._chain.q(best))

    def remove(self) -> None:
        """See ``Stage``."""
        self._root.remove()


def set_up(tab: Tab, number: int, of: int, task: PathTask | ArmTask) -> Stage:
    """The stage of a task, the ``number``-th of several beside each other, with the camera on all of them."""
    if isinstance(task, PathTask):
        look_down(tab, task.scene, of)
        return MapStage(tab, number, task.scene, task.radius)
    stage = ArmStage(tab, number, task)
    size, right = stage.size, 1.1 * (of - 1) * stage.size
    eye = (right + 0.3 * size, -(1.9 + 0.7 * (of - 1)) * size, 1.1 * size)
    aim(tab, eye, (right, 0.0, 0.45 * size))
    return stage
