"""Results of a check of a configuration: bodies in collision and their depth, or the nearest bodies and points."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Contact(NamedTuple):
    """Two bodies nearer to each other than the margin.

    Attributes:
        first: Name of a link, obstacle or grasped object.
        second: Name of the other.
        depth: How far (m) the convex hulls of the two would have to be moved apart for the margin to be kept.
    """

    first: str
    second: str
    depth: float

    def __str__(self) -> str:
        return f"{self.first} with {self.second}, {1e3 * self.depth:.3g} mm deep"


@dataclass(frozen=True, eq=False)
class Distance:
    """The nearest two bodies.

    Attributes:
        distance: m; of bodies that overlap minus the depth to which their convex hulls do.
        first: Name of a link, obstacle or grasped object.
        second: Name of the other.
        point_first: (3,) the point of the first nearest to the second, in the world, m.
        point_second: (3,) the point of the second nearest to the first.
    """

    distance: float
    first: str
    second: str
    point_first: NDArray[np.float64] = field(repr=False)
    point_second: NDArray[np.float64] = field(repr=False)


class Near(NamedTuple):
    """Two bodies that are near each other, as a step needs them.

    Attributes:
        room: Distance beyond their margin, m; below 0 they collide.
        normal: (3,) unit vector from the first to the second, in the world.
        points: The nearest points (3,) of both, in the world, m.
        joints: Ids of the joints that carry them; 0 is the world.
    """

    room: float
    normal: NDArray[np.float64]
    points: tuple[NDArray[np.float64], NDArray[np.float64]]
    joints: tuple[int, int]
