"""An obstacle: a shape, where it stands, and what may touch it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.collision.shapes import Shape
from pin_metaik.errors import InvalidGeometry, InvalidTarget
from pin_metaik.kinematics.pose import as_pose, as_position


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A solid that stands in the world.

    Attributes:
        name: A name that no link and no other obstacle has.
        shape: Its shape.
        pose: Where it stands: ``pin.SE3``, (4, 4), or a position (3,); kept as ``pin.SE3``.
        touching: Names of links and obstacles that may touch it.

    Raises:
        InvalidGeometry: If the name is empty, the shape is none, or the pose is not finite and orthonormal.
    """

    name: str
    shape: Shape
    pose: pin.SE3
    touching: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        if not isinstance(self.name, str) or not self.name:
            raise InvalidGeometry(f"an obstacle has a name, got {self.name!r}")
        if not isinstance(self.shape, Shape):
            raise InvalidGeometry(f"the shape of {self.name!r} is a Box, Sphere, ... or Mesh, got {self.shape!r}")
        object.__setattr__(self, "pose", placement(self.name, self.pose))
        object.__setattr__(self, "touching", tuple(self.touching))


def placement(name: str, pose: pin.SE3 | ArrayLike) -> pin.SE3:
    """The pose of the obstacle ``name``: a ``pin.SE3``, (4, 4), or a position (3,) without rotation.

    Raises:
        InvalidGeometry: If it is not finite or not orthonormal.
    """
    try:
        if isinstance(pose, pin.SE3) or np.shape(pose) != (3,):
            return as_pose(pose).placement
        return pin.SE3(np.eye(3), as_position(pose))
    except InvalidTarget as error:
        raise InvalidGeometry(f"the pose of {name!r}: {error}") from None
