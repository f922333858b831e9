"""Occupancy grids to polygons: numpy arrays, ``.npy`` files and the maps of ROS (an image and its YAML)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage
from shapely import affinity

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import read_array
from pin_metaik.mobile.world.polygons import FARTHEST
from pin_metaik.mobile.world.ros_maps import OCCUPIED, read_ros_map
from pin_metaik.optimize.settings import one_of, whole

Unknown = Literal["blocked", "free"]


@checked
@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """Square cells that are free or occupied. There is no passage between occupied cells that touch at a corner.

    Attributes:
        occupied: (rows, columns) row 0 is the lowest: cell (r, c) begins at (c, r) times the resolution.
        resolution: Width of a cell in m.
        origin: Pose (x, y, yaw) of the lower left corner of cell (0, 0), in m and rad.
    """

    occupied: NDArray[np.bool_]
    resolution: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.occupied.ndim != 2 or self.occupied.size == 0:
            raise InvalidGeometry(
                f"an occupancy grid has rows and columns, got an array of shape {self.occupied.shape}"
            )
        if not (self.resolution > 0 and all(map(math.isfinite, (self.resolution, *self.origin)))):
            raise InvalidGeometry(
                f"an occupancy grid has cells wider than 0 at a finite pose, got {self.resolution}, {self.origin}"
            )
        if not self.resolution * sum(self.occupied.shape) + abs(self.origin[0]) + abs(self.origin[1]) <= FARTHEST:
            raise InvalidGeometry(
                f"an occupancy grid is within {FARTHEST:g} m; {self.occupied.shape} cells of "
                f"{self.resolution:g} m are not"
            )

    @cached_property
    def polygons(self) -> tuple[shapely.Polygon, ...]:
        """The occupied cells as as few polygons as possible; with the regions beyond the corners of a rotated grid."""
        parts = [self._placed(part) for part in _outlined(self.occupied)]
        if self.origin[2]:
            sheet = self._placed(self._sheet)
            parts = [*shapely.get_parts(shapely.union_all([*parts, shapely.box(*sheet.bounds).difference(sheet)]))]
        return tuple(part for part in parts if part.area > 0)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The grid's box (x_min, y_min, x_max, y_max) in m."""
        x_min, y_min, x_max, y_max = self._placed(self._sheet).bounds
        return x_min, y_min, x_max, y_max

    @checked
    def without_specks(self, cells: int) -> OccupancyGrid:
        """The grid without groups of fewer than ``cells`` occupied cells, joined along edges or at corners.

        Args:
            cells: The least number of cells of an obstacle, at least 1.

        Raises:
            InvalidSetting: A number below 1.
        """
        whole("cells", cells, 1)
        groups, _ = ndimage.label(self.occupied, structure=np.ones((3, 3)))
        sizes = np.bincount(groups.ravel())
        return replace(self, occupied=self.occupied & (sizes[groups] >= cells))

    @property
    def _sheet(self) -> shapely.Polygon:
        rows, columns = self.occupied.shape
        return shapely.box(0, 0, columns, rows)

    def _placed(self, region: shapely.Geometry) -> shapely.Geometry:
        """From cells to metres."""
        x, y, yaw = self.origin
        cos, sin = self.resolution * math.cos(yaw), self.resolution * math.sin(yaw)
        return affinity.affine_transform(region, (cos, -sin, sin, cos, x, y))


