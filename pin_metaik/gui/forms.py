"""Inputs for the settings of a dataclass: one for each field, of its kind, and no others."""

from __future__ import annotations

import inspect
import math
import re
import types
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from pin_metaik.errors import InvalidSetting
from pin_metaik.gui.tab import Tab

UNSET = ""  # of a setting that may be None


def meanings(kind: type) -> dict[str, str]:
    """What the docstring of a dataclass says of each of its fields."""
    lines = inspect.cleandoc(kind.__doc__ or "").splitlines()
    found = (re.match(r"^ {4}(\w+): (.+)$", line) for line in lines)
    return {match[1]: match[2] for match in found if match}


class SettingsForm:
    """Inputs for an object's settings, which are the fields of a frozen dataclass that checks them.

    Args:
        tab: The tab.
        settings: The object that they are at first.
        changed: Called after every change that makes sense.
        skip: Fields that have their input elsewhere.
    """

    def __init__(
        self, tab: Tab, settings: Any, changed: Callable[[], None] = lambda: None, skip: tuple[str, ...] = ()
    ) -> None:
        self._kind = type(settings)
        self._handles: dict[str, Any] = {}
        hints, said = get_type_hints(self._kind), meanings(self._kind)
        self._read: dict[str, Callable[[Any], Any]] = {}
        self._rest = {field.name: getattr(settings, field.name) for field in fields(settings) if field.name in skip}
        for field in fields(settings):
            if field.init and field.name not in skip:
                value = getattr(settings, field.name)
                handle, read = _input(tab.client.gui, field.name, hints[field.name], value, said.get(field.name))
                self._handles[field.name], self._read[field.name] = handle, read
                handle.on_update(tab.doing(lambda: self._look(changed), "That setting is not taken"))

    @property
    def settings(self) -> Any:
        """The object with the settings that were typed.

        Raises:
            InvalidSetting: One of them makes no sense.
        """
        return self._kind(**self._rest, **self.values)

    @property
    def values(self) -> dict[str, Any]:
        """The settings that were typed."""
        return {name: self._read[name](handle.value) for name, handle in self._handles.items()}

    def show(self, values: Mapping[str, Any]) -> None:
        """Put in other values; of a setting that there is not, nothing."""
        for name, value in values.items():
            if name in self._handles:
                kept = type(self._handles[name].value)
                self._handles[name].value = UNSET if value is None else kept(value)

    def _look(self, changed: Callable[[], None]) -> None:
        _ = self.settings
        changed()


def _input(gui: Any, name: str, hint: Any, value: Any, said: str | None) -> tuple[Any, Callable[[Any], Any]]:
    """An input for a setting, and what reads its value."""
    if get_origin(hint) is Literal:
        return gui.add_dropdown(name, get_args(hint), initial_value=value, hint=said), str
    if get_origin(hint) in (Union, types.UnionType):
        kind = next(one for one in get_args(hint) if one is not type(None))
        shown = UNSET if value is None else str(value)
        return gui.add_text(name, shown, hint=f"{said or ''} Empty: its own."), lambda text: _optional(name, text, kind)
    if hint is bool:
        return gui.add_checkbox(name, value, hint=said), bool
    if hint is int:
        return gui.add_number(name, value, step=1, hint=said), int
    if hint is float:
        return gui.add_number(name, float(value), step=_step(value), hint=said), float
    raise TypeError(f"no input for {name}: {hint}")  # a new algorithm's field of another kind


def _step(value: float) -> float:
    """A step of an input: a hundredth of the power of ten that the value has."""
    return 10.0 ** (math.floor(math.log10(abs(value))) - 2) if value else 0.001


def _optional(name: str, text: str, kind: type) -> Any:
    """A number, or None for an empty text."""
    if not text.strip():
        return None
    try:
        return kind(text)
    except ValueError:
        raise InvalidSetting(f"{name}: a number or nothing, got {text!r}") from None
