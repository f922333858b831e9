"""An obstacle: a shape, where it stands, and what may touch it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.collision.numbers import real, three
from pin_metaik.collision.shapes import Shape
from pin_metaik.errors import InvalidGeometry, InvalidTarget
from pin_metaik.kinematics.pose import as_pose
from pin_metaik.optimize.space import Box as SearchBox


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A solid that stands in the world.

    Attributes:
        name: A name that no link and no other obstacle has.
        shape: Its shape.
        pose: Where it stands: ``pin.SE3``, (4, 4), or a position (3,); kept as ``pin.SE3``. Default: the origin.
        touching: Names of links and obstacles that may touch it: these pairs are not checked.
        padding: Distance that is added to the world's margin, m: one for all its pairs, or a mapping from names of
            links and obstacles. One given by name replaces the sum of the paddings of the two bodies.

    Raises:
        InvalidGeometry: If the name is empty, the shape is not one of ``Shape``, the pose is not finite and
            orthonormal, ``touching`` is not a list of names, a padding is not a distance of at least 0 m, or a body in
            ``touching`` has a padding.
    """

    name: str
    shape: Shape
    pose: pin.SE3 = (0.0, 0.0, 0.0)
    touching: tuple[str, ...] = ()
    padding: float | Mapping[str, float] = 0.0

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        if not isinstance(self.name, str) or not self.name:
            raise InvalidGeometry(f"an obstacle has a name, got {self.name!r}")
        if isinstance(self.shape, SearchBox):
            raise InvalidGeometry(
                f"the shape of {self.name!r} is a mik.Box, the bounds of a search; a solid one is "
                "a mik.collision.Box(size)"
            )
        if not isinstance(self.shape, Shape):
            raise InvalidGeometry(f"the shape of {self.name!r} is a Box, Sphere, ... or Mesh, got {self.shape!r}")
        object.__setattr__(self, "pose", placement(self.name, self.pose))
        object.__setattr__(self, "touching", _names(self.name, self.touching))
        object.__setattr__(self, "padding", _padding(self.name, self.padding))
        if isinstance(self.padding, Mapping) and (both := set(self.padding).intersection(self.touching)):
            raise InvalidGeometry(
                f"{min(both)!r} is both in touching and in padding of {self.name!r}: take it out of one"
            )


def _names(name: str, touching: Iterable[str]) -> tuple[str, ...]:
    try:
        names = (None,) if isinstance(touching, str | Mapping) else tuple(touching)
    except (TypeError, RuntimeError):  # the latter of what Pinocchio wraps and cannot list
        names = (None,)
    if not all(isinstance(one, str) for one in names):
        raise InvalidGeometry(f"touching of {name!r} is a list of names, got {touching!r}")
    return cast(tuple[str, ...], names)


def _padding(name: str, padding: object) -> float | dict[str, float]:
    if isinstance(padding, Mapping):
        distances = {other: real(distance) for other, distance in padding.items()}
        if name not in distances and all(
            isinstance(other, str) and 0.0 <= distances[other] < math.inf for other in distances
        ):
            return distances
    elif 0.0 <= real(padding) < math.inf:
        return real(padding)
    raise InvalidGeometry(
        f"the padding of {name!r} is a finite distance of at least 0 m, or one for each of other names, got {padding!r}"
    )


def placement(name: str, pose: pin.SE3 | ArrayLike) -> pin.SE3:
    """The pose of the obstacle ``name``: a ``pin.SE3``, (4, 4), or a position (3,) without rotation.

    Raises:
        InvalidGeometry: If it is not finite or not orthonormal.
    """
    position = None if isinstance(pose, pin.SE3) else three(pose)
    if position is not None:
        return pin.SE3(np.eye(3), np.array(position))
    try:
        return as_pose(pose).placement
    except (InvalidTarget, OverflowError) as error:
        raise InvalidGeometry(f"the pose of {name!r} is a pose or a position (3,), finite: {error}") from None
