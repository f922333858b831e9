"""A picture of a world: obstacles, and the robot at one or several configurations, in axes of matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.collision.body import Body
from pin_metaik.collision.drawing import surface
from pin_metaik.collision.obstacle import placement
from pin_metaik.collision.world import CollisionWorld
from pin_metaik.errors import InvalidConfiguration, InvalidSetting
from pin_metaik.figures import picture_file, save_picture
from pin_metaik.lookup import need

ROBOT, HELD, STANDING = (0.18, 0.44, 0.69), (0.88, 0.48, 0.10), (0.55, 0.53, 0.50)  # blue, orange, stone
FAINT, CLEAR = 0.18, 0.16  # opacity of the first of several configurations, and of what stands
LIGHT = np.array([0.4, -0.5, 0.77])
LENGTH = 0.12  # m, of the axes of a target
AXES = (0.84, 0.10, 0.11), (0.17, 0.63, 0.17), (0.12, 0.22, 0.80)  # x red, y green, z blue


@checked
def save_world(path: str | Path, world: CollisionWorld, Q: ArrayLike, targets: Sequence[Any] = ()) -> Path:
    """Draw a world and write the picture (``.png``, ``.svg``, ``.pdf``); see ``draw_world``.

    Raises:
        MissingExtra: If matplotlib or trimesh is not installed.
        InvalidSetting: If its ending is not one of a picture.
        CannotWrite: If it cannot be written.
        InvalidConfiguration: If a row is not a configuration of the model.
        InvalidGeometry: If a target is not a pose or position.
    """
    file = picture_file(path)
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 5.6), layout="constrained")
    draw_world(figure.add_subplot(projection="3d"), world, Q, targets)
    return save_picture(figure, file)


@checked
def draw_world(axes: Any, world: CollisionWorld, Q: ArrayLike, targets: Sequence[Any] = ()) -> None:
    """Draw a world into three-dimensional axes of matplotlib.

    Links are drawn as their convex hulls; of several configurations the later ones are more opaque. What the robot
    holds is orange.

    Args:
        axes: Of matplotlib, made with ``projection="3d"``.
        world: The world.
        Q: (nq,) a configuration, or (k, nq) several.
        targets: Poses, or positions (3,) in m, whose axes are drawn: x red, y green, z blue.

    Raises:
        MissingExtra: If matplotlib or trimesh is not installed.
        InvalidSetting: If the axes are not three-dimensional.
        InvalidConfiguration: If a row is not a configuration of the model.
        InvalidGeometry: If a target is not a pose or position.
    """
    need("a picture of a world", "plots", "matplotlib")
    need("a picture of a world", "viewer", "trimesh")
    if not hasattr(axes, "add_collection3d"):
        raise InvalidSetting("axes are of matplotlib, three-dimensional: figure.add_subplot(projection='3d')")
    rows = np.atleast_2d(array("Q", Q, "...", world.model.nq, error=InvalidConfiguration))
    solids, data = world.checker.solids, world.model.createData()
    corners = [_add(axes, body, pin.SE3.Identity(), STANDING, CLEAR) for body in solids.standing]
    for q, opacity in zip(rows, np.linspace(FAINT if len(rows) > 1 else 1.0, 1.0, len(rows)), strict=True):
        pin.forwardKinematics(world.model, data, q)
        for body in solids.moving:
            colour = ROBOT if body.part else HELD
            corners.append(_add(axes, body, data.oMi[body.joint], colour, float(opacity)))
    corners += [_add_axes(axes, placement(f"target {number}", target)) for number, target in enumerate(targets)]
    points = np.concatenate(corners) if corners else np.zeros((1, 3))
    for low, high, set_limits in zip(
        points.min(axis=0), points.max(axis=0), (axes.set_xlim, axes.set_ylim, axes.set_zlim), strict=True
    ):
        set_limits(low, high)
    axes.set_aspect("equal")
    axes.locator_params(nbins=5)
    axes.set(xlabel="x, m", ylabel="y, m", zlabel="z, m")


def _add(axes: Any, body: Body, at: pin.SE3, colour: tuple[float, float, float], opacity: float) -> NDArray[np.float64]:
    """Draw a body whose joint is at a placement; its corners (k, 3) in the world."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    vertices, triangles = surface(body.solid.hull)
    M = at * body.placement
    corners: NDArray[np.float64] = vertices @ M.rotation.T + M.translation
    faces = corners[triangles]  # (m, 3, 3)
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    bright = 0.65 + 0.35 * np.abs(normals @ LIGHT)
    axes.add_collection3d(Poly3DCollection(faces, facecolors=np.outer(bright, colour).clip(0.0, 1.0), alpha=opacity))
    return corners


def _add_axes(axes: Any, pose: pin.SE3) -> NDArray[np.float64]:
    """Draw the axes of a pose, in front of everything; their ends (3, 3)."""
    ends: NDArray[np.float64] = pose.translation + LENGTH * pose.rotation.T
    for end, colour in zip(ends, AXES, strict=True):
        axes.plot(*np.array([pose.translation, end]).T, color=colour, linewidth=2.5, zorder=1e6)
    return ends
