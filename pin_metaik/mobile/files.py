"""YAML files in, and numbers at their keys, or a named error that says which file and which key is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pin_metaik.files import Error, plain_values, read_text
from pin_metaik.lookup import need


def read_yaml(path: Path, error: Error) -> Any:
    """The contents of a YAML file, plain values only.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.

    Raises:
        MissingExtra: PyYAML is not installed.
    """
    need(f"reading {path}", "mobile", "yaml")
    import yaml

    text = read_text(path, error)
    try:
        content = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as reason:
        raise error(f"{path} is not YAML: {' '.join(str(reason).split())}") from None
    return plain_values(content, len(text), path, error, "YAML")


def number(mapping: Mapping[str, Any], key: str, place: str, error: Error) -> float:
    """The finite number at a key.

    Args:
        mapping: Contents of a file.
        key: It is there.
        place: The file.
        error: What to raise if it is no such number.
    """
    return numbers([mapping[key]], 1, key, place, error)[0]


def numbers(values: Any, count: int, key: str, place: str, error: Error) -> list[float]:
    """So many finite numbers; text that is one (as YAML's 5e-2) counts.

    Args:
        values: What was found.
        count: How many there must be.
        key: Where.
        place: The file.
        error: What to raise if they are not.
    """
    wanted = "a number" if count == 1 else f"{count} numbers"
    given = values[0] if count == 1 else values
    if not isinstance(values, (list, tuple)) or len(values) != count or any(isinstance(v, bool) for v in values):
        raise error(f"{place}: {key} must be {wanted}, not {given!r}")
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        raise error(f"{place}: {key} must be {wanted}, not {given!r}") from None
    if not all(abs(value) < float("inf") for value in found):
        raise error(f"{place}: {key} must be finite, not {given!r}")
    return found
