"""Files in: what they hold, or a named error that says which file and which key is wrong."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from difflib import get_close_matches
from importlib.resources.abc import Traversable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pin_metaik.errors import MetaIKError, MissingExtra

Error = type[MetaIKError]


def read_text(path: Path | Traversable, error: Error) -> str:
    """The text of a file in UTF-8.

    Args:
        path: The file.
        error: What to raise if it is missing or no text; made from one sentence.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as reason:
        raise error(f"cannot read {path}: {reason.strerror}") from None
    except ValueError as reason:
        raise error(f"{path} is not text in UTF-8: {reason}") from None


def read_json(path: Path | Traversable, error: Error, kind: str = "JSON") -> Any:
    """What a JSON file holds.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.
        kind: What the file should be, for that.
    """
    text = read_text(path, error)
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as reason:
        raise error(f"{path} is not {kind}: {reason}") from None


def read_yaml(path: Path, error: Error) -> Any:
    """What a YAML file holds, plain values only.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.

    Raises:
        MissingExtra: PyYAML is not installed.
    """
    if find_spec("yaml") is None:
        raise MissingExtra(f"reading {path}", "mobile")
    import yaml

    text = read_text(path, error)
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as reason:
        raise error(f"{path} is not YAML: {' '.join(str(reason).split())}") from None


def only(mapping: Mapping[Any, Any], known: Collection[str], place: str, error: Error) -> None:
    """Make sure that a mapping has no key that nobody would read.

    Args:
        mapping: What a file holds.
        known: The keys it may have.
        place: The file.
        error: What to raise, with the key that was perhaps meant.
    """
    for key in mapping:
        if key not in known:
            near = get_close_matches(str(key), known, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
            raise error(f"{place}: unknown key {key!r}; {hint}")


def number(mapping: Mapping[str, Any], key: str, place: str, error: Error) -> float:
    """The finite number at a key.

    Args:
        mapping: What a file holds.
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
