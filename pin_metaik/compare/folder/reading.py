"""The JSON files of a comparison, read back: they may have been edited, and wrong keys and values are named."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from pin_metaik.errors import InvalidSetting
from pin_metaik.files import known_keys


def entries(values: object, place: object, needed: Collection[str], optional: Collection[str] = ()) -> dict[str, Any]:
    """A JSON object with the keys that it should have and no others.

    Raises:
        InvalidSetting: The value is no object, lacks a key, or has an unknown one.
    """
    if not isinstance(values, dict):
        raise InvalidSetting(f"{place} is not an object with {', '.join(needed)}")
    known_keys(values, place, InvalidSetting, needed, optional)
    return values
