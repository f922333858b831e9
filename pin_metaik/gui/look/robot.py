"""A robot in the scene of one tab: at a configuration, in its own colours or as a ghost."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.gui.look.pieces import Drawn, pieces_of
from pin_metaik.robots import Robot

RED = (217, 31, 26)
LINE = (90, 90, 100)


def put(handle: Any, M: pin.SE3) -> None:
    """Move a node of the scene."""
    x, y, z, w = pin.Quaternion(M.rotation).coeffs()
    handle.position, handle.wxyz = tuple(M.translation), (w, x, y, z)


def pose_of(handle: Any) -> pin.SE3:
    """Where a node of the scene is."""
    w, x, y, z = handle.wxyz
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized(), np.array(handle.position, dtype=float))


class RobotDrawing:
    """A robot under a node of the scene.

    Args:
        scene: Of one tab.
        name: Of its node.
        robot: The robot.
        drawn: How.
        colour: In place of its own colours: for ghosts.
        opacity: 0 to 1.

    Attributes:
        size: Length of the box around it, where it was last shown, m.
    """

    def __init__(
        self,
        scene: Any,
        name: str,
        robot: Robot,
        drawn: Drawn,
        *,
        colour: tuple[int, int, int] | None = None,
        opacity: float = 1.0,
    ) -> None:
        self._model, self._data = robot.model, robot.model.createData()
        self._root = scene.add_frame(name, show_axes=False)
        self._own = {piece.link: colour or piece.colour for piece in pieces_of(robot, drawn)}
        self._joints: dict[int, Any] = {}
        self._links: dict[str, list[Any]] = {}
        self._red: set[str] = set()
        for number, piece in enumerate(pieces_of(robot, drawn)):
            node = f"{name}/{piece.joint}"
            if piece.joint not in self._joints:
                self._joints[piece.joint] = scene.add_frame(node, show_axes=False)
            mesh = scene.add_mesh_simple(
                f"{node}/{number}",
                piece.vertices,
                piece.triangles,
                color=colour or piece.colour,
                opacity=None if opacity == 1.0 else opacity,
                flat_shading=len(piece.triangles) < 5000,
                cast_shadow=False,
                receive_shadow=False,
            )
            self._links.setdefault(piece.link, []).append(mesh)
        self._lines: Any = None
        if not self._joints:
            self._draw_axes(scene, name)

    @property
    def size(self) -> float:
        """Length of the box around the joints where it was last shown, m."""
        points = np.array([M.translation for M in self._data.oMi])
        return float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0

    @property
    def visible(self) -> bool:
        """Whether it is to be seen."""
        return bool(self._root.visible)

    @visible.setter
    def visible(self, value: bool) -> None:
        if self._root.visible != value:
            self._root.visible = value

    def show(self, q: NDArray[np.float64]) -> None:
        """Move it to a configuration q (nq,)."""
        pin.forwardKinematics(self._model, self._data, q)
        for joint, frame in self._joints.items():
            put(frame, self._data.oMi[joint])
        if self._lines is not None:
            self._lines.points = self._segments()

    def redden(self, links: set[str]) -> None:
        """Show links in red, and all others as they are."""
        for link in links ^ self._red:
            for mesh in self._links.get(link, ()):
                mesh.color = RED if link in links else self._own[link]
        self._red = links

    def remove(self) -> None:
        """Take it out of the scene."""
        self._root.remove()

    def _draw_axes(self, scene: Any, name: str) -> None:
        """Draw the axes of its joints, and lines from one joint to the next."""
        pin.forwardKinematics(self._model, self._data, pin.neutral(self._model))
        length = 0.12 * self.size
        for joint in range(1, self._model.njoints):
            self._joints[joint] = scene.add_frame(f"{name}/{joint}", axes_length=length, axes_radius=0.04 * length)
        self._lines = scene.add_line_segments(
            f"{name}/lines", self._segments(), LINE, thickness=4.0, thickness_units="screen"
        )

    def _segments(self) -> NDArray[np.float32]:
        """From each joint to the one that carries it (k, 2, 3)."""
        at = [M.translation for M in self._data.oMi]
        parents = list(self._model.parents)
        return np.array([[at[parents[j]], at[j]] for j in range(1, self._model.njoints)], dtype=np.float32)
