"""Bodies: the pieces of geometry that a world checks against each other: links, grasped objects and obstacles."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.arguments import shown
from pin_metaik.collision.cache import where_kept
from pin_metaik.collision.extent import stand
from pin_metaik.collision.simplify import Simplify, Solid, solid_of
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.kinematics.model import model_of
from pin_metaik.notice import notice
from pin_metaik.said import warn


class VisualGeometry(UserWarning):
    """A robot without collision geometry, which is checked by its visual geometry."""


@dataclass(frozen=True, eq=False)
class Body:
    """A solid that a joint carries, or that stands in the world (joint 0).

    Attributes:
        link: Name of the link, obstacle or grasped object it belongs to.
        joint: Id of the joint that carries it.
        placement: In that joint's frame.
        solid: Its geometry.
        part: Whether it is a part of the robot, as opposed to an obstacle or a grasped object.
    """

    link: str
    joint: int
    placement: pin.SE3
    solid: Solid
    part: bool = False

    @cached_property
    def at(self) -> Any:
        """Its placement as coal takes it, ``coal.Transform3s``."""
        return coal.Transform3s(self.placement.rotation, self.placement.translation)

    @cached_property
    def row(self) -> NDArray[np.float64]:
        """(12,) its placement as numbers: rotation column by column, then translation."""
        return np.concatenate([self.placement.rotation.ravel(order="F"), self.placement.translation])

    @cached_property
    def stood(self) -> NDArray[np.float64]:
        """(16,) its box in the joint's frame, as ``boxes.near`` takes what stands, but for the padding."""
        return stand(self.solid.original, self.solid.box, self.row)


class Geometry(Protocol):
    """Attributes of a robot that a world reads: a ``Robot`` has them, or any object with a model and its geometry."""

    @property
    def name(self) -> str:
        """What to call it."""
        ...

    @property
    def model(self) -> pin.Model:
        """Its model."""
        ...

    @property
    def collision_model(self) -> pin.GeometryModel:
        """Its collision geometry."""
        ...

    @property
    def srdf(self) -> Path | None:
        """File with disabled collisions, or None."""
        ...


@dataclass(frozen=True)
class _Wrapped:
    """Pinocchio's ``RobotWrapper``, and what it has no word for."""

    name: str
    model: pin.Model
    collision_model: pin.GeometryModel
    srdf: Path | None = None


def geometry_of(robot: Geometry) -> Geometry:
    """The attributes of a robot that a world reads, also of Pinocchio's ``RobotWrapper``.

    Raises:
        InvalidSetting: Neither a robot nor anything that has its geometry.
    """
    model = model_of(robot)
    if isinstance(robot, pin.Model) or not hasattr(robot, "collision_model"):
        raise InvalidSetting(f"a world needs a robot's geometry, e.g. mik.load_robot('panda'), got {shown(robot)}")
    if hasattr(robot, "srdf") and hasattr(robot, "name"):
        return robot
    return _Wrapped(model.name, model, robot.collision_model)


def robot_bodies(robot: Geometry, simplify: Simplify, visual: bool = True) -> tuple[Body, ...]:
    """The pieces of a robot's collision geometry; where it has none, of its ``visual`` geometry, which a warning says.

    Raises:
        InvalidGeometry: If it has neither: then nothing it does could be called free of collisions; or if a piece is
            not finite or empty; the message names it.
        InvalidModel: If a mesh is missing or unreadable.
    """
    pieces = _pieces(robot, visual)
    bodies = []
    meshes = sum(isinstance(piece.geometry, coal.BVHModelBase) for piece in pieces)
    with notice(f"simplifying {meshes} meshes of {robot.name}, once; {where_kept()}", len(pieces)) as line:
        for piece in pieces:
            link = robot.model.frames[piece.parentFrame].name
            of = f" ({piece.meshPath})" if piece.meshPath else ""
            _check(piece.geometry, f"the piece {piece.name!r}{of} of the link {link!r} of {robot.name}")
            solid = solid_of(piece.geometry, simplify)
            bodies.append(Body(link, int(piece.parentJoint), pin.SE3(piece.placement), solid, part=True))
            line.step()
    return tuple(bodies)


def _pieces(robot: Geometry, visual: bool) -> list[Any]:
    """Geometry objects of Pinocchio: the robot's collision geometry, else, if wanted, its visual geometry."""
    with notice(f"reading the geometry of {robot.name}"):
        pieces = list(robot.collision_model.geometryObjects)
        if pieces:
            return pieces
        if not visual:
            raise InvalidGeometry(
                f"{robot.name} has no collision geometry, and visual=False leaves out its visual geometry"
            )
        seen = getattr(robot, "visual_model", None)
        pieces = [] if seen is None else list(seen.geometryObjects)
    if not pieces:
        raise InvalidGeometry(f"{robot.name} has no collision geometry and no visual geometry: nothing to check")
    text = f"{robot.name} has no collision geometry: its visual geometry is checked for collisions instead"
    warn(text, VisualGeometry)
    return pieces


def _check(geometry: Any, name: str) -> None:
    """Refuse what takes coal's hulls and trees down, or makes them say that nothing is near."""
    if isinstance(geometry, coal.BVHModelBase) and not (geometry.num_vertices and geometry.num_tris):
        raise InvalidGeometry(f"{name} is a mesh without triangles")
    if isinstance(geometry, coal.BVHModelBase | coal.Convex):
        corners = np.array(geometry.vertices() if isinstance(geometry, coal.BVHModelBase) else geometry.points())
        if not np.isfinite(corners).all():
            raise InvalidGeometry(f"{name} has vertices that are not finite")
        if not np.ptp(corners, axis=0).any():
            raise InvalidGeometry(f"{name} is a mesh without size: its {len(corners)} vertices are one point")
    elif not isinstance(geometry, coal.Plane | coal.Halfspace):
        geometry.computeLocalAABB()
        if not (np.isfinite(geometry.aabb_local.max_) & (geometry.aabb_local.max_ >= geometry.aabb_local.min_)).all():
            raise InvalidGeometry(f"{name} has sizes below 0, or that are not finite")


def digest(model: pin.Model, bodies: tuple[Body, ...]) -> bytes:
    """What decides which bodies of a robot touch: its joints, limits, hulls and meshes."""
    content = hashlib.sha256(model.saveToString().encode())
    for body in bodies:
        content.update(f"{body.link} {body.joint}".encode() + body.placement.homogeneous.tobytes())
        hull, original = body.solid.hull, body.solid.original
        content.update(np.array(hull.points()).tobytes() if hasattr(hull, "points") else hull.saveToString().encode())
        if isinstance(original, coal.BVHModelBase):
            content.update(np.array(original.vertices()).tobytes())
    return content.digest()
