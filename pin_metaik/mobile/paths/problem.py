"""A planning problem: a scene, the clearance to keep, and data that all planners share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.mobile.paths.exact import shortest_path
from pin_metaik.mobile.paths.homotopy import shortest_paths
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.visibility import Visibility
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.growth import Join
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.optimize import Box
from pin_metaik.optimize.settings import few, within


@dataclass(frozen=True, eq=False)
class PathProblem:
    """A scene with the clearance to keep, and data that all planners share.

    Attributes:
        scene: The world, start and goal.
        space: Its free space.
    """

    scene: Scene
    space: FreeSpace

    @staticmethod
    @checked
    def of(scene: Scene, radius: float = 0.0, margin: float = 0.0, join: Join | None = None) -> PathProblem:
        """A problem, checked.

        Args:
            scene: The world, start and goal.
            radius: Radius of the robot, in the scene's unit.
            margin: Distance to keep in addition.
            join: How corners of grown obstacles are joined: ``mitre`` or ``round``; default: ``mitre``, which has fewer
                corners, and ``round`` if there is then no path.

        Raises:
            Blocked: The robot cannot be at the start or the goal.
            InvalidSetting: A radius or margin below zero, or no such join.
        """
        within("radius", radius, 0)
        within("margin", margin, 0)
        clearance = radius + margin
        space = FreeSpace.of(scene, clearance, join or "mitre")
        if join is None and clearance and not space.connects(scene.start, scene.goal):
            space = FreeSpace.of(scene, clearance, "round")
        space.check("start", scene.start)
        space.check("goal", scene.goal)
        return PathProblem(scene, space)

    @cached_property
    def visibility(self) -> Visibility:
        """The visibility graph of the free space."""
        return Visibility(self.space)

    @cached_property
    def optimum(self) -> Path:
        """The shortest path. Raises NoPath if there is none."""
        return shortest_path(self.space, self.scene.start, self.scene.goal, self.visibility)

    @checked
    def alternatives(self, count: int) -> list[Path]:
        """The shortest paths of the best homotopy classes, see ``shortest_paths``."""
        return shortest_paths(self.space, self.scene.start, self.scene.goal, count, self.visibility)

    @checked
    def box(self, via: int) -> Box:
        """The search space of via points: for each of them the workspace inside its walls."""
        few("via", via)
        x_min, y_min, x_max, y_max = self.space.box
        return Box(np.tile([x_min, y_min], via), np.tile([x_max, y_max], via))

    def through(self, x: Array) -> Path:
        """The path through via points (2 n,)."""
        x = array("x", x, "2 n")
        return Path(np.vstack((self.scene.start, x[: x.size // 2 * 2].reshape(-1, 2), self.scene.goal)))
