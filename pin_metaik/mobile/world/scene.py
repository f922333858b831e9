"""A planning problem: obstacles, walls, start and goal; a dozen lines of JSON on disk."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import shapely

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.files import known_keys, read_json
from pin_metaik.mobile.world.grids import Unknown, read_grid
from pin_metaik.mobile.world.polygons import FARTHEST, GEOJSON, read_obstacles
from pin_metaik.optimize.settings import one_of

Point = tuple[float, float]

KEYS = ("start", "goal", "obstacles", "bounds", "name")
REMARKS = ("note", "optimal_length", "optimal_path", "hull_optimal_length")  # about a scene; nothing is made of them
GRIDS = (".npy", ".yaml", ".yml")
CLOSE = 0.75  # how alike a key of somebody's GeoJSON must be to one of ours to be a slip of the pen


@dataclass(frozen=True, eq=False)
class Scene:
    """Start, goal and obstacles of a robot in the plane; lengths in m (or any one unit).

    Attributes:
        start: (x, y).
        goal: (x, y).
        obstacles: Polygons, lines and points; they may overlap or touch. Lines and points have no thickness and grow
            with the robot's radius like all others. Given as anything that ``read_obstacles`` accepts.
        bounds: Walls (x_min, y_min, x_max, y_max) around the workspace, or None for an unbounded plane.
        name: Its name.

    Raises:
        InvalidGeometry: A point is not two finite numbers, bounds are crossed, or a polygon is malformed.
    """

    start: Point
    goal: Point
    obstacles: tuple[shapely.Geometry, ...] = ()
    bounds: tuple[float, float, float, float] | None = None
    name: str = "scene"

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", _point("start", self.start))
        object.__setattr__(self, "goal", _point("goal", self.goal))
        object.__setattr__(self, "obstacles", read_obstacles(self.obstacles))
        if self.bounds is not None:
            object.__setattr__(self, "bounds", _bounds(self.bounds))

    @property
    def box(self) -> tuple[float, float, float, float]:
        """The bounds; without any, a box that contains every shortest path."""
        if self.bounds is not None:
            return self.bounds
        everything = shapely.union_all([shapely.MultiPoint([self.start, self.goal]), *self.obstacles])
        x_min, y_min, x_max, y_max = everything.bounds
        room = max(x_max - x_min, y_max - y_min) or 1.0
        return x_min - room, y_min - room, x_max + room, y_max + room

    @checked
    def between(self, start: Any, goal: Any) -> Scene:
        """The same scene with another start and goal; None keeps the present one."""
        return replace(self, start=self.start if start is None else start, goal=self.goal if goal is None else goal)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, as in a scene's JSON file; polygons with holes, lines and points as GeoJSON."""
        return {
            "start": list(self.start),
            "goal": list(self.goal),
            "bounds": None if self.bounds is None else list(self.bounds),
            "obstacles": [_plain(polygon) for polygon in self.obstacles],
        }


def scene_names() -> list[str]:
    """The scenes that come with the package."""
    return sorted(_shipped())


@checked
def load_scene(
    source: str | Path,
    start: Any = None,
    goal: Any = None,
    *,
    unknown: Unknown = "blocked",
    resolution: float | None = None,
    threshold: float | None = None,
    specks: int = 1,
) -> Scene:
    """A scene by name, or from a file.

    Args:
        source: One of ``scene_names()``; the path of a scene (``.json`` with start, goal, obstacles, perhaps bounds),
            of obstacles (``.geojson``, ``.wkt``), of an occupancy grid (``.npy``) or a ROS map (``.yaml``).
        start: (x, y) that replaces the file's; needed where the file has none.
        goal: (x, y) that replaces the file's; needed where the file has none.
        unknown: Of a grid: whether unknown cells are ``"blocked"`` or ``"free"``.
        resolution: Of a ``.npy``: width of a cell in m, default 1.
        threshold: Of a grid: cells above it are occupied; see ``read_grid``.
        specks: Of a grid: groups of fewer occupied cells are noise and left out.

    Raises:
        UnknownName: No such scene.
        InvalidGeometry: The file is missing or malformed, or has an unknown key; or there is no start or goal.
        InvalidSetting: Settings of grids, for a source that is not a grid.
    """
    path = Path(source)
    one_of("unknown", unknown, Unknown)
    suffix = path.suffix.lower()
    said = {
        "unknown": unknown != "blocked",
        "resolution": resolution is not None,
        "threshold": threshold is not None,
        "specks": specks != 1,
    }
    if suffix not in GRIDS and any(said.values()):
        about = ", ".join(key for key, value in said.items() if value)
        raise InvalidSetting(f"{about}: only for an occupancy grid ({', '.join(GRIDS)}), which {source} is not")
    match suffix:
        case ".json" | ".geojson":
            return scene_of(_read(path), path.stem, start, goal)
        case ".wkt":
            return scene_of({"obstacles": path}, path.stem, start, goal)
        case ".npy" | ".yaml" | ".yml":
            grid = read_grid(path, unknown=unknown, resolution=resolution, threshold=threshold).without_specks(specks)
            return scene_of({"obstacles": grid.polygons, "bounds": grid.bounds}, path.stem, start, goal)
    shipped = _shipped()
    if str(source) in shipped:
        return scene_of(_read(shipped[str(source)]), str(source), start, goal)
    if path.suffix or path.parent != Path():
        raise InvalidGeometry(
            f"cannot read {path}: a scene is a .json, obstacles are a .geojson or .wkt, a grid is a .npy or the .yaml "
            "of a ROS map, which names its image"
        )
    raise UnknownName("scene", str(source), shipped)


