"""What a page keeps: plain values, written to a file or into an address, and read back with every key looked at."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any, TypeVar

from pin_metaik.errors import InvalidSetting
from pin_metaik.files import json_values, known_keys
from pin_metaik.gui.gate import STATE

T = TypeVar("T")

LARGEST = 4 * 2**20  # bytes of a state
FORMAT = "pin_metaik toolbox 1"
KEYS = ("format", "page", "pages")


def state_of(kind: type[T], values: Mapping[str, Any], place: str) -> T:
    """The state of a page from plain values.

    Args:
        kind: A dataclass whose fields check their values.
        values: By field; fields that are not there have their defaults.
        place: Where the values come from, for messages.

    Raises:
        InvalidSetting: A key that is none, or a value that makes no sense.
    """
    if not isinstance(values, Mapping):
        raise InvalidSetting(f"{place}: a state is a table of names and values")
    known_keys(values, place, InvalidSetting, (), [field.name for field in fields(kind)])  # type: ignore[arg-type]
    return kind(**values)


def plain_of(state: Any) -> dict[str, Any]:
    """The plain values of the state of a page, without those that are the defaults."""
    usual = asdict(type(state)())
    return {key: value for key, value in asdict(state).items() if value != usual[key]}


def to_text(page: str, pages: Mapping[str, Mapping[str, Any]]) -> str:
    """The state of a tab as JSON: which page it shows, and what each page keeps."""
    return json.dumps({"format": FORMAT, "page": page, "pages": pages}, indent=1)


def from_text(text: str | bytes, place: str) -> tuple[str, dict[str, dict[str, Any]]]:
    """The page that is shown, and what each page keeps, from JSON.

    Raises:
        InvalidSetting: It is no such JSON.
    """
    if len(text) > LARGEST:
        raise InvalidSetting(f"{place}: a state has at most {LARGEST // 2**20} MiB")
    content = json_values(text, place, InvalidSetting)
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise InvalidSetting(f"{place} is no state of the toolbox: it has no format {FORMAT!r}")
    known_keys(content, place, InvalidSetting, KEYS)
    page, pages = content["page"], content["pages"]
    if not isinstance(page, str) or not isinstance(pages, dict) or not all(map(_is_table, pages.values())):
        raise InvalidSetting(f"{place}: page is a name, and pages are tables by name")
    return page, pages


def _is_table(value: object) -> bool:
    return isinstance(value, dict)


def to_address(page: str, pages: Mapping[str, Mapping[str, Any]]) -> str:
    """The part of an address that holds the state of a tab."""
    packed = zlib.compress(json.dumps({"format": FORMAT, "page": page, "pages": pages}).encode(), 9)
    return STATE + base64.urlsafe_b64encode(packed).decode().rstrip("=")


def from_address(path: str) -> tuple[str, dict[str, dict[str, Any]]] | None:
    """What the path of an address holds; None if it holds no state.

    Raises:
        InvalidSetting: It holds a damaged one, or one that is too large when unpacked.
    """
    if not path.startswith(STATE):
        return None
    text = path.removeprefix(STATE).strip("/")
    try:
        packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        unpacking = zlib.decompressobj()
        content = unpacking.decompress(packed, LARGEST + 1)
    except (ValueError, zlib.error) as reason:
        raise InvalidSetting(f"the state in the address is damaged: {reason}") from None
    return from_text(content, "the address")
