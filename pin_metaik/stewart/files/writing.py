"""A mechanism as TOML text: what ``read_mechanism`` reads back as the same mechanism, to the last bit."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize import ALGORITHMS, Metaheuristic, make
from pin_metaik.output import writable
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.mechanism.ranges import ANGLES_EACH, SIDES, Ranges
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import LegLimits, Limits
from pin_metaik.stewart.workspace.grid import Grid
from pin_metaik.toml import Span
from pin_metaik.units import ANGLES, LENGTHS, PURE, Unit

DEG = ANGLES["deg"]


@checked
def save_mechanism(mechanism: Mechanism, path: str | Path) -> Path:
    """Write a mechanism to a ``.toml`` file; loading it gives the same mechanism, and saving that the same file.

    Raises:
        InvalidSetting: It is designed by a metaheuristic that has no name.
        CannotWrite: It cannot be written.
    """
    path = writable(path)
    path.write_text(to_toml(mechanism), encoding="utf-8", newline="\n")
    return path


@checked
def to_toml(mechanism: Mechanism) -> str:
    """TOML text of a mechanism: lengths in its unit, angles in degrees.

    Raises:
        InvalidSetting: It is designed by a metaheuristic that has no name.
    """
    mm = LENGTHS[mechanism.unit]
    geometry = mechanism.geometry
    base, platform = zip(*geometry.legs, strict=True)
    lines = [f"name = {_text(mechanism.name)}", f"length = {_text(mm.name)}", f"angle = {_text(DEG.name)}"]
    lines += [f"{key} = {_text(value)}" for key in ("description", "source") if (value := getattr(mechanism, key))]
    lines += _joints(geometry, mm)
    lines += [
        "",
        "[legs]",
        f"base = {[joint + 1 for joint in base]}",
        f"platform = {[joint + 1 for joint in platform]}",
    ]
    lines += _limits(mechanism.limits, mm)
    lines += _section("servos", _servos(mechanism, mm))
    lines += _section("workspace", _grid(mechanism.grid, mm))
    length = mechanism.dexterity.length
    shown = _text(length) if isinstance(length, str) else mm.write(length)
    lines += ["", "[dexterity]", f"norm = {_text(mechanism.dexterity.norm)}", f"length = {shown}"]
    if mechanism.task is not None:
        lines += _task(mechanism.task, mm)
    return "\n".join(lines) + "\n"


def _joints(geometry: Geometry, mm: Unit) -> list[str]:
    """The joints of both sides: what is a key of the file itself comes before the tables."""
    reference = [f"reference = {_list(geometry.reference, mm)}"] if any(geometry.reference) else []
    keys, tables = [], []
    for side, more in (("base", []), ("platform", reference)):
        joints = getattr(geometry, side)
        if joints is None:
            angles = _list(getattr(geometry, f"{side}_angles"), DEG)
            circle = [f"radius = {mm.write(getattr(geometry, f'{side}_radius'))}", f"angles = {angles}"]
            tables += _section(side, [*circle, *more])
        elif more:
            tables += _section(side, [f"joints = {_points(joints, mm)}", *more])
        else:
            keys.append(f"{side} = {_points(joints, mm)}")
    return keys + tables


def _limits(limits: Limits, mm: Unit) -> list[str]:
    slides = isinstance(limits, LegLimits)
    lines = [f"{name} = {mm.write(getattr(limits, name))}" for name in ("shortest", "longest") if slides]
    for key in ("base_angle", "platform_angle"):
        if getattr(limits, key) < math.pi:
            lines.append(f"{key} = {DEG.write(getattr(limits, key))}")
    if limits.distance > 0.0:
        lines.append(f"distance = {mm.write(limits.distance)}")
    if limits.home is not None:
        lines.append(f"home = {_list(limits.home, mm)}")
    for key in ("dead_length", "speed"):
        if slides and (value := getattr(limits, key)) is not None:
            lines.append(f"{key} = {mm.write(value)}")
    return lines


def _servos(mechanism: Mechanism, mm: Unit) -> list[str]:
    servos, limits = mechanism.geometry.servos, mechanism.limits
    if servos is None:
        return []
    lines = []
    for key in ("horn", "rod"):
        value = getattr(servos, key)
        lines.append(f"{key} = {_list(value, mm) if isinstance(value, tuple) else mm.write(value)}")
    if servos.axes is None:
        lines.append(f"directions = {_list(servos.directions, DEG)}")
    lines += [f"{key} = {_points(ways, PURE)}" for key in ("axes", "zeros") if (ways := getattr(servos, key))]
    if servos.branches != 1:
        lines.append(f"branches = {np.array(servos.branches).tolist()}")
    lines += [f"{key} = {DEG.write(end)}" for key, end in zip(("lowest", "highest"), limits.span, strict=True)]
    return lines + ([] if limits.speed is None else [f"speed = {DEG.write(limits.speed)}"])


def _grid(grid: Grid, mm: Unit) -> list[str]:
    lines = [f"counts = {list(grid.counts)}"]
    lines += [f"{key} = {_list(ends, mm)}" for key in ("x", "y", "z") if (ends := getattr(grid, key)) is not None]
    if grid.steps != (1, 1, 1):
        lines.append(f"steps = {list(grid.steps)}")
    return lines + [
        f"{key} = {_list(ends, DEG)}" for key in ("roll", "pitch", "yaw") if any(ends := getattr(grid, key))
    ]


def _task(task: DesignTask, mm: Unit) -> list[str]:
    name, settings = _algorithm(make(task.algorithm))
    lines = [f"algorithm = {_text(name)}", f"evaluations = {task.evaluations}", f"seed = {task.seed}"]
    if task.from_current:
        lines.append("from_current = true")
    lines.append(f"index = {_text(task.index)}")
    if task.index == "lci":
        lines.append(f"threshold = {PURE.write(task.threshold)}")
    lines.append(f"weights = {_list(task.weights, PURE)}")
    if task.cube is not None:
        lines.append(f"cube = {mm.write(task.cube)}")
    if task.least_workspace > 0.0:
        lines.append(f"least_workspace = {PURE.write(task.least_workspace)}")
    lines.append(f"joint_gap = {mm.write(task.joint_gap)}")
    lines = _section("design", lines) + _section("design.settings", settings)
    lines += _section("design.ranges", _ranges(task.ranges, mm))
    return lines + _section("design.workspace", _grid(task.grid, mm))


def _ranges(ranges: Ranges, mm: Unit) -> list[str]:
    lines = []
    for name in (field.name for field in fields(ranges)):
        value = getattr(ranges, name)
        if value is None:
            continue
        if name in SIDES:
            joints = (", ".join(_span(span, mm) for span in joint) for joint in value)
            shown = f"[{', '.join(f'[{joint}]' for joint in joints)}]"
        elif name in ANGLES_EACH:
            shown = f"[{', '.join(_span(span, DEG) for span in value)}]"
        else:
            shown = _span(value, mm)
        lines.append(f"{name} = {shown}")
    return lines


def _algorithm(algorithm: Metaheuristic) -> tuple[str, list[str]]:
    """Its name, and a line for each of its settings that is not None."""
    for name, kind in ALGORITHMS.items():
        if type(algorithm) is kind and is_dataclass(algorithm):
            values = {field.name: getattr(algorithm, field.name) for field in fields(algorithm)}
            return name, [f"{key} = {_value(value)}" for key, value in values.items() if value is not None]
    raise InvalidSetting(f"{algorithm!r} has no name to save; known: {', '.join(ALGORITHMS)}")


def _section(name: str, lines: list[str]) -> list[str]:
    return ["", f"[{name}]", *lines] if lines else []


def _span(span: Span, unit: Unit) -> str:
    return _list(span, unit) if isinstance(span, tuple) else unit.write(span)


def _points(points: Iterable[Iterable[float]], unit: Unit) -> str:
    return f"[{', '.join(_list(point, unit) for point in points)}]"


def _list(values: Iterable[float], unit: Unit) -> str:
    return f"[{', '.join(unit.write(value) for value in values)}]"


def _value(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _text(value)
        case int():
            return str(value)
        case _:
            return repr(float(value))


def _text(value: str) -> str:
    """A TOML string; JSON's escapes are TOML's."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
