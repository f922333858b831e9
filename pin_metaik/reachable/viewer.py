"""A map in the browser, with the robot in it (the extra ``viewer``)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.collision import CollisionWorld
from pin_metaik.collision.viewer import WorldViewer, open_viewer
from pin_metaik.errors import InvalidSetting
from pin_metaik.reachable.result import Reachability

__all__ = ["show_reachability"]

FILLED = 0.3  # edge of the cube at a position, as a share of the distance to the next one
ASIDE, DISTANCE = np.array([0.35, -1.0, 0.45]), 0.9  # where the page looks from, in sizes of the map
# Viridis (van der Walt and Smith 2015) from the worst to the best: red, green and blue.
COLOURS = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]], dtype=float)
CORNERS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
     (1, 5, 7), (1, 7, 3)]
)  # fmt: skip


@checked
def show_reachability(found: Reachability, world: CollisionWorld, port: int = 8080) -> WorldViewer:
    """Show a map at http://localhost:port, to this machine only: a cube at each position that is reached.

    The colour is the greatest manipulability there, from violet to yellow. The robot and its obstacles are shown as
    well. Cubes in front of a plane y = constant are cut off; the plane begins in the middle, and a slider moves it.

    Args:
        found: The map.
        world: The robot with its obstacles; ``CollisionWorld(robot)`` for the robot alone.
        port: The port; 0 for any free port.

    Returns:
        The viewer, as of ``collision.viewer.open_viewer``: ``viewer.viewer`` is the server.

    Raises:
        InvalidSetting: If the map reaches nothing.
        MissingExtra: If viser, trimesh or pycollada is not installed.
    """
    reached = np.flatnonzero(found.reached.any(axis=1))
    if not len(reached):
        raise InvalidSetting("there is nothing to show: the map reaches none of its positions")
    places, worth = found.positions[reached], found.best[reached]
    shown = open_viewer(world, port)
    scene, gui = shown.viewer.scene, shown.viewer.gui
    count, spacing = len(places), _spacing(found.positions)
    edges = np.full(count, FILLED * spacing)
    cubes = scene.add_batched_meshes_simple(
        "reachability", CORNERS, FACES, batched_wxyzs=np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        batched_positions=places, batched_scales=edges, batched_colors=_colours(worth), flat_shading=True,
        cast_shadow=False, lod="off",
    )  # fmt: skip
    low, high = places.min(axis=0) - 0.5 * spacing, places.max(axis=0) + 0.5 * spacing
    gui.add_markdown(f"{found}  \nmanipulability {worth.min():.3g} (violet) to {worth.max():.3g} (yellow)")
    begin = float(low[1]) + spacing * round(0.5 * float(high[1] - low[1]) / spacing)
    cut = gui.add_slider("from y (m)", float(low[1]), float(high[1]), spacing, begin)

    def behind(_event: object = None) -> None:
        cubes.batched_scales = np.where(places[:, 1] >= cut.value, edges, 0.0)

    cut.on_update(behind)
    behind()
    camera, middle = shown.viewer.initial_camera, 0.5 * (low + high)
    camera.look_at, camera.position = middle, middle + DISTANCE * float(np.linalg.norm(high - low)) * ASIDE
    return shown


def _spacing(positions: NDArray[np.float64]) -> float:
    """The least distance between two positions along an axis, m; of one alone a tenth of a metre."""
    steps = np.concatenate([np.diff(np.unique(np.round(axis, 9))) for axis in positions.T])
    return float(steps.min()) if len(steps) else 0.1


def _colours(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Red, green and blue (k, 3) of values (k,), from the least to the greatest."""
    least, most = float(values.min()), float(values.max())
    shares = (values - least) / (most - least) if most > least else np.ones(len(values))
    places = np.linspace(0.0, 1.0, len(COLOURS))
    return np.column_stack([np.interp(shares, places, channel) for channel in COLOURS.T]).round().astype(np.uint8)
