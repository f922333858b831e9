"""A Stewart platform in the scene: plates, legs, and their colours where a limit binds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.gui.tab import Tab
from pin_metaik.stewart import Mechanism
from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.show.picture import legs_at

BASE, PLATE, STEEL, ROD, BINDS, GHOST = (
    (120, 125, 135),
    (45, 110, 180),
    (90, 95, 105),
    (200, 205, 215),
    (217, 31, 26),
    (150, 150, 160),
)


class PlatformDrawing:
    """A mechanism under a node of the scene.

    Args:
        tab: The tab.
        node: Name of the node.
        mechanism: The mechanism.
        ghost: Whether it is drawn as a ghost, all in grey.
    """

    def __init__(self, tab: Tab, node: str, mechanism: Mechanism, *, ghost: bool = False) -> None:
        self._scene, self._node, self._mechanism, self._ghost = tab.client.scene, node, mechanism, ghost
        self._root = self._scene.add_frame(node, show_axes=False)
        geometry = mechanism.geometry
        if not ghost:
            self._plate("base", geometry.base_joints, BASE)
        axes = {"axes_length": 0.5 * self.size, "axes_radius": 0.01 * self.size, "origin_radius": 0.02 * self.size}
        self._platform = self._scene.add_frame(f"{node}/platform", show_axes=not ghost, **axes)
        self._plate("platform/plate", geometry.platform_joints, GHOST if ghost else PLATE)
        self._legs: dict[str, Any] = {}

    @property
    def size(self) -> float:
        """Of both sides, m."""
        return float(0.5 * (self._mechanism.geometry.base_radius + self._mechanism.geometry.platform_radius))

    def show(self, T: NDArray[np.float64]) -> None:
        """Show it at a pose (4, 4); legs that are at or beyond their limits are red."""
        w, x, y, z = _quaternion(T[:3, :3])
        self._platform.position, self._platform.wxyz = tuple(T[:3, 3]), (w, x, y, z)
        ways = legs_at(self._mechanism, T).astype(np.float32)  # (n, 3, 3)
        q = inverse(self._mechanism.geometry, T).coordinates.ravel()
        low, high = self._mechanism.limits.span
        binds = ~((q > low) & (q < high))
        lower = np.where(binds[:, None], BINDS, GHOST if self._ghost else STEEL)
        upper = np.where(binds[:, None], BINDS, GHOST if self._ghost else ROD)
        self._lines("cylinders", ways[:, :2], lower, 9.0 if not self._ghost else 3.0)
        self._lines("rods", ways[:, 1:], upper, 5.0 if not self._ghost else 2.0)

    def remove(self) -> None:
        """Take it away."""
        self._root.remove()

    def _lines(self, name: str, pairs: NDArray[np.float32], colours: NDArray[np.int64], thickness: float) -> None:
        shades = np.repeat(colours.astype(np.uint8)[:, None], 2, axis=1)  # (n, 2, 3)
        if name in self._legs:
            self._legs[name].points, self._legs[name].colors = pairs, shades
        else:
            self._legs[name] = self._scene.add_line_segments(
                f"{self._node}/{name}", pairs, shades, thickness=thickness, thickness_units="screen"
            )

    def _plate(self, name: str, joints: NDArray[np.float64], colour: tuple[int, int, int]) -> None:
        """A flat plate through the joints (k, 3), and a ball at each."""
        count = len(joints)
        fan = np.array([[0, k, k + 1] for k in range(1, count - 1)], dtype=np.uint32)
        self._scene.add_mesh_simple(
            f"{self._node}/{name}",
            joints.astype(np.float32),
            fan,
            color=colour,
            opacity=0.3 if self._ghost else 0.8,
            side="double",
        )
        for number, joint in enumerate(joints, start=1):
            self._scene.add_icosphere(
                f"{self._node}/{name}/{number}", 0.02 * self.size, color=colour, position=tuple(joint)
            )


def _quaternion(R: NDArray[np.float64]) -> tuple[float, float, float, float]:
    import pinocchio as pin

    x, y, z, w = pin.Quaternion(R).coeffs()
    return float(w), float(x), float(y), float(z)
