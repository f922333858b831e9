"""The closest points of the robot and of obstacles, with lines between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pin_metaik.collision import Distance
from pin_metaik.gui.tab import ROOT, Tab

LINE = (200, 60, 50)
BALL = 0.012  # m, across


class GapLines:
    """Lines from obstacles to what of the robot is nearest to them; none where they overlap.

    Args:
        tab: The tab.
    """

    def __init__(self, tab: Tab) -> None:
        self._scene = tab.client.scene
        self._lines: Any = None
        self._balls: Any = None

    def show(self, nearest: Sequence[Distance]) -> None:
        """Show these gaps in place of the last ones."""
        pairs = [(one.point_first, one.point_second) for one in nearest if one.distance > 0.0]
        points = np.array(pairs, dtype=np.float32).reshape(-1, 2, 3)
        if self._lines is None and len(points):
            self._lines = self._scene.add_line_segments(
                f"{ROOT}/gaps", points, LINE, thickness=2.5, thickness_units="screen"
            )
            looks: dict[str, Any] = {"point_size": BALL, "point_shape": "circle", "precision": "float32"}
            self._balls = self._scene.add_point_cloud(f"{ROOT}/closest", points.reshape(-1, 3), LINE, **looks)
        for node, shown in ((self._lines, points), (self._balls, points.reshape(-1, 3))):
            if node is not None:
                node.visible = bool(len(shown))
                if len(shown):
                    node.points = shown