@checked
def grid_of(
    values: ArrayLike,
    *,
    threshold: float = 0.0,
    unknown: Unknown = "blocked",
    unknown_blocks: bool | None = None,
    resolution: float = 1.0,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> OccupancyGrid:
    """A grid from an array, row 0 the lowest.

    Args:
        values: (rows, columns); cells above the threshold are occupied, cells below zero or NaN are unknown.
        threshold: Cells above it are occupied: 0 for masks, 65 for the message ``nav_msgs/OccupancyGrid``, whose values
            are percentages.
        unknown: Whether unknown cells are ``"blocked"`` or ``"free"``.
        unknown_blocks: The older form of ``unknown``: True for ``"blocked"``, False for ``"free"``.
        resolution: Width of a cell in m.
        origin: Pose (x, y, yaw) of the lower left corner, in m and rad.

    Raises:
        InvalidGeometry: Not a table of numbers, or cells without width.
        InvalidSetting: Unknown cells that are neither blocked nor free.
    """
    numbers = array("an occupancy grid", values, "rows", "columns", error=InvalidGeometry, finite=False)
    blocks = _blocks(unknown, unknown_blocks)
    return OccupancyGrid(np.where(numbers >= 0, numbers > threshold, blocks), resolution, origin)


@checked
def read_grid(
    path: str | Path,
    *,
    unknown: Unknown = "blocked",
    unknown_blocks: bool | None = None,
    threshold: float | None = None,
    resolution: float | None = None,
) -> OccupancyGrid:
    """A grid from a file: ``.npy`` (row 0 the lowest) or the ``.yaml`` of a ROS map next to its image.

    Args:
        path: The file.
        unknown: Whether unknown cells are ``"blocked"`` or ``"free"``.
        unknown_blocks: The older form of ``unknown``: True for ``"blocked"``, False for ``"free"``.
        threshold: Cells above it are occupied. Default: 0 for a ``.npy``; 99 for a ROS map, whose values are
            percentages: then only certainly occupied cells count, as in nav2's static layer (maps of mode ``scale``
            have values between).
        resolution: Width of a cell of a ``.npy`` in m, default 1. A ROS map has its own.

    Raises:
        InvalidGeometry: The file is missing, or is not a grid.
        InvalidSetting: Unknown cells that are neither blocked nor free, or a resolution for a ROS map.
        MissingExtra: PyYAML or Pillow is not installed.
    """
    path = Path(path)
    blocks: Unknown = "blocked" if _blocks(unknown, unknown_blocks) else "free"
    match path.suffix.lower():
        case ".npy":
            values = read_array(path, InvalidGeometry, "an occupancy grid")
            width = 1.0 if resolution is None else resolution
            return grid_of(values, threshold=threshold or 0.0, unknown=blocks, resolution=width)
        case ".yaml" | ".yml":
            if resolution is not None:
                raise InvalidGeometry(f"{path} has its own resolution: leave out resolution")
            ros = read_ros_map(path)
            above = OCCUPIED - 1 if threshold is None else threshold
            return grid_of(ros.cells, threshold=above, unknown=blocks, resolution=ros.resolution, origin=ros.origin)
    raise InvalidGeometry(f"cannot read {path}: an occupancy grid is a .npy file or the .yaml of a ROS map")


def _blocks(unknown: Unknown, unknown_blocks: bool | None) -> bool:
    one_of("unknown", unknown, Unknown)
    return unknown == "blocked" if unknown_blocks is None else bool(unknown_blocks)


def _outlined(occupied: NDArray[np.bool_]) -> NDArray[np.object_]:
    """Polygons over the occupied cells, in cells: one for each group joined along edges."""
    faces = shapely.get_parts(shapely.polygonize(shapely.linestrings(_outlines(occupied))))
    corners, face = shapely.get_coordinates(shapely.get_exterior_ring(faces), return_index=True)
    order = np.lexsort((corners[:, 1], corners[:, 0], face))
    first = order[np.searchsorted(face[order], np.arange(len(faces)))]  # the leftmost corner, of these the lowest
    column, row = corners[first].astype(int).T  # of the cell above and right of it, which is inside
    return np.asarray(faces[occupied[row, column]])


def _outlines(occupied: NDArray[np.bool_]) -> Array:
    """Straight lines (n, 2, 2) between occupied and free cells, as long as possible; they meet at their ends only."""
    padded = np.pad(occupied, 1)
    flat = np.pad(padded[1:, 1:-1] != padded[:-1, 1:-1], ((0, 0), (1, 1)))  # [y, x + 1]: a line from (x, y) on to x + 1
    upright = np.pad(padded[1:-1, 1:] != padded[1:-1, :-1], ((1, 1), (0, 0)))
    corner = (flat[:, :-1] | flat[:, 1:]) & (upright[:-1] | upright[1:])  # [y, x]
    along = _between_corners(corner, flat[:, 1:])
    up = _between_corners(corner.T, upright[1:].T)
    return np.concatenate((along, up[:, :, ::-1])).astype(float)


def _between_corners(corner: NDArray[np.bool_], line: NDArray[np.bool_]) -> NDArray[np.int64]:
    """From each corner [y, x] that a line [y, x] begins at to the next one in its row: (n, 2, 2) as x, y."""
    y, x = np.nonzero(corner)
    begins = np.flatnonzero(line[y, x])  # the last corner of a row begins no line
    return np.stack((np.column_stack((x, y))[begins], np.column_stack((x, y))[begins + 1]), axis=1)
