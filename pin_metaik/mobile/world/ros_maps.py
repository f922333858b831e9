"""The maps of ROS: a YAML file and an image, read cell by cell as nav2's map server reads them (its ``map_io.cpp``)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import known_keys
from pin_metaik.mobile.files import number, numbers, read_yaml
from pin_metaik.mobile.world.images import Pixels, read_image

Mode = Literal["trinary", "scale", "raw"]

NEEDED = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
FLAGS = (("0", "false", "no", "off", "n"), ("1", "true", "yes", "on", "y"))  # in quotes, too
UNKNOWN, FREE, OCCUPIED = -1, 0, 100  # percent, as in nav_msgs/OccupancyGrid


@dataclass(frozen=True, eq=False)
class RosMap:
    """A map as the message ``nav_msgs/OccupancyGrid`` has it.

    Attributes:
        cells: Percent (rows, columns), -1 unknown; row 0 is the lowest.
        resolution: Width of a cell in m.
        origin: Pose (x, y, yaw) of the lower left corner of cell (0, 0), in m and rad.
    """

    cells: NDArray[np.int8]
    resolution: float
    origin: tuple[float, float, float]


def read_ros_map(path: Path) -> RosMap:
    """The map that a YAML file describes.

    Raises:
        InvalidGeometry: The file or its image is missing or malformed; the message names the file and the key.
        MissingExtra: PyYAML or Pillow is not installed.
    """
    given = read_yaml(path, InvalidGeometry)
    if not isinstance(given, dict):
        raise InvalidGeometry(f"{path} is not the YAML of a ROS map: expected the keys {', '.join(NEEDED)}")
    known_keys(given, path, InvalidGeometry, (), (*NEEDED, "mode"))
    if missing := [key for key in NEEDED if key not in given]:
        raise InvalidGeometry(f"{path} is not the YAML of a ROS map: it has no {', '.join(missing)}")
    place = f"{path} is not an occupancy grid"
    if not isinstance(given["image"], str) or not given["image"]:
        raise InvalidGeometry(f"{place}: image must be the name of a file, not {given['image']!r}")
    resolution = number(given, "resolution", place, InvalidGeometry)
    if not resolution > 0:
        raise InvalidGeometry(f"{place}: resolution must be above 0 m, not {given['resolution']!r}")
    x, y, yaw = numbers(given["origin"], 3, "origin (x, y, yaw)", place, InvalidGeometry)
    occupied, free = (number(given, key, place, InvalidGeometry) for key in ("occupied_thresh", "free_thresh"))
    mode, negate = _mode(given.get("mode", "trinary"), place), _flag(given["negate"], "negate", place)
    cells = cell_values(read_image(path.parent / given["image"]), mode, negate, occupied, free)
    return RosMap(cells[::-1], resolution, (x, y, yaw))


def cell_values(pixels: Pixels, mode: Mode, negate: bool, occupied: float, free: float) -> NDArray[np.int8]:
    """Percent (rows, columns) of an image's cells, -1 unknown, row 0 the highest.

    Args:
        pixels: The image.
        mode: ``trinary`` knows occupied, free and unknown, and takes opacity for one more colour; ``scale`` has
            percents between, and what is transparent is unknown; ``raw`` has the pixels' values, unknown above 100.
        negate: Whether white is occupied.
        occupied: Cells darker than this, of 1, are occupied.
        free: Cells lighter than this are free.
    """
    lightness = pixels.lightness
    if mode == "raw":
        value = np.floor(255 * lightness + 0.5)
        return np.where(value <= OCCUPIED, value, UNKNOWN).astype(np.int8)
    if mode == "trinary" and pixels.opacity is not None:
        colours = np.broadcast_to(pixels.colours, (*pixels.opacity.shape, 3))
        lightness = (colours.sum(axis=2) + pixels.opacity) / 4
    darkness = lightness if negate else 1 - lightness
    between = np.full(darkness.shape, float(UNKNOWN))
    if mode == "scale" and occupied != free:
        between = np.rint(100 * (darkness - free) / (occupied - free))
    values = np.select([darkness > occupied, darkness < free], [OCCUPIED, FREE], between)
    if mode == "scale" and pixels.opacity is not None:
        values = np.where(pixels.opacity < 1, UNKNOWN, values)
    return values.astype(np.int8)


def _mode(given: Any, place: str) -> Mode:
    for mode in get_args(Mode):
        if str(given).lower() == mode:
            return mode  # type: ignore[no-any-return]
    raise InvalidGeometry(f"{place}: mode must be one of {', '.join(get_args(Mode))}, not {given!r}")


def _flag(given: Any, key: str, place: str) -> bool:
    for value, words in enumerate(FLAGS):
        if str(given).lower() in words:
            return bool(value)
    raise InvalidGeometry(f"{place}: {key} must be true, false, 1 or 0, not {given!r}")