def scene_of(mapping: Mapping[str, Any], name: str = "scene", start: Any = None, goal: Any = None) -> Scene:
    """A scene from the mapping its JSON file holds; ``start`` and ``goal`` replace the mapping's.

    GeoJSON is a scene, too: start, goal and bounds are members of its outermost object, or come from the caller.

    Raises:
        InvalidGeometry: A key is missing, makes no sense or is unknown.
    """
    if mapping.get("type") in GEOJSON:
        slips = (key for key in mapping if get_close_matches(str(key), KEYS, n=1, cutoff=CLOSE))
        known_keys(dict.fromkeys(slips), name, InvalidGeometry, (), KEYS)  # members of somebody's own are none
        mapping = {"obstacles": mapping, **{key: mapping[key] for key in ("start", "goal", "bounds") if key in mapping}}
    else:
        known_keys(mapping, name, InvalidGeometry, (), (*KEYS, *REMARKS))
    if "obstacles" not in mapping:
        raise InvalidGeometry(f"{name} is not a scene: it has no 'obstacles'; keys: {', '.join(KEYS)}")
    ends = {"start": start, "goal": goal}
    for role, given in ends.items():
        if given is None and mapping.get(role) is None:
            raise InvalidGeometry(
                f"{name} does not say where the {role} is: give {role}=(x, y), on the command line --{role} X Y"
            )
        ends[role] = mapping[role] if given is None else given
    called = mapping.get("name", name)
    return Scene(ends["start"], ends["goal"], mapping["obstacles"], mapping.get("bounds"), str(called))


def _shipped() -> dict[str, Traversable]:
    folder = files("pin_metaik.mobile") / "scenes"
    return {entry.name.removesuffix(".json"): entry for entry in folder.iterdir() if entry.name.endswith(".json")}


def _read(path: Path | Traversable) -> Mapping[str, Any]:
    mapping = read_json(path, InvalidGeometry)
    if not isinstance(mapping, dict):
        raise InvalidGeometry(f"{path} is not a scene: expected an object with start, goal, obstacles, bounds")
    return mapping


def _point(role: str, value: Any) -> Point:
    try:
        x, y = (float(v) for v in value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidGeometry(f"the {role} is a point (x, y), got {value!r}") from None
    if not (abs(x) <= FARTHEST and abs(y) <= FARTHEST):
        raise InvalidGeometry(f"the {role} must be finite, and within {FARTHEST:g}, got {value!r}")
    return x, y


def _bounds(value: Any) -> tuple[float, float, float, float]:
    given = array("bounds are (x_min, y_min, x_max, y_max)", value, 4, error=InvalidGeometry, finite=False)
    x_min, y_min, x_max, y_max = given.tolist()
    if not (-FARTHEST <= x_min < x_max <= FARTHEST and -FARTHEST <= y_min < y_max <= FARTHEST):
        raise InvalidGeometry(
            f"bounds must have x_min < x_max and y_min < y_max, finite and within {FARTHEST:g}; got {value!r}"
        )
    return x_min, y_min, x_max, y_max


def _plain(obstacle: shapely.Geometry) -> Any:
    if obstacle.geom_type != "Polygon" or obstacle.interiors:
        return json.loads(shapely.to_geojson(obstacle))
    return shapely.get_coordinates(obstacle.exterior)[:-1].tolist()
