"""A way by hand: via points that are typed, clicked or dragged, and how its path compares with the shortest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pin_metaik.errors import InvalidGeometry
from pin_metaik.gui.look.map import MapDrawing
from pin_metaik.gui.pages.paths.plans import in_a_line, needed
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.mobile import PathPlan, PathProblem, path_through

COLOUR = (130, 80, 170)
MOST = 50  # via points
Point = tuple[float, float]


class HandPath:
    """Controls of one path.

    Args:
        tab: The tab.
        drawing: The map.
        via: Its via points at first.

    Attributes:
        via: Its via points.
        plan: The path through them, judged; None before they are on a map that can be planned on.
    """

    def __init__(self, tab: Tab, drawing: MapDrawing, via: Sequence[Point]) -> None:
        self._tab, self._map = tab, drawing
        self.via = list(via)
        self.plan: PathPlan | None = None
        self._problem: PathProblem | None = None
        self._gizmos: list[Any] = []
        gui = tab.client.gui
        self._typed = gui.add_text("Via points", text_of(self.via), hint="x, y; x, y; ... from start to goal, m.")
        self._typed.on_update(tab.doing(self._type, "These via points are not taken"))
        buttons = gui.add_button_group("Change them", ("Add", "Remove last"))
        buttons.on_click(tab.doing(lambda: self._add() if buttons.value == "Add" else self._put(self.via[:-1])))
        self._words = gui.add_markdown("Type via points, add them here, or click them on the map.")
        self._place()

    def show(self, problem: PathProblem | None) -> None:
        """Judge the path on another map, or for another robot; None: nobody can plan there."""
        self._problem = problem
        self._judge()

    def append(self, place: Point) -> None:
        """Add a via point, the last before the goal."""
        self._put([*self.via, place])

    def _add(self) -> None:
        """Add one between the last and the goal."""
        scene = needed(self._problem).scene
        x, y = 0.5 * (np.array(self.via[-1] if self.via else scene.start) + scene.goal)
        self.append((float(x), float(y)))

    def _type(self) -> None:
        self._put(points_of(self._typed.value))

    def _put(self, via: Sequence[Point]) -> None:
        if len(via) > MOST:
            raise InvalidGeometry(f"a way by hand has at most {MOST} via points, got {len(via)}")
        self.via = list(via)
        self._typed.value = text_of(self.via)
        self._place()
        self._judge()

    def _place(self) -> None:
        """A gizmo at each via point."""
        for gizmo in self._gizmos[len(self.via) :]:
            gizmo.remove()
        del self._gizmos[len(self.via) :]
        flat: dict[str, Any] = {"active_axes": (True, True, False), "disable_rotations": True, "depth_test": False}
        for number, (x, y) in enumerate(self.via):
            if number == len(self._gizmos):
                gizmo = self._tab.client.scene.add_transform_controls(
                    f"{ROOT}/via/{number}", scale=0.1 * self._map.width, position=(x, y, 0.0), **flat
                )
                gizmo.on_update(self._tab.doing(self._dragged))
                self._gizmos.append(gizmo)
            else:
                self._gizmos[number].position = (x, y, 0.0)

    def _dragged(self) -> None:
        self.via = [(float(gizmo.position[0]), float(gizmo.position[1])) for gizmo in self._gizmos]
        self._typed.value = text_of(self.via)
        self._judge()

    def _judge(self) -> None:
        """Judge the path, and draw it; while another map is being planned on, what is drawn stays."""
        self.plan = None
        if not self.via:
            for name in ("by hand", "via by hand"):
                self._map.clear(name)
            return
        self._map.points("via by hand", self.via, COLOUR, 1.6)
        if self._problem is not None:
            self.plan = path_through(self._problem, self.via)
            self._map.path("by hand", self.plan.path.points, COLOUR, 4.0)
            self._words.content = in_a_line(self.plan)


def text_of(via: Sequence[Point]) -> str:
    """Via points as they are typed."""
    return "; ".join(f"{x:.4g}, {y:.4g}" for x, y in via)


def points_of(text: str) -> list[Point]:
    """Via points that were typed.

    Raises:
        InvalidGeometry: They are no pairs of finite numbers.
    """
    points = []
    for part in filter(None, map(str.strip, text.split(";"))):
        try:
            x, y = map(float, part.split(","))
        except ValueError:
            raise InvalidGeometry(f"via points are typed as x, y; x, y; ..., got {part!r}") from None
        if not np.isfinite([x, y]).all():
            raise InvalidGeometry(f"via points are finite, got {part!r}")
        points.append((x, y))
    return points
