"""The goal of a centre of mass over a support polygon, or at a height."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import Bounded
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.vectors import check_range
from pin_metaik.kinematics import Chain


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class CentreOfMass(Bounded):
    """The centre of mass c of the robot over a convex polygon on the ground, between two heights: y = (N c_xy, c_z).

    A robot at rest does not tip over while its centre of mass is over the polygon of its contacts with level ground.
    The rows of N are the outward normals of the polygon's edges.

    Attributes:
        polygon: Points (k, 2) on the ground, m, of which the convex hull is taken; ``None``: anywhere.
        margin: How far (m) from the edges of the polygon the centre of mass keeps inside.
        least: The least height, m.
        most: The largest height, m.

    Raises:
        InvalidTarget: If there is neither a polygon nor a height, the polygon has no area, the margin is negative or
            leaves nothing of the polygon, or ``least`` is above ``most``.
    """

    polygon: ArrayLike | None = None
    _: KW_ONLY
    margin: float = 0.0
    least: float = -math.inf
    most: float = math.inf
    _edges: Array = field(init=False, repr=False)  # (e, 3) outward normals, and how far along them the edges are
    _range: tuple[Array, Array] = field(init=False, repr=False)  # (e + 1,) bounds of y

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        if self.polygon is None or (self.least, self.most) != (-math.inf, math.inf):
            check_range("the height", self.least, self.most)
        edges = np.empty((0, 3))
        if self.polygon is not None:
            polygon = array("polygon", self.polygon, "k", 2, error=InvalidTarget)
            edges = _edges_of(polygon, self.margin)
            object.__setattr__(self, "polygon", polygon.copy())
        object.__setattr__(self, "_edges", edges)
        least = np.append(np.full(len(edges), -math.inf), self.least)
        object.__setattr__(self, "_range", (least, np.append(edges[:, 2], self.most)))

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            InvalidTarget: If the robot has no mass.
        """
        if not sum(inertia.mass for inertia in chain.model.inertias) > 0.0:
            raise InvalidTarget(f"the links of {chain.model.name!r} have no mass, and so no centre of mass")

    def _values(self, at: Placed) -> Array:
        c = at.centre_of_mass
        return np.append(self._edges[:, :2] @ c[:2], c[2])

    def _slopes(self, at: Placed) -> Array:
        J = at.centre_of_mass_jacobian
        return np.concatenate([self._edges[:, :2] @ J[:2], J[2:]])

    def _bounds(self, at: Placed) -> tuple[Array, Array]:
        return self._range


def _edges_of(polygon: Array, margin: float) -> Array:
    """The edges (e, 3) of the convex hull of points (k, 2), moved inward: unit normals N and b, N c <= b inside.

    Raises:
        InvalidTarget: If the hull has no area, or nothing of it is left.
    """
    from scipy.optimize import linprog  # takes a fifth of a second to import
    from scipy.spatial import ConvexHull, QhullError

    if not 0.0 <= margin < math.inf:
        raise InvalidTarget(f"margin is a number of at least 0, got {margin!r}")
    try:
        normals, offsets = np.split(ConvexHull(polygon).equations, [2], axis=1)
    except (QhullError, ValueError):
        raise InvalidTarget(
            f"a polygon has an area: at least three points that are not in a line, got {polygon}"
        ) from None
    # the largest circle inside: its radius is how far the edges may move inward
    circle = linprog([0.0, 0.0, -1.0], np.append(normals, np.ones_like(offsets), axis=1), -offsets, bounds=(None, None))
    if margin > circle.x[2]:
        raise InvalidTarget(
            f"a margin of {margin:g} m leaves nothing of this polygon: it is at most {circle.x[2]:.3g} m"
        )
    return np.append(normals, -offsets - margin, axis=1)
