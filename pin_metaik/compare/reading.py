"""The JSON files of a comparison, read back: somebody may have edited them, and what is wrong is named."""

from __future__ import annotations

import json
from collections.abc import Collection
from pathlib import Path
from typing import Any

from pin_metaik.errors import InvalidSetting


def read_json(path: Path) -> Any:
    """What a JSON file holds.

    Raises:
        InvalidSetting: It cannot be read, or is not JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidSetting(f"cannot read {path}: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise InvalidSetting(f"{path} is not JSON: {error}") from None


def entries(values: object, place: object, needed: Collection[str], optional: Collection[str] = ()) -> dict[str, Any]:
    """A JSON object with the keys that it should have and no others.

    Raises:
        InvalidSetting: It is none, lacks one, or has another.
    """
    if not isinstance(values, dict):
        raise InvalidSetting(f"{place} is not an object with {', '.join(needed)}")
    for key in values:
        if key not in needed and key not in optional:
            raise InvalidSetting(f"{place}: unknown key {key!r}; known: {', '.join((*needed, *optional))}")
    for key in needed:
        if key not in values:
            raise InvalidSetting(f"{place}: {key} is missing")
    return values
