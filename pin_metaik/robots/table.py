"""DH tables as TOML files that a person can write; every mistake is named with its file, joint and key.

::

    name = "puma_offset"
    convention = "modified"                # or "standard"
    length = "m"                           # or "cm", "mm"
    angle = "deg"                          # or "rad"

    [parameters]                           # optional: values that rows refer to by name, and callers can replace
    l1 = 10

    [base]                                 # optional, like [tool]
    xyz = [0, 0, 1]
    rpy = [0, 0, 90]                       # R = Rz(yaw) Ry(pitch) Rx(roll)

    [[joint]]
    type = "revolute"                      # or "prismatic"; revolute if not given
    a = "l1"                               # a parameter, or "-l1"
    alpha = -90
    d = 0                                  # a prismatic joint has theta here: d is its variable
    offset = 0                             # value of the variable at q = 0
    limits = [-180, 180]                   # or continuous = true
    velocity = 120                         # optional, per second; else 180 deg/s or 1 m/s
    effort = 50                            # optional, N m or N; else 100
    name = "shoulder"                      # optional
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf, isfinite, pi, radians
from numbers import Real
from pathlib import Path
from typing import Any, cast

from pin_metaik.arguments import checked_as
from pin_metaik.errors import InvalidTable, UnknownName, meant
from pin_metaik.files import known_keys
from pin_metaik.robots.dh import Convention, DHRow, DHTable, JointType, Placement
from pin_metaik.said import warn
from pin_metaik.toml import Table, read_toml
from pin_metaik.units import LENGTHS

ANGLES: dict[str, Callable[[float], float]] = {"rad": float, "deg": radians}

_TOP = ("name", "convention", "length", "angle", "joint")
_TOP_OPTIONAL = ("description", "source", "parameters", "base", "tool")
LARGEST = 1e9  # of numbers in a table, in its units
_JOINT = ("a", "alpha")
_JOINT_OPTIONAL = ("name", "type", "d", "theta", "offset", "limits", "continuous", "velocity", "effort")


@checked_as(InvalidTable)
def read_table(path: str | Path, parameters: Mapping[str, float | str | bool] | None = None) -> DHTable:
    """Read a DH table.

    Args:
        path: A ``.toml`` file.
        parameters: Values that replace those of its ``[parameters]``, in its units.

    Raises:
        InvalidTable: If the file is missing or makes no sense; the message names file, joint and key.
        UnknownName: If the table has no such parameter.
    """
    content = read_toml(Path(path))
    if not content:
        raise InvalidTable(f"{path} is empty: a DH table needs {', '.join(_TOP)}")
    return _Reader(str(path), content, parameters or {}).table()


class _Reader:
    """One file being read: it knows the units and parameters, and prefixes every complaint with the place."""

    def __init__(self, path: str, content: dict[str, Any], replaced: Mapping[str, float | str | bool]) -> None:
        self.path, self.content = path, content
        self.top = Table(content, path, _TOP, _TOP_OPTIONAL)
        self.name, self.convention, self.description, self.source = (
            self.top.text(key) for key in ("name", "convention", "description", "source")
        )
        self.metre = float(1 / self.top.one_of("length", LENGTHS).factor)  # units in a metre
        self.radian = self.top.one_of("angle", ANGLES)
        own = content.get("parameters", {})
        if not isinstance(own, dict):
            raise InvalidTable(f"{path}: parameters is not a table [parameters] of names and numbers")
        for name in replaced:
            if name not in own:
                raise UnknownName(f"parameter of {self.name}", name, own)
        self.parameters: dict[str, float] = {}
        self.used: set[str] = set()
        for name, value in {**own, **replaced}.items():
            self.parameters[name] = self.number(value, f"{path}: parameters: {name}")

    def table(self) -> DHTable:
        """The whole file as a table."""
        joints = self.content["joint"]
        if not isinstance(joints, list) or not joints or not all(isinstance(joint, dict) for joint in joints):
            raise InvalidTable(f"{self.path}: joint is not a list of tables: write [[joint]] above each row")
        rows = tuple(self.row(joint, number) for number, joint in enumerate(joints, start=1))
        base, tool = self.placement("base"), self.placement("tool")
        if idle := self.parameters.keys() - self.used:
            warn(f"{self.path}: no row uses the parameters {', '.join(sorted(idle))}")
        try:
            return DHTable(
                self.name,
                cast(Convention, self.convention),
                rows,
                base,
                tool,
                self.description.strip(),
                self.source.strip(),
            )
        except InvalidTable as error:
            raise InvalidTable(f"{self.path}: {error}") from None

    def row(self, joint: dict[str, Any], number: int) -> DHRow:
        """One ``[[joint]]``."""
        place = f"{self.path}: joint {number}"
        self.sense(Table(joint, place, _JOINT, _JOINT_OPTIONAL))
        prismatic = joint.get("type") == "prismatic"

        def length(key: str) -> float:
            return self.number(joint.get(key, 0), f"{place}: {key}") / self.metre

        def angle(key: str) -> float:
            return self.radian(self.number(joint.get(key, 0), f"{place}: {key}"))

        a, alpha = length("a"), angle("alpha")
        d, theta = length("offset" if prismatic else "d"), angle("theta" if prismatic else "offset")
        kind: JointType = "prismatic" if prismatic else "revolute" if "limits" in joint else "continuous"
        lower, upper = -inf, inf
        if "limits" in joint:
            pair = self.numbers(joint["limits"], 2, f"{place}: limits")
            if pair[0] > pair[1]:
                raise InvalidTable(f"{place}: limits are crossed: lower {pair[0]:g} is above upper {pair[1]:g}")
            lower, upper = (value / self.metre if prismatic else self.radian(value) for value in pair)
        velocity = 1.0 if prismatic else pi
        if "velocity" in joint:
            velocity = length("velocity") if prismatic else angle("velocity")
        effort = self.number(joint.get("effort", 100), f"{place}: effort")
        try:
            return DHRow(a, alpha, d, theta, kind, lower, upper, velocity, effort, joint.get("name", ""))
        except InvalidTable as error:
            raise InvalidTable(f"{place}: {error}") from None

    def sense(self, joint: Table) -> None:
        """Complain about keys that are of the wrong kind, contradict each other, or lack their companion."""
        place = joint.place
        joint.text("name")
        kind = joint.text("type", "revolute")
        if kind not in ("revolute", "prismatic"):
            raise InvalidTable(f"{place}: type = {kind!r} is neither revolute nor prismatic")
        variable, fixed = ("d", "theta") if kind == "prismatic" else ("theta", "d")
        if variable in joint:
            raise InvalidTable(
                f"{place}: {variable} is what a {kind} joint varies; its value at q = 0 is called offset"
            )
        if fixed not in joint:
            raise InvalidTable(f"{place}: {fixed} is missing")
        continuous = "continuous" in joint and joint.flag("continuous")
        if continuous and kind == "prismatic":
            raise InvalidTable(f"{place}: a prismatic joint cannot be continuous; give it limits")
        if continuous and "limits" in joint:
            raise InvalidTable(f"{place}: a continuous joint has no limits; take out one of the two keys")
        if not continuous and "limits" not in joint:
            hint = "" if kind == "prismatic" else ", or continuous = true"
            raise InvalidTable(f"{place}: limits is missing: write limits = [lower, upper]{hint}")

    def placement(self, key: str) -> Placement:
        """``[base]`` or ``[tool]``: the identity if it is not there."""
        content = self.content.get(key, {})
        place = f"{self.path}: {key}"
        if not isinstance(content, dict):
            raise InvalidTable(f"{place} is not a table [{key}] with xyz and rpy")
        known_keys(content, place, InvalidTable, (), ("xyz", "rpy"))
        x, y, z = (v / self.metre for v in self.numbers(content.get("xyz", [0, 0, 0]), 3, f"{place}: xyz"))
        roll, pitch, yaw = (self.radian(v) for v in self.numbers(content.get("rpy", [0, 0, 0]), 3, f"{place}: rpy"))
        return Placement((x, y, z), (roll, pitch, yaw))

    def number(self, value: object, place: str) -> float:
        """A finite number, or the parameter that a text names."""
        if isinstance(value, str):
            name = value.removeprefix("-").strip()
            if name not in self.parameters:
                raise InvalidTable(
                    f"{place} = {value!r} is neither a number nor a parameter; {meant(name, self.parameters)}"
                )
            self.used.add(name)
            return -self.parameters[name] if value.startswith("-") else self.parameters[name]
        if isinstance(value, bool) or not isinstance(value, Real):
            raise InvalidTable(f"{place} = {value!r} is not a number")
        if not -LARGEST <= float(value) <= LARGEST:
            wrong = f"is beyond {LARGEST:g}" if isfinite(value) else "is not finite"
            raise InvalidTable(f"{place} = {value} {wrong}")
        return float(value)

    def numbers(self, value: object, count: int, place: str) -> list[float]:
        """A list of so many numbers."""
        if not isinstance(value, list) or len(value) != count:
            raise InvalidTable(f"{place} = {value!r} is not a list of {count} numbers")
        return [self.number(v, place) for v in value]
