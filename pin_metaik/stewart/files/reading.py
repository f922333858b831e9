"""Mechanisms as TOML files that a person can write; every mistake is named with its file, table and key.

::

    name = "octahedron"
    length = "mm"                          # or "cm", "m"
    angle = "deg"                          # or "rad"
    description = "..."                    # optional, like source

    [base]
    radius = 200
    angles = [0, 120, 240]                 # of B1, B2 ...: ascending, within one turn

    [platform]
    radius = 100
    angles = [60, 180, 300]                # of M1, M2 ...
    reference = [0, 0, 20]                 # optional: the point P that poses place, from the centre of the circle

    # or, of either side or both, joints anywhere, before the first table:
    # base = [[250, 0, 10], [-125, 217, 0], ...]    # B1, B2 ... in the base frame
    # platform = [[60, 104, 5], ...]                # M1, M2 ... in the platform's; with a reference: [platform] joints

    [legs]
    base = [1, 1, 2, 2, 3, 3]              # the base joint of each leg, counted from 1 ...
    platform = [3, 1, 1, 2, 2, 3]          # ... and its platform joint
    # or, instead of the two: connection = [[1, 0, 1], [1, 1, 0], [0, 1, 1]]
    shortest = 250
    longest = 350
    base_angle = 45                        # optional limits, see LegLimits
    platform_angle = 45
    distance = 20
    home = [0, 0, 250]
    dead_length = 100                      # optional: what a retracted leg is longer than its stroke
    speed = 50                             # optional: the fastest that a leg extends, its unit of length a second

    # or, instead of shortest, longest, dead_length and speed: legs moved by servos, see Servos and ServoLimits
    # [servos]
    # horn = 15                            # one for all, or a list
    # rod = 120
    # directions = [90, -90, -30, ...]     # where horns point at 0, axes in the plane of the base; or, anywhere:
    # axes = [[1, 0, 0.2], ...]            # and, optional, zeros = [[0, 1, 0], ...]
    # branches = 1                         # optional: 1 or -1, one for all, or a list
    # lowest = -80
    # highest = 80
    # speed = 500                          # optional: its unit of angles a second

    [workspace]                            # optional, see Grid
    counts = [40, 40, 40]
    x = [-100, 100]                        # left out: as far as the legs reach; y and z likewise
    steps = [5, 5, 1]
    roll = [-10, 10]                       # pitch and yaw likewise

    [dexterity]                            # optional, see Dexterity
    norm = "frobenius"                     # or "two"
    length = "rm"                          # or "best", or a length

    [design]                               # optional, see DesignTask
    algorithm = "pso"                      # any metaheuristic
    evaluations = 3600
    seed = 0
    index = "gdi"                          # or "lci" with a threshold
    weights = [0.78, 0.22]
    least_workspace = 0.05
    joint_gap = 42
    settings = { agents = 60 }             # of the metaheuristic

    [design.ranges]                        # one value: fixed; two: free between them; left out: as above
    base_radius = [42, 315]
    base_angles = [0, [60, 180], [180, 300]]
    # joints anywhere: platform = [[[50, 70], 104, [0, 10]], ...]: x, y and z of each, a value or a range

    [design.workspace]                     # the grid designs are compared on; same keys as [workspace]
    counts = [14, 14, 14]
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.errors import (
    InvalidBounds,
    InvalidGeometry,
    InvalidSetting,
    InvalidTable,
    MetaIKError,
)
from pin_metaik.lookup import lookup
from pin_metaik.optimize import ALGORITHMS, Metaheuristic
from pin_metaik.stewart.kinematics.conditioning import Dexterity
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.mechanism.ranges import ANGLES_EACH, SIDES, Ranges
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.platform.geometry import Geometry, legs_of
from pin_metaik.stewart.platform.limits import LegLimits, Limits, ServoLimits
from pin_metaik.stewart.platform.servos import Servos
from pin_metaik.stewart.workspace.grid import Grid
from pin_metaik.toml import Table, read_toml
from pin_metaik.units import ANGLES, LENGTHS, PURE, Unit

JOINT_LIMITS = ("base_angle", "platform_angle", "distance", "home")
SERVOS = ("horn", "rod", "lowest", "highest")
OPTIONAL_SERVOS = ("directions", "axes", "zeros", "branches", "speed")
GRID = ("counts", "x", "y", "z", "steps", "roll", "pitch", "yaw")
DESIGN = (
    "algorithm",
    "settings",
    "evaluations",
    "seed",
    "from_current",
    "index",
    "threshold",
    "weights",
    "cube",
    "least_workspace",
    "joint_gap",
    "ranges",
    "workspace",
)


@checked
def read_mechanism(path: str | Path) -> Mechanism:
    """Read a mechanism from a ``.toml`` file.

    Raises:
        InvalidTable: The file is missing, is not TOML, or has keys or values it should not; the message names them.
        InvalidGeometry: The platform it describes cannot be one.
        InvalidSetting: A setting outside its range.
        InvalidBounds: A range that is not one.
        UnknownName: No metaheuristic of that name.
    """
    content = read_toml(Path(path), number=Decimal)
    try:
        return _mechanism(content, str(path))
    except (InvalidGeometry, InvalidSetting, InvalidBounds) as error:
        raise type(error)(f"{path}: {error}") from None


def _mechanism(content: dict[str, Any], path: str) -> Mechanism:
    needed = ("name", "length", "angle", "base", "platform", "legs")
    top = Table(content, path, needed, ("description", "source", "servos", "workspace", "dexterity", "design"))
    length, angle = top.one_of("length", LENGTHS), top.one_of("angle", ANGLES)
    servos = Table(content["servos"], f"{path}: servos", SERVOS, OPTIONAL_SERVOS) if "servos" in top else None
    legs = _legs_table(content["legs"], path, servos is not None)
    optional: dict[str, Any] = {}
    if "workspace" in top:
        optional["grid"] = _grid(Table(content["workspace"], f"{path}: workspace", (), GRID), length, angle)
    if "dexterity" in top:
        optional["dexterity"] = _dexterity(content["dexterity"], path, length)
    if "design" in top:
        optional["task"] = _task(content["design"], path, length, angle)
    return Mechanism(
        top.text("name"),
        _geometry(content, legs, servos, path, length, angle),
        _limits(legs, servos, length, angle),
        unit=length.name,
        description=top.text("description").strip(),
        source=top.text("source").strip(),
        **optional,
    )


def _legs_table(content: object, path: str, servos: bool) -> Table:
    by_matrix = isinstance(content, dict) and "connection" in content
    joins = ("connection",) if by_matrix else ("base", "platform")
    if servos:
        return Table(content, f"{path}: legs", joins, JOINT_LIMITS)
    return Table(content, f"{path}: legs", (*joins, "shortest", "longest"), (*JOINT_LIMITS, "dead_length", "speed"))


def _geometry(
    content: dict[str, Any], legs: Table, servos: Table | None, path: str, length: Unit, angle: Unit
) -> Geometry:
    if "connection" in legs:
        pairs = legs_of(legs.content["connection"])
    else:
        ends = legs.wholes("base"), legs.wholes("platform")
        if len(ends[0]) != len(ends[1]):
            raise InvalidTable(
                f"{legs.place}: base names {len(ends[0])} joints and platform {len(ends[1])}: each "
                "names one for each leg"
            )
        pairs = tuple((b - 1, m - 1) for b, m in zip(*ends, strict=True))
    base = _side(content, "base", path, length, angle)
    moved = None if servos is None else _servos(servos, length, angle)
    return Geometry(legs=pairs, servos=moved, **base, **_side(content, "platform", path, length, angle))


def _servos(table: Table, length: Unit, angle: Unit) -> Servos:
    given: dict[str, Any] = {key: table.one_or_each(key, length) for key in ("horn", "rod")}
    if "directions" in table:
        given["directions"] = table.numbers("directions", angle)
    given |= {key: table.points(key, PURE) for key in ("axes", "zeros") if key in table}
    if "branches" in table:
        each = isinstance(table.content["branches"], list)
        given["branches"] = table.wholes("branches") if each else table.whole("branches")
    return Servos(**given)


def _side(content: dict[str, Any], side: str, path: str, length: Unit, angle: Unit) -> dict[str, Any]:
    """The joints of one side as the fields of a geometry: on a circle, or anywhere."""
    given = content[side]
    if isinstance(given, list):
        return {side: Table({side: given}, path, (side,)).points(side, length)}
    anywhere = isinstance(given, dict) and "joints" in given
    needed = ("joints",) if anywhere else ("radius", "angles")
    table = Table(given, f"{path}: {side}", needed, ("reference",) if side == "platform" else ())
    reference = {"reference": table.numbers("reference", length, 3)} if "reference" in table else {}
    if anywhere:
        return {side: table.points("joints", length), **reference}
    circle = {f"{side}_radius": table.number("radius", length), f"{side}_angles": table.numbers("angles", angle)}
    return {**circle, **reference}


def _limits(legs: Table, servos: Table | None, length: Unit, angle: Unit) -> Limits:
    read: dict[str, Callable[[str], Any]] = {
        "base_angle": lambda key: legs.number(key, angle),
        "platform_angle": lambda key: legs.number(key, angle),
        "distance": lambda key: legs.number(key, length),
        "home": lambda key: legs.numbers(key, length, 3),
        "dead_length": lambda key: legs.number(key, length),
        "speed": lambda key: legs.number(key, length),
    }
    optional = {key: read[key](key) for key in read if key in legs}
    if servos is not None:
        if "speed" in servos:
            optional["speed"] = servos.number("speed", angle)
        return ServoLimits(servos.number("lowest", angle), servos.number("highest", angle), **optional)
    return LegLimits(legs.number("shortest", length), legs.number("longest", length), **optional)


def _grid(table: Table, length: Unit, angle: Unit) -> Grid:
    given: dict[str, Any] = {key: table.wholes(key, 3) for key in ("counts", "steps") if key in table}
    given |= {key: table.numbers(key, length, 2) for key in ("x", "y", "z") if key in table}
    given |= {key: table.numbers(key, angle, 2) for key in ("roll", "pitch", "yaw") if key in table}
    return Grid(**given)


def _dexterity(content: object, path: str, length: Unit) -> Dexterity:
    table = Table(content, f"{path}: dexterity", (), ("norm", "length"))
    given: dict[str, Any] = {"norm": table.text("norm")} if "norm" in table else {}
    if "length" in table:
        value = table.content["length"]
        given["length"] = value if isinstance(value, str) else table.number("length", length)
    return Dexterity(**given)


def _task(content: object, path: str, length: Unit, angle: Unit) -> DesignTask:
    table = Table(content, f"{path}: design", ("ranges",), DESIGN)
    names = tuple(field.name for field in fields(Ranges))
    spans = Table(table.content["ranges"], f"{path}: design.ranges", (), names)
    ranges = {key: _spans(spans, key, length, angle) for key in names if key in spans}
    given: dict[str, Any] = {key: table.whole(key) for key in ("evaluations", "seed") if key in table}
    given |= {key: table.number(key, length) for key in ("cube", "joint_gap") if key in table}
    if "index" in table:
        given["index"] = table.text("index")
    given |= {key: table.number(key) for key in ("threshold", "least_workspace") if key in table}
    if "weights" in table:
        given["weights"] = table.numbers("weights", PURE, 2)
    if "from_current" in table:
        given["from_current"] = table.flag("from_current")
    if "workspace" in table:
        place = f"{path}: design.workspace"
        given["grid"] = _grid(Table(table.content["workspace"], place, (), GRID), length, angle)
    if "algorithm" in table:
        given["algorithm"] = _algorithm(table.text("algorithm"), table.content.get("settings", {}), path)
    elif "settings" in table:
        raise InvalidTable(f"{path}: design: settings are those of an algorithm: name it, e.g. algorithm = 'pso'")
    return DesignTask(Ranges(**ranges), **given)


def _spans(table: Table, key: str, length: Unit, angle: Unit) -> Any:
    """The range of a design in one of the dimensions of ``Ranges``."""
    if key in SIDES:
        return table.point_spans(key, length)
    return table.spans(key, angle) if key in ANGLES_EACH else table.span(key, length)


def _algorithm(name: str, settings: object, path: str) -> Metaheuristic:
    kind = lookup("metaheuristic", name, ALGORITHMS)
    assert is_dataclass(kind)
    table = Table(settings, f"{path}: design.settings", (), tuple(field.name for field in fields(kind)))
    values = {key: float(value) if isinstance(value, Decimal) else value for key, value in table.content.items()}
    try:
        made: Metaheuristic = kind(**values)
    except MetaIKError as error:
        raise InvalidSetting(f"design.settings: {error}") from None
    return made
