"""A map that is drawn with the mouse: corners by clicks on the ground, start and goal by dragging."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import shapely

from pin_metaik.errors import InvalidGeometry
from pin_metaik.gui.look.map import GOAL, START, MapDrawing
from pin_metaik.gui.tab import ROOT, Tab
from pin_metaik.mobile import Scene

LOOK, DRAW, TAKE, VIA = MODES = ("Look", "Draw obstacles", "Take obstacles away", "Add via points")
CORNERS = (200, 120, 20)
FEWEST, MOST = 3, 200  # corners of an obstacle
Point = tuple[float, float]


def on_ground(origin: tuple[float, ...], direction: tuple[float, ...]) -> Point | None:
    """Where a ray from the eye meets the ground; None if it does not."""
    if direction[2] >= -1e-9:
        return None
    share = -origin[2] / direction[2]
    return origin[0] + share * direction[0], origin[1] + share * direction[1]


class MapEditor:
    """Controls that change a map, and the map itself in the scene.

    Args:
        tab: The tab.
        world: The map at first.
        changed: Called after every change of the map.
        via: Called with a place that was clicked as a via point.
    """

    def __init__(self, tab: Tab, world: Scene, changed: Callable[[], None], via: Callable[[Point], None]) -> None:
        self._tab, self._changed, self._via = tab, changed, via
        self.world = world
        self.map = MapDrawing(tab, f"{ROOT}/map", world)
        self._corners: list[Point] = []
        gui = tab.client.gui
        self._mode = gui.add_dropdown("Mouse", MODES, hint="What a click on the map does.")
        self._mode.on_update(tab.doing(self._forget))
        buttons = gui.add_button_group("Drawing", ("Close", "Undo"))
        buttons.on_click(tab.doing(lambda: self._close() if buttons.value == "Close" else self._undo()))
        self._said = gui.add_markdown("")
        self._click = tab.client.scene.on_click()(self._clicked)
        scale = 0.12 * self.map.width
        flat: dict[str, Any] = {"active_axes": (True, True, False), "disable_rotations": True, "depth_test": False}
        self._ends: dict[str, Any] = {}
        self._places: dict[str, Any] = {}
        for role, colour in (("start", START), ("goal", GOAL)):
            x, y = getattr(world, role)
            gizmo = tab.client.scene.add_transform_controls(f"{ROOT}/{role}", scale=scale, position=(x, y, 0.0), **flat)
            tab.client.scene.add_icosphere(f"{ROOT}/{role}/ball", 0.012 * self.map.width, color=colour)
            gizmo.on_update(tab.doing(self._dragged))
            self._ends[role] = gizmo
            typed = gui.add_vector2(f"{role.capitalize()}, m", (float(x), float(y)), step=0.01)
            typed.on_update(tab.doing(self._typed))
            self._places[role] = typed

    def take(self, world: Scene) -> None:
        """Show another map, and tell of it."""
        self.world = world
        self._corners = []
        self.map.redraw(world)
        for role, gizmo in self._ends.items():
            gizmo.position = (*getattr(world, role), 0.0)
            self._places[role].value = tuple(getattr(world, role))
        self._changed()

    def close(self) -> None:
        """Hear no more clicks; a tab that is gone has none."""
        if not self._tab.closed:
            self._tab.client.scene.remove_click_callback(self._click)

    def _clicked(self, event: Any) -> None:
        place = on_ground(event.ray_origin, event.ray_direction)
        if place is not None:
            self._tab.doing(lambda: self._at(place))(event)

    def _at(self, place: Point) -> None:
        """A click on the ground."""
        if self._mode.value == DRAW:
            if len(self._corners) >= MOST:
                raise InvalidGeometry(f"an obstacle that is drawn has at most {MOST} corners")
            self._corners.append(place)
            self._draw_corners()
        elif self._mode.value == TAKE:
            here = shapely.Point(place)
            left = tuple(one for one in self.world.obstacles if not one.covers(here))
            if len(left) < len(self.world.obstacles):
                self._replace(left)
        elif self._mode.value == VIA:
            self._via(place)

    def _close(self) -> None:
        """Make an obstacle of the corners."""
        if len(self._corners) < FEWEST:
            raise InvalidGeometry(f"an obstacle has {FEWEST} corners or more, there are {len(self._corners)}")
        self._replace((*self.world.obstacles, self._corners))

    def _replace(self, obstacles: tuple[Any, ...]) -> None:
        self.take(Scene(self.world.start, self.world.goal, obstacles, self.world.bounds, self.world.name))
        self._say()

    def _undo(self) -> None:
        if self._corners:
            self._corners.pop()
            self._draw_corners()

    def _forget(self) -> None:
        self._corners = []
        self._draw_corners()

    def _draw_corners(self) -> None:
        if self._corners:
            self.map.points("corners", self._corners, CORNERS, 1.5)
            self.map.path("edges drawn", np.array(self._corners), CORNERS)
        else:
            self.map.clear("corners")
            self.map.clear("edges drawn")
        self._say()

    def _say(self) -> None:
        count = len(self._corners)
        self._said.content = f"{count} corners; *Close* makes an obstacle of them." if count else ""

    def _dragged(self) -> None:
        for role, gizmo in self._ends.items():
            self._places[role].value = tuple(round(float(value), 4) for value in gizmo.position[:2])
        self._between(*(gizmo.position[:2] for gizmo in self._ends.values()))

    def _typed(self) -> None:
        for role, gizmo in self._ends.items():
            gizmo.position = (*self._places[role].value, 0.0)
        self._between(*(place.value for place in self._places.values()))

    def _between(self, *ends: tuple[float, float]) -> None:
        """Another start and goal."""
        start, goal = (tuple(map(float, end)) for end in ends)
        self.world = self.world.between(start, goal)
        self.map.points("start", [start], START, 2.2)
        self.map.points("goal", [goal], GOAL, 2.2)
        self._changed()
