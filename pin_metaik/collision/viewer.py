"""A world in the browser, by Pinocchio's viser visualizer (the extra ``viewer``)."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from typing import Any

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray
from pinocchio.visualize import ViserVisualizer

from pin_metaik.collision.drawing import surface
from pin_metaik.collision.obstacle import Obstacle, placement
from pin_metaik.collision.world import CollisionWorld
from pin_metaik.errors import FrameNotFound, InvalidSetting
from pin_metaik.lookup import need

__all__ = ["WorldViewer", "open_viewer"]

WOOD, HELD = np.array([0.72, 0.53, 0.35, 1.0]), np.array([0.2, 0.5, 0.3, 1.0])  # red, green, blue, opacity
RED = np.array([0.85, 0.12, 0.1])
FIELD = math.radians(40.0)  # vertical field of view
BESIDE, ABOVE = math.radians(-138.0), math.radians(22.0)  # of the camera, against what stands in front of the robot
AXES = 0.12  # m, length of the axes of frames
ENDLESS = coal.Halfspace, coal.Plane
PAUSE, SAME = 0.5, 3  # s between two looks at a page, and how many must be the same


class WorldViewer(ViserVisualizer):  # type: ignore[misc]  # Pinocchio has no types
    """A ``pinocchio.visualize.ViserVisualizer`` of a world: colliding bodies are red, frames and targets have axes.

    Attributes:
        viewer: The ``viser.ViserServer``.
    """

    def __init__(self, world: CollisionWorld, server: Any, frame: str | None) -> None:
        scene, owners = _scene(world)
        super().__init__(world.model, world.robot.collision_model, scene)
        self._world, self._frame, self._owners = world, frame, owners
        self._red: dict[str, Any] = {}  # red twins, by piece
        self.initViewer(server, loadModel=True)
        if frame is not None:
            self._tip = server.scene.add_frame("frame", axes_length=AXES, axes_radius=AXES / 24.0)
        self.display(pin.neutral(world.model))
        self._look()

    def display(self, q: ArrayLike | None = None) -> None:
        """Move the robot to configuration q (nq,), and make red what collides there."""
        super().display(None if q is None else np.asarray(q, dtype=float))
        if q is None:
            return
        with self.viewer.atomic():
            if self._frame is not None:
                pin.updateFramePlacements(self.model, self.data)
                _put(self._tip, self.data.oMf[self.model.getFrameId(self._frame)])
            self._redden({name for contact in self._world.pairs_in_collision(q) for name in contact[:2]})

    def show_target(self, pose: pin.SE3 | ArrayLike, name: str = "target") -> None:
        """Draw the axes of a pose, or of a position (3,); they stay until drawn elsewhere under the same name.

        Raises:
            InvalidGeometry: If the pose is not finite and orthonormal.
        """
        at = placement(name, pose)
        _put(self.viewer.scene.add_frame(f"target/{name}", axes_length=AXES, axes_radius=AXES / 12.0), at)

    def picture(self, width: int = 960, height: int = 720, timeout: float = 60.0) -> NDArray[np.uint8]:
        """The image in the first browser, once it has drawn everything: red, green and blue (height, width, 3).

        Args:
            width: In pixels.
            height: In pixels.
            timeout: How long to wait for a browser, and for its page to be the same three times in a row, s.

        Raises:
            InvalidSetting: If no browser looks, or its page does not come to rest in time.
        """
        end = time.monotonic() + timeout
        while not self.viewer.get_clients():
            if time.monotonic() > end:
                raise InvalidSetting(
                    f"no browser has opened http://localhost:{self.viewer.get_port()} in {timeout:g} s"
                )
            time.sleep(PAUSE)
        client = next(iter(self.viewer.get_clients().values()))
        seen: list[NDArray[np.uint8]] = []
        while len(seen) < SAME:
            image = np.asarray(client.get_render(height=height, width=width, timeout=timeout))[..., :3]
            still = image.std() > 1.0 and (not seen or np.abs(image.astype(float) - seen[-1]).mean() < 0.05)
            seen = [*seen, image] if still else [image] if image.std() > 1.0 else []
            if len(seen) < SAME and time.monotonic() > end:
                raise InvalidSetting(f"the page does not come to rest in {timeout:g} s")
            time.sleep(PAUSE)
        return seen[-1]

    def loadViewerGeometryObject(self, geometry_object: Any, prefix: str = "", color: Any = None) -> None:
        """Draw what Pinocchio's visualizer draws as it does, and the rest as triangles."""
        shape = geometry_object.geometry
        if geometry_object.meshPath or isinstance(shape, coal.Box | coal.Sphere | coal.Cylinder):
            with suppress(Exception):  # trimesh stumbles, in many ways, over files that coal has read
                super().loadViewerGeometryObject(geometry_object, prefix, color)
                return
        name = f"{prefix}/{geometry_object.name}"
        red, green, blue, opacity = geometry_object.meshColor if color is None else color
        vertices, triangles = surface(shape)
        self.frames[name] = self.viewer.scene.add_mesh_simple(
            name, vertices, triangles, color=(red, green, blue), opacity=opacity, flat_shading=True
        )

    def _redden(self, names: set[str]) -> None:
        """Show the red twins of the bodies of these names, and of the others the pieces themselves."""
        for piece in self.visual_model.geometryObjects:
            key, collides = f"{self.visualRootNodeName}/{piece.name}", self._owners[piece.name] in names
            if collides and piece.name not in self._red:
                vertices, triangles = surface(piece.geometry)
                self._red[piece.name] = self.viewer.scene.add_mesh_simple(
                    f"red/{piece.name}", vertices, triangles, color=RED, flat_shading=True
                )
            self.frames[key].visible = not collides
            if piece.name in self._red:
                twin = self._red[piece.name]
                twin.visible, twin.position, twin.wxyz = collides, self.frames[key].position, self.frames[key].wxyz

    def _look(self) -> None:
        """Let a page open with all of the robot and of what stands around in sight, seen from the robot's side."""
        robot, around = self._corners(robot=True), self._corners(robot=False)
        points = np.concatenate([robot, around])
        low, high = points.min(axis=0), points.max(axis=0)
        centre, radius = 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))
        ahead = around.mean(axis=0) - robot.mean(axis=0) if len(around) else np.array([-1.0, 0.0, 0.0])
        angle = math.atan2(ahead[1], ahead[0]) + BESIDE
        direction = [math.cos(ABOVE) * math.cos(angle), math.cos(ABOVE) * math.sin(angle), math.sin(ABOVE)]
        camera = self.viewer.initial_camera
        camera.fov, camera.look_at = FIELD, centre
        camera.position = centre + 0.86 * radius / math.sin(0.5 * FIELD) * np.array(direction)

    def _corners(self, robot: bool) -> NDArray[np.float64]:
        """Corners (k, 3) of the boxes around the robot's pieces, or around what stands around; without planes."""
        links = {frame.name for frame in self.model.frames}
        boxes = [np.empty((0, 3))]
        for number, piece in enumerate(self.visual_model.geometryObjects):
            if (self._owners[piece.name] in links) == robot and not isinstance(piece.geometry, ENDLESS):
                piece.geometry.computeLocalAABB()
                box, M = piece.geometry.aabb_local, self.visual_data.oMg[number]
                ends = np.stack([box.min_, box.max_])
                corners = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(-1, 3)
                boxes.append(corners @ M.rotation.T + M.translation)
        return np.concatenate(boxes)


