"""A map of polygons seen from above, with paths and points on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from pin_metaik.gui.tab import Tab
from pin_metaik.mobile import Scene

Colour = tuple[int, int, int]
STONE, EDGE, WALL = (165, 150, 135), (90, 75, 60), (110, 110, 120)
START, GOAL = (40, 150, 70), (200, 60, 50)
HEIGHT = 0.02  # of obstacles, in widths of the map
ABOVE = 1.5  # heights of what is seen, from which the camera looks down


class MapDrawing:
    """A scene under a node; what is drawn on it is drawn again under the same name.

    Args:
        tab: The tab.
        node: Name of the node.
        world: The scene.
        shift: How far right of its own place it is drawn.

    Attributes:
        width: Of what is drawn.
    """

    def __init__(self, tab: Tab, node: str, world: Scene, shift: float = 0.0) -> None:
        self._scene, self._node = tab.client.scene, node
        self._nodes: dict[str, Any] = {}
        self._root = self._scene.add_frame(node, show_axes=False, position=(shift, 0.0, 0.0))
        self.width = 1.0
        self.redraw(world)

    def redraw(self, world: Scene) -> None:
        """Draw another scene in place of this one; what was drawn on it is gone."""
        for name in list(self._nodes):
            self.clear(name)
        x_min, y_min, x_max, y_max = (float(value) for value in world.box)
        self.width = max(x_max - x_min, y_max - y_min)
        corners = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
        self.outline("walls", [corners], WALL)
        parts = [part for obstacle in world.obstacles for part in _polygons(obstacle)]
        if parts:
            vertices, triangles = _prisms(parts, HEIGHT * self.width)
            self._keep(
                "obstacles",
                self._scene.add_mesh_simple(
                    f"{self._node}/obstacles", vertices, triangles, color=STONE, flat_shading=True, side="double"
                ),
            )
        rings = [np.array(ring.coords)[:-1] for part in parts for ring in (part.exterior, *part.interiors)]
        self.outline("edges", rings, EDGE, lift=1.05 * HEIGHT)
        self.points("start", [world.start], START, 2.2)
        self.points("goal", [world.goal], GOAL, 2.2)

    def path(self, name: str, points: ArrayLike, colour: Colour, thickness: float = 4.0) -> None:
        """Draw a polyline (n, 2)."""
        self.lines(name, [np.asarray(points, dtype=float)], colour, thickness)

    def outline(self, name: str, rings: Sequence[NDArray[np.float64]], colour: Colour, lift: float = 0.001) -> None:
        """Draw closed polygons, each (n, 2)."""
        self.lines(name, [np.vstack([ring, ring[:1]]) for ring in rings], colour, 2.0, lift)

    def lines(
        self,
        name: str,
        ways: Sequence[NDArray[np.float64]],
        colour: Colour,
        thickness: float = 2.0,
        lift: float = 1.5 * HEIGHT,
    ) -> None:
        """Draw several polylines, each (n, 2)."""
        pairs = [np.stack([way[:-1], way[1:]], axis=1) for way in ways if len(way) > 1]
        if not pairs:
            self.clear(name)
            return
        flat = np.concatenate(pairs)  # (k, 2, 2)
        segments = np.dstack([flat, np.full(flat.shape[:2], lift * self.width)]).astype(np.float32)
        if name in self._nodes:
            self._nodes[name].points = segments
        else:
            node = f"{self._node}/{name}"
            drawn = self._scene.add_line_segments(node, segments, colour, thickness=thickness, thickness_units="screen")
            self._keep(name, drawn)

    def points(self, name: str, points: ArrayLike, colour: Colour, size: float = 1.0) -> None:
        """Draw points (k, 2)."""
        at = np.asarray(points, dtype=float).reshape(-1, 2)
        above = np.column_stack([at, np.full(len(at), 1.6 * HEIGHT * self.width)]).astype(np.float32)
        if name in self._nodes:
            self._nodes[name].points = above
        else:
            self._keep(
                name,
                self._scene.add_point_cloud(
                    f"{self._node}/{name}",
                    above,
                    colour,
                    point_size=0.008 * size * self.width,
                    point_shape="circle",
                    precision="float32",
                ),
            )

    def clear(self, name: str) -> None:
        """Take something away, if it is there."""
        node = self._nodes.pop(name, None)
        if node is not None:
            node.remove()

    def remove(self) -> None:
        """Take the whole map away."""
        self._root.remove()

    def _keep(self, name: str, node: Any) -> None:
        self._nodes[name] = node


def look_down(tab: Tab, world: Scene, maps: int = 1) -> None:
    """Look at one map or several side by side from above; x goes right, y up."""
    x_min, y_min, x_max, y_max = world.box
    width, height = (x_max - x_min) * (1.0 + 1.15 * (maps - 1)), y_max - y_min
    centre = np.array([x_min + 0.5 * width, 0.5 * (y_min + y_max), 0.0])
    camera = tab.client.camera
    camera.fov = np.radians(40.0)
    camera.up_direction = (0.0, 1.0, 0.0)
    away = ABOVE * max(width / camera.aspect, height)
    camera.position = (centre[0], centre[1] - 1e-3 * height, away)
    camera.look_at = tuple(centre)


def beside(world: Scene) -> float:
    """How far right of a map the next one is drawn."""
    return 1.15 * float(world.box[2] - world.box[0])


def _polygons(obstacle: Any) -> list[Any]:
    """The polygons of an obstacle; lines and points as thin ones, to be seen."""
    if obstacle.geom_type in ("MultiPolygon", "GeometryCollection"):
        return [part for each in obstacle.geoms for part in _polygons(each)]
    return [obstacle] if obstacle.geom_type == "Polygon" else _polygons(obstacle.buffer(0.01))


def _prisms(polygons: Sequence[Any], height: float) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Polygons as solids that stand on the plane: vertices and triangles."""
    faces = []  # (k, 3, 3) each
    for polygon in polygons:
        tops = [np.array(one.exterior.coords)[:3, :2] for one in shapely.constrained_delaunay_triangles(polygon).geoms]
        faces.append(np.array([np.column_stack([top, np.full(3, height)]) for top in tops]))
        for ring in (polygon.exterior, *polygon.interiors):
            along = np.array(ring.coords)[:, :2]
            low, high = (np.column_stack([along, np.full(len(along), z)]) for z in (0.0, height))
            faces.append(np.stack([low[:-1], low[1:], high[1:]], axis=1))
            faces.append(np.stack([low[:-1], high[1:], high[:-1]], axis=1))
    corners = np.concatenate([one for one in faces if len(one)])
    return corners.reshape(-1, 3).astype(np.float32), np.arange(3 * len(corners), dtype=np.uint32).reshape(-1, 3)
