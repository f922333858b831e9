"""Looking at a world in the browser, through Pinocchio's viser visualizer: an extra."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from pin_metaik.collision.mesh import convex_hull
from pin_metaik.collision.obstacle import Obstacle
from pin_metaik.collision.world import CollisionWorld
from pin_metaik.errors import MissingExtra
from pin_metaik.kinematics.model import frame_id

WOOD, HELD = np.array([0.72, 0.53, 0.35, 1.0]), np.array([0.2, 0.5, 0.3, 1.0])  # red, green, blue, opacity
SHEET = 3.0  # m; how much of a plane is drawn


def open_viewer(world: CollisionWorld, port: int = 8080) -> Any:
    """Show a world, as it is now, at http://localhost:port; a robot without ``visual_model`` by its collision geometry.

    Returns:
        A ``pinocchio.visualize.ViserVisualizer``: its ``display(q)`` moves the robot, its ``viewer`` is the server.

    Raises:
        MissingExtra: If viser, trimesh or pycollada is not installed.
    """
    if not all(find_spec(name) for name in ("viser", "trimesh", "collada")):
        raise MissingExtra("looking at a world", "viewer")
    import viser
    from pinocchio.visualize import ViserVisualizer

    viewer = ViserVisualizer(world.model, world.robot.collision_model, _scene(world))
    viewer.initViewer(viser.ViserServer(port=port), loadModel=True)
    viewer.display(pin.neutral(world.model))
    return viewer


def _scene(world: CollisionWorld) -> pin.GeometryModel:
    """What the robot looks like, what it holds and what stands around."""
    scene = getattr(world.robot, "visual_model", world.robot.collision_model).clone()
    for obstacle in world.obstacles:
        _draw(scene, obstacle, 0, obstacle.pose, WOOD)
    for held, name in world.grasped:
        frame = world.model.frames[frame_id(world.model, name)]
        _draw(scene, held, int(frame.parentJoint), frame.placement * held.pose, HELD)
    return scene


def _draw(scene: pin.GeometryModel, obstacle: Obstacle, joint: int, at: pin.SE3, colour: Any) -> None:
    shape, offset = _drawable(obstacle.shape.geometry())
    piece = pin.GeometryObject(obstacle.name, joint, at * offset, shape)
    piece.meshColor = colour
    scene.addGeometryObject(piece)


def _drawable(shape: Any) -> tuple[Any, pin.SE3]:
    """A shape that the visualizer knows, and its placement: hulls for round ones, a sheet for planes."""
    here = pin.SE3.Identity()
    match shape:
        case coal.Halfspace() | coal.Plane():
            turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), shape.n).matrix()
            return coal.Box(SHEET, SHEET, 1e-3), pin.SE3(turn, (shape.d - 1e-3) * shape.n)
        case coal.Capsule():
            directions = _directions()
            ends = np.sign(directions[:, 2:]) * [0.0, 0.0, shape.halfLength]
            return convex_hull(shape.radius * directions + ends), here
        case coal.Cone():
            angles = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
            rim = np.stack([np.cos(angles), np.sin(angles), np.zeros(32)], axis=1) * shape.radius
            tip = np.array([[0.0, 0.0, shape.halfLength]])
            return convex_hull(np.concatenate([rim - tip, tip])), here
        case coal.BVHModelBase():
            return convex_hull(np.array(shape.vertices())), here
        case _:
            return shape, here


def _directions() -> Any:
    """Unit vectors (k, 3) all around."""
    polar, around = np.meshgrid(np.linspace(0.0, np.pi, 12), np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False))
    flat = polar.ravel(), around.ravel()
    return np.stack([np.sin(flat[0]) * np.cos(flat[1]), np.sin(flat[0]) * np.sin(flat[1]), np.cos(flat[0])], axis=1)