def open_viewer(world: CollisionWorld, port: int = 8080, frame: str | None = None) -> WorldViewer:
    """Show a world, as it is now, at http://localhost:port, to this machine only; colliding bodies are red.

    A robot without a ``visual_model`` is shown by its collision geometry.

    Args:
        world: The world.
        port: The port; 0 for any free port.
        frame: A frame of the robot whose axes are drawn, such as its tip.

    Returns:
        A ``pinocchio.visualize.ViserVisualizer``: its ``display(q)`` moves the robot, its ``viewer`` is the server,
        ``show_target(pose)`` draws axes, ``picture()`` is what a browser sees.

    Raises:
        MissingExtra: If viser, trimesh or pycollada is not installed.
        FrameNotFound: If the robot has no such frame.
    """
    need("looking at a world", "viewer", "viser", "trimesh", "collada")
    if frame is not None and not world.model.existFrame(frame):
        raise FrameNotFound(frame, {f.name for f in world.model.frames} - {"universe"})
    import viser

    return WorldViewer(world, viser.ViserServer(host="127.0.0.1", port=port), frame)


def _scene(world: CollisionWorld) -> tuple[pin.GeometryModel, dict[str, str]]:
    """The pieces to draw of the robot, of grasped objects and of obstacles, and the body of each piece by name.

    A link without visual geometry is drawn by its collision geometry.
    """
    frames, seen = world.model.frames, getattr(world.robot, "visual_model", None)
    scene = pin.GeometryModel() if seen is None else seen.clone()
    owners = {piece.name: frames[piece.parentFrame].name for piece in scene.geometryObjects}
    visible = set(owners.values())
    for piece in world.robot.collision_model.geometryObjects:
        link = frames[piece.parentFrame].name
        if link not in visible:
            scene.addGeometryObject(piece)
            owners[piece.name] = link
    for obstacle in world.obstacles:
        _draw(scene, obstacle, 0, obstacle.pose, WOOD)
    for held, name in world.grasped:
        frame = frames[world.model.getFrameId(name)]
        _draw(scene, held, int(frame.parentJoint), frame.placement * held.pose, HELD)
    others = (*world.obstacles, *(held for held, _ in world.grasped))
    return scene, owners | {obstacle.name: obstacle.name for obstacle in others}


def _draw(scene: pin.GeometryModel, obstacle: Obstacle, joint: int, at: pin.SE3, colour: NDArray[np.float64]) -> None:
    piece = pin.GeometryObject(obstacle.name, joint, at, obstacle.shape.geometry())
    piece.meshColor = colour
    scene.addGeometryObject(piece)


def _put(frame: Any, M: pin.SE3) -> None:
    frame.position, frame.wxyz = M.translation, pin.Quaternion(M.rotation).coeffs()[[3, 0, 1, 2]]
