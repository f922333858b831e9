"""Goals on the command line: a kind of goal and its fields as ``NAME=VALUE``, or a file of goals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from pin_metaik.errors import InvalidTarget
from pin_metaik.files import known_keys
from pin_metaik.ik.goals import GOALS, Goal, Wish
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.lookup import lookup
from pin_metaik.toml import read_toml

SPELLED = {kind: make for kind, make in GOALS.items() if kind not in ("custom", "loop")}
"""What numbers and words can say: a function and a constraint of Pinocchio they cannot."""
KINDS = ", ".join(SPELLED)


def read_goals(words: Sequence[str], wishes: Sequence[str], file: Path | None) -> list[Goal | Wish]:
    """The goals and wishes of a command line, and those of a file.

    Args:
        words: Goals, each a kind and fields: ``look_at frame=camera point=1,0,0.5``. Commas part numbers, semicolons
            rows of them, and dots the entries of a table: ``posture joints.elbow_joint=1.0``.
        wishes: Wishes, likewise; ``weight`` is the wish's.
        file: A TOML file with ``[[goal]]`` and ``[[wish]]``, each with a ``kind`` and fields.

    Raises:
        UnknownName: There is no such kind.
        InvalidTarget: A word is no field, a field is missing or unknown, or its value makes no sense.
        CannotRead: The file cannot be read.
    """
    content = {} if file is None else read_toml(file, InvalidTarget)
    known_keys(content, str(file), InvalidTarget, (), ("goal", "wish"))
    musts = [_goal(*one) for one in (*map(_split, words), *_entries(content, "goal", file))]
    wished = [_wish(*one) for one in (*map(_split, wishes), *_entries(content, "wish", file))]
    return [*musts, *wished]


def _split(text: str) -> tuple[str, dict[str, Any]]:
    """Kind and fields of a goal in words."""
    kind, *words = text.split() or [""]
    values: dict[str, Any] = {}
    for word in words:
        name, sign, value = word.partition("=")
        if not (name and sign and value):
            raise InvalidTarget(
                f"a goal is a kind and NAME=VALUE, such as 'look_at frame=tool0 point=1,0,0.5', got {word!r}"
            )
        table, dot, key = name.partition(".")
        if dot:
            values.setdefault(table, {})[key] = _value(value)
        else:
            values[name] = _value(value)
    return kind, values


def _entries(content: Mapping[str, Any], key: str, file: Path | None) -> Iterator[tuple[str, dict[str, Any]]]:
    """Kind and fields of each goal in a file, or of each wish."""
    entries = content.get(key, [])
    for entry in entries if isinstance(entries, list) else [entries]:
        if not isinstance(entry, dict) or not isinstance(entry.get("kind"), str):
            raise InvalidTarget(f"{file}: each [[goal]] and [[wish]] is a table with a kind: {KINDS}")
        yield entry["kind"], {name: value for name, value in entry.items() if name != "kind"}


def _wish(kind: str, values: Mapping[str, Any]) -> Wish:
    weight = values.get("weight", 1.0)
    return Wish(_goal(kind, {name: value for name, value in values.items() if name != "weight"}), weight)


def _goal(kind: str, values: Mapping[str, Any]) -> Goal:
    """A goal of a kind from its fields; a pose may be x y z, or that with roll, pitch and yaw."""
    kind = kind.replace("-", "_")
    make = lookup("kind of goal", kind, SPELLED)
    own = [field for field in fields(make) if field.init]  # type: ignore[arg-type]  # all of them are dataclasses
    needed = tuple(one.name for one in own if one.default is MISSING)
    known_keys(values, kind, InvalidTarget, needed, tuple(one.name for one in own if one.name not in needed))
    given = {name: _pose(value) if name == "pose" else value for name, value in values.items()}
    goal: Goal = make(**given)
    return goal


def _pose(value: object) -> object:
    """A pose of 3 or 6 numbers, m and rad; anything else is left to what takes it."""
    if (
        not isinstance(value, list)
        or len(value) not in (3, 6)
        or not all(isinstance(one, (int, float)) for one in value)
    ):
        return value
    turn = rpy_matrix(*value[3:]) if len(value) == 6 else np.eye(3)
    return pin.SE3(turn, np.array(value[:3], dtype=float))


def _value(text: str) -> Any:
    """A word, a number, several of them, or rows of several."""
    rows = [[_number(part) for part in row.split(",")] for row in text.split(";")]
    if any(isinstance(part, str) for row in rows for part in row):
        return text
    return rows if len(rows) > 1 else rows[0] if len(rows[0]) > 1 else rows[0][0]


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
