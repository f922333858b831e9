"""A metaheuristic on the command line: its name, and settings as ``key=value``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar, cast

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.optimize import Metaheuristic, make

T = TypeVar("T")

KEPT = "agents"
"""The one setting that means the same to all: how many of them search."""


def configured(current: str | Metaheuristic, name: str | None, settings: Sequence[str] = ()) -> Metaheuristic:
    """The metaheuristic of this name with as many agents as the current one, or the current one; then the settings.

    Args:
        current: What there is without options.
        name: Another one's name.
        settings: ``key=value`` each.

    Raises:
        UnknownName: No metaheuristic, or no setting of it, of that name.
        InvalidSetting: Not ``key=value``, or a value that the setting does not take.
    """
    before = make(current)
    chosen = before if name is None else make(name)
    values = values_of(chosen, settings)
    if name is not None and type(chosen) is not type(before) and hasattr(before, KEPT) and hasattr(chosen, KEPT):
        values = {KEPT: getattr(before, KEPT), **values}
    return with_values(chosen, values)


def with_values(chosen: T, values: Mapping[str, Any]) -> T:
    """An object with other values of some of its settings, which are the fields of a dataclass."""
    if not values or not is_dataclass(chosen) or isinstance(chosen, type):
        return chosen
    return cast(T, replace(chosen, **values))


def values_of(chosen: object, settings: Sequence[str]) -> dict[str, Any]:
    """The values that ``key=value`` each give to settings of an object, which are the fields of a dataclass.

    Raises:
        UnknownName: No setting of it is so called.
        InvalidSetting: Not ``key=value``.
    """
    known: list[str] = [field.name for field in fields(chosen)] if is_dataclass(chosen) else []
    values: dict[str, Any] = {}
    for setting in settings:
        key, sign, text = setting.partition("=")
        if not sign or not text:
            raise InvalidSetting(f"a setting is key=value, such as {KEPT}=60, got {setting!r}")
        if key.strip() not in known:
            raise UnknownName(f"setting of {type(chosen).__name__}", key.strip(), known)
        values[key.strip()] = _value(text.strip())
    return values


def _value(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
