"""Gaps without width, closed; and obstacles without width, left out: where the border of a region meets itself.

Whether there is a passage between two obstacles that touch, or between an obstacle and the wall it touches, must not
depend on how the scene was written down. Here there is none: a gap is a passage only if it is wider than rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.mobile.world.border import Border, Indices

NARROW = 2.0  # of what counts as touching: gaps narrower than this are closed, obstacles thinner than this are none
BLUNT = 1e-3  # half an angle, as a sine, below which the tip of an obstacle is as if cut off


@dataclass(frozen=True, eq=False)
class Contacts:
    """Where the border of a free region comes so near itself that what lies between has no width to speak of.

    Attributes:
        corners: Places (k, 2) at a gap, vertices of the border.
        sharpness: Sine of half the obstacle's angle at each of them (k,).
        slivers: Whether an obstacle is too thin to count somewhere.
    """

    corners: Array
    sharpness: Array
    slivers: bool

    @staticmethod
    def of(region: shapely.Geometry, touch: float) -> Contacts:
        """The contacts of a free region.

        Args:
            region: The free polygons.
            touch: How deep inside an obstacle still counts as touching it.
        """
        border = Border.of(region, touch / 100)
        vertex, edge = _near(border, NARROW * touch)
        a, along = border.vertices[edge], border.edges[edge]
        to = border.vertices[vertex] - a
        offset = (along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / np.hypot(along[:, 0], along[:, 1])
        across = offset < -border.slack  # the obstacle is between them: the free side is on the left
        gaps = np.unique(vertex[~across])
        return Contacts(border.vertices[gaps], _sharpness(border, gaps), bool(across.any()))

    def plugs(self, touch: float) -> NDArray[np.object_]:
        """Diamonds that close the gaps, so large that what is solid on both sides reaches into them."""
        reach = 2 * touch * (NARROW + 1 + 1 / np.maximum(self.sharpness, BLUNT))
        compass = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])
        return np.asarray(shapely.polygons(self.corners[:, None] + reach[:, None, None] * compass))


def opened(solid: shapely.Geometry, touch: float) -> shapely.Geometry:
    """The obstacles, without parts too thin to count."""
    core = solid.buffer(-touch, join_style="mitre")
    return core.buffer(touch, join_style="mitre")


def _near(border: Border, width: float) -> tuple[Indices, Indices]:
    """Vertices and edges (k,) that come nearer to each other than a width and are not neighbours along a ring."""
    lines = shapely.linestrings(np.stack((border.vertices, border.vertices[border.after]), axis=1))
    vertex, edge = shapely.STRtree(lines).query(shapely.points(border.vertices), predicate="dwithin", distance=width)
    beside = (edge == vertex) | (edge == border.before[vertex])
    return vertex[~beside], edge[~beside]


def _sharpness(border: Border, at: Indices) -> Array:
    """Sine of half the obstacle's angle at vertices (k,) of a free region's border."""
    u, v = border.edges[border.before[at]], border.edges[at]
    turn = np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1))
    return np.asarray(np.cos(turn / 2))
