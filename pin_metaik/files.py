"""Reading files: their contents, or an error of ours that names the file and the key."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from pin_metaik.errors import MetaIKError, meant

Error = type[MetaIKError]


def read_text(path: Path | Traversable, error: Error, kind: str = "text") -> str:
    """The text of a file in UTF-8, without a byte order mark.

    Args:
        path: The file; ``~`` in front is the user's home.
        error: What to raise if it is missing or no text; made from one sentence.
        kind: Kind of the file, for the message.
    """
    try:
        return (path.expanduser() if isinstance(path, Path) else path).read_text(encoding="utf-8-sig")
    except (OSError, RuntimeError) as reason:  # RuntimeError: there is no home
        raise error(f"cannot read {path}: {getattr(reason, 'strerror', None) or reason}") from None
    except ValueError as reason:
        raise error(f"{path} is not {kind}: it is not UTF-8 text: {reason}") from None


def read_json(path: Path | Traversable, error: Error, kind: str = "JSON") -> Any:
    """The contents of a JSON file.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed, or has a key twice; made from one sentence.
        kind: Kind of the file, for the message.
    """
    text = read_text(path, error, kind)
    try:
        return json.loads(text, object_pairs_hook=_once)
    except (ValueError, RecursionError) as reason:
        raise error(f"{path} is not {kind}: {reason}") from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object whose keys are all different."""
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"the key {next(name for name in names if names.count(name) > 1)!r} is there twice")
    return content


def known_keys(
    content: Mapping[Any, Any],
    place: object,
    error: Callable[[str], MetaIKError],
    needed: Collection[str],
    optional: Collection[str] = (),
) -> None:
    """Make sure that a mapping has no unknown key, then that it has all required ones.

    Args:
        content: Contents of a file, or a part of them.
        place: The file, and where in it.
        error: What to raise, with the key that was perhaps meant; made from one sentence.
        needed: Keys that must be there.
        optional: Keys that may be there.
    """
    for key in content:
        if key not in needed and key not in optional:
            raise error(f"{place}: unknown key {key!r}; {meant(str(key), (*needed, *optional))}")
    for key in needed:
        if key not in content:
            raise error(f"{place}: {key} is missing")
