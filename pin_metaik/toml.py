"""TOML files and their tables; a table names its place in messages about wrong keys and values."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from decimal import Decimal
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from pin_metaik.errors import InvalidTable, MetaIKError
from pin_metaik.files import known_keys, plain_values, read_text
from pin_metaik.units import PURE, Unit

T = TypeVar("T")
Span: TypeAlias = float | tuple[float, float]
"""A value that is fixed, or the range of one that is free."""


def read_toml(
    path: Path | Traversable, error: type[MetaIKError] = InvalidTable, number: Callable[[str], Any] = float
) -> dict[str, Any]:
    """The contents of a TOML file.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.
        number: What makes a number of the text of one that is not whole: ``Decimal`` loses nothing of it.
    """
    return toml_values(read_text(path, error, "TOML"), path, error, number)


def toml_values(
    text: str, place: object, error: type[MetaIKError], number: Callable[[str], Any] = float
) -> dict[str, Any]:
    """The contents of a text in TOML.

    Args:
        text: The text.
        place: Where it is.
        error: What to raise if it is malformed; made from one sentence.
        number: As of ``read_toml``.
    """
    try:
        content = tomllib.loads(text, parse_float=number)
    except (ValueError, RecursionError) as reason:
        raise error(f"{place} is not TOML: {reason}") from None
    except ArithmeticError:  # of a Decimal whose exponent has more than 18 digits
        raise error(f"{place} is not TOML that can be read: it has a number of more than 308 digits") from None
    plain_values(content, len(text), place, error, "TOML")
    return content


class Table:
    """One table of the file: it knows its place, and refuses unknown keys first, then missing ones."""

    def __init__(self, content: object, place: str, needed: tuple[str, ...], optional: tuple[str, ...] = ()) -> None:
        if not isinstance(content, dict):
            raise InvalidTable(f"{place} = {content!r} is not a table")
        self.content, self.place = content, place
        known_keys(content, place, InvalidTable, needed, optional)

    def __contains__(self, key: str) -> bool:
        return key in self.content

    def at(self, key: str) -> str:
        """Where a key is, for a complaint."""
        return f"{self.place}: {key} = {_shown(self.content[key])}"

    def text(self, key: str, default: str = "") -> str:
        """A text."""
        value = self.content.get(key, default)
        if not isinstance(value, str):
            raise InvalidTable(f"{self.at(key)} is not text")
        return value

    def one_of(self, key: str, known: Mapping[str, T]) -> T:
        """The unit that a text names."""
        name = self.text(key)
        if name not in known:
            raise InvalidTable(f"{self.at(key)} is not one of the units {', '.join(known)}")
        return known[name]

    def whole(self, key: str) -> int:
        """A whole number."""
        value = self.content[key]
        if isinstance(value, bool) or not isinstance(value, int):
            raise InvalidTable(f"{self.at(key)} is not a whole number")
        return value

    def flag(self, key: str) -> bool:
        """True or false."""
        value = self.content[key]
        if not isinstance(value, bool):
            raise InvalidTable(f"{self.at(key)} is neither true nor false")
        return value

    def number(self, key: str, unit: Unit = PURE) -> float:
        """A finite number, in the package's unit."""
        return self._number(key, self.content[key], unit)

    def one_or_each(self, key: str, unit: Unit = PURE) -> float | tuple[float, ...]:
        """A finite number, or a list of them."""
        return self.numbers(key, unit) if isinstance(self.content[key], list) else self.number(key, unit)

    def numbers(self, key: str, unit: Unit = PURE, count: int | None = None) -> tuple[float, ...]:
        """A list of finite numbers, of this many if it matters."""
        return tuple(self._number(key, value, unit) for value in self._list(key, count))

    def wholes(self, key: str, count: int | None = None) -> tuple[int, ...]:
        """A list of whole numbers."""
        values = self._list(key, count)
        if not all(isinstance(value, int) and not isinstance(value, bool) for value in values):
            raise InvalidTable(f"{self.at(key)} is not a list of whole numbers")
        return tuple(values)

    def points(self, key: str, unit: Unit) -> tuple[tuple[float, ...], ...]:
        """A list of points of three numbers each."""
        return tuple(tuple(self._number(key, value, unit) for value in point) for point in self._points(key))

    def span(self, key: str, unit: Unit) -> Span:
        """A number, or a range of two."""
        return self._span(key, self.content[key], unit)

    def spans(self, key: str, unit: Unit) -> tuple[Span, ...]:
        """A list of numbers and ranges."""
        return tuple(self._span(key, value, unit) for value in self._list(key, None))

    def point_spans(self, key: str, unit: Unit) -> tuple[tuple[Span, ...], ...]:
        """A list of points of three numbers or ranges each."""
        return tuple(tuple(self._span(key, value, unit) for value in point) for point in self._points(key))

    def _points(self, key: str) -> list[list[Any]]:
        points = self._list(key, None)
        if not all(isinstance(point, list) and len(point) == 3 for point in points):
            raise InvalidTable(f"{self.at(key)} is not a list of points [x, y, z]")
        return points

    def _span(self, key: str, value: object, unit: Unit) -> Span:
        if not isinstance(value, list):
            return self._number(key, value, unit)
        if len(value) != 2:
            raise InvalidTable(f"{self.at(key)} holds {_shown(value)}, which is neither a number nor a range of two")
        low, high = (self._number(key, end, unit) for end in value)
        return low, high

    def _list(self, key: str, count: int | None) -> list[Any]:
        values = self.content[key]
        if not isinstance(values, list) or (count is not None and len(values) != count):
            raise InvalidTable(f"{self.at(key)} is not a list of {count or 'numbers'}{' numbers' if count else ''}")
        return values

    def _number(self, key: str, value: object, unit: Unit) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, Decimal)):
            raise InvalidTable(f"{self.at(key)}: {_shown(value)} is not a number")
        if not Decimal(value).is_finite():
            raise InvalidTable(f"{self.at(key)}: {_shown(value)} is not finite")
        return unit.read(value)


def _shown(value: object) -> str:
    """A value as the file has it."""
    match value:
        case bool():
            return str(value).lower()
        case Decimal():
            return str(value).lower()
        case list():
            return f"[{', '.join(_shown(entry) for entry in value)}]"
        case _:
            return repr(value)
