"""Occupancy grids to polygons: numpy arrays, ``.npy`` files and the maps of ROS (PGM + YAML)."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import affinity

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidGeometry

PINCH = 0.01  # cells; where two occupied cells touch at a corner only, a square this wide closes the gap
MAP_KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")


@checked
@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """Square cells that are free or occupied.

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

    @property
    def polygons(self) -> tuple[shapely.Polygon, ...]:
        """The occupied cells as as few polygons as possible; what lies beyond the corners of a turned grid too."""
        rows, columns = self.occupied.shape
        pieces = [*_runs(self.occupied), *_pinches(self.occupied)]
        region = self._placed(shapely.union_all(pieces))
        if self.origin[2]:
            sheet = self._placed(shapely.box(0, 0, columns, rows))
            region = shapely.union(region, shapely.box(*sheet.bounds).difference(sheet))
        return tuple(part for part in shapely.get_parts(region) if part.area > 0)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The grid's box (x_min, y_min, x_max, y_max) in m."""
        rows, columns = self.occupied.shape
        x_min, y_min, x_max, y_max = self._placed(shapely.box(0, 0, columns, rows)).bounds
        return x_min, y_min, x_max, y_max

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
    unknown_blocks: bool = True,
    resolution: float = 1.0,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> OccupancyGrid:
    """A grid from an array, row 0 the lowest.

    Args:
        values: (rows, columns) cells above the threshold are occupied, those below zero (or NaN) unknown.
        threshold: 0 suits masks; 65 the message ``nav_msgs/OccupancyGrid``, whose numbers are percents.
        unknown_blocks: Whether unknown cells count as occupied.
        resolution: Width of a cell in m.
        origin: Pose (x, y, yaw) of the lower left corner, in m and rad.

    Raises:
        InvalidGeometry: Not a table of numbers, or cells without width.
    """
    numbers = array("an occupancy grid", values, "rows", "columns", error=InvalidGeometry, finite=False)
    unknown = ~(numbers >= 0)
    return OccupancyGrid(np.where(unknown, unknown_blocks, numbers > threshold), resolution, origin)


@checked
def read_grid(path: str | Path, *, unknown_blocks: bool = True) -> OccupancyGrid:
    """A grid from a file: ``.npy`` (cells of 1 m, row 0 the lowest) or the ``.yaml`` of a ROS map next to its PGM.

    Raises:
        InvalidGeometry: The file is missing, or is neither.
    """
    path = Path(path)
    try:
        match path.suffix.lower():
            case ".npy":
                return grid_of(np.load(path, allow_pickle=False), unknown_blocks=unknown_blocks)
            case ".yaml" | ".yml":
                return _ros_map(path, unknown_blocks)
    except OSError as error:
        raise InvalidGeometry(f"cannot read {error.filename or path}: {error.strerror}") from None
    except (ValueError, KeyError) as error:
        if isinstance(error, InvalidGeometry):
            raise
        raise InvalidGeometry(f"{path} is not an occupancy grid: {error}") from None
    raise InvalidGeometry(f"cannot read {path}: an occupancy grid is a .npy file or the .yaml of a ROS map")


def _ros_map(path: Path, unknown_blocks: bool) -> OccupancyGrid:
    """``map_server``'s trinary map: darkness above `occupied_thresh` is occupied, below `free_thresh` free."""
    settings = _flat_yaml(path.read_text(encoding="utf-8-sig"))
    missing = [key for key in MAP_KEYS if key not in settings]
    if missing:
        raise InvalidGeometry(f"{path} is not the YAML of a ROS map: it has no {', '.join(missing)}")
    if settings.get("mode", "trinary") != "trinary":
        raise InvalidGeometry(f"{path} is a map of mode {settings['mode']!r}: only 'trinary' can be read")
    lightness = read_pgm(path.parent / settings["image"])
    darkness = lightness if float(settings["negate"]) else 1 - lightness
    occupied = darkness > float(settings["occupied_thresh"])
    if unknown_blocks:
        occupied |= darkness >= float(settings["free_thresh"])
    x, y, yaw = (float(value) for value in settings["origin"].strip("[], ").split(","))
    return OccupancyGrid(occupied[::-1], float(settings["resolution"]), (x, y, yaw))


def _flat_yaml(text: str) -> dict[str, str]:
    """The ``key: value`` lines of a map's YAML, values without quotes, a list below its key with commas."""
    text = re.sub(r"\n\s*-\s+", ",", text)
    lines = (line.partition(" #")[0].partition(":") for line in text.splitlines() if not line.startswith("#"))
    return {key.strip(): value.strip().strip("'\"") for key, colon, value in lines if colon}


def read_pgm(path: Path) -> NDArray[np.float64]:
    """Lightness (rows, columns) from 0 (black) to 1 of a PGM image, plain (P2) or raw (P5), row 0 the highest.

    Raises:
        InvalidGeometry: The file is not a PGM image.
    """
    data = path.read_bytes()
    header: list[bytes] = []
    at = 0
    while len(header) < 4 and at < len(data):  # magic, columns, rows, maximum; a # starts a comment
        if data[at : at + 1] == b"#":
            at = data.find(b"\n", at) % (len(data) + 1)
        elif data[at : at + 1].isspace():
            at += 1
        else:
            end = next((i for i in range(at, len(data)) if data[i : i + 1].isspace()), len(data))
            header.append(data[at:end])
            at = end
    if len(header) < 4 or header[0] not in (b"P2", b"P5"):
        raise InvalidGeometry(f"{path} is not a PGM image: it does not begin with P2 or P5 and its size")
    columns, rows, maximum = (int(field) for field in header[1:])
    if header[0] == b"P2":
        pixels = np.array(data[at:].split(), dtype=float)
    else:
        pixels = np.frombuffer(data[at + 1 :], dtype=np.uint8 if maximum < 256 else np.dtype(">u2")).astype(float)
    if pixels.size < rows * columns:
        raise InvalidGeometry(f"{path} ends early: {pixels.size} pixels for {columns} x {rows}")
    return pixels[: rows * columns].reshape(rows, columns) / maximum


def _runs(occupied: NDArray[np.bool_]) -> list[shapely.Polygon]:
    """Boxes over the occupied cells: runs along the rows, equal runs of following rows as one."""
    rows = len(occupied)
    change = np.diff(np.pad(occupied, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    starts, ends = np.argwhere(change == 1), np.argwhere(change == -1)
    open_runs: dict[tuple[int, int], int] = {}  # (first column, end): the row where it began
    boxes: list[shapely.Polygon] = []
    by_row: list[set[tuple[int, int]]] = [set() for _ in range(rows + 1)]
    for (row, first), (_, end) in zip(starts.tolist(), ends.tolist(), strict=True):
        by_row[row].add((first, end))
    for row, runs in enumerate(by_row):
        for run in [run for run in open_runs if run not in runs]:
            boxes.append(shapely.box(run[0], open_runs.pop(run), run[1], row))
        for run in runs:
            open_runs.setdefault(run, row)
    return boxes


def _pinches(occupied: NDArray[np.bool_]) -> list[shapely.Polygon]:
    """Small squares at the corners where two occupied cells touch and the other two cells are free."""
    a, b, c, d = occupied[:-1, :-1], occupied[:-1, 1:], occupied[1:, :-1], occupied[1:, 1:]
    at = np.argwhere((a & d & ~b & ~c) | (b & c & ~a & ~d)) + 1  # (row, column) of the corner
    y, x = at[:, 0], at[:, 1]
    return list(shapely.box(x - PINCH / 2, y - PINCH / 2, x + PINCH / 2, y + PINCH / 2))
