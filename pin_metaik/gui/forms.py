"""Inputs for the settings of a dataclass: one for each field, of its kind, and no others."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, Literal, get_args, get_origin, get_type_hints

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
    if hint is bool:
        return gui.add_checkbox(name, value, hint=said), bool
    if hint is int:
        return gui.add_number(name, value, step=1, hint=said), int
    if hint is float:
        return gui.add_number(name, float(value), step=_step(value), hint=said), float
    inside = get_args(hint)
    if get_origin(hint) is tuple and inside in ((float, float), (float,) * 3, (int,) * 3):
        add = gui.add_vector2 if len(inside) == 2 else gui.add_vector3
        handle = add(name, tuple(float(each) for each in value), step=1.0 if inside[0] is int else 0.001, hint=said)
        return handle, lambda typed: tuple(inside[0](each) for each in typed)
    shown = UNSET if value is None else text_of(value)
    return gui.add_text(name, shown, hint=said), lambda text: value_of(name, text)


def fine(low: float, high: float) -> tuple[float, int]:
    """A step of a slider, and the decimals of its numbers: a thousandth of its range or less, and a power of ten."""
    decimals = -math.floor(math.log10(max(high - low, 1e-9) / 1000.0))
    return float(10.0**-decimals), max(decimals, 0)


def _step(value: float) -> float:
    """A step of an input: a hundredth of the power of ten that the value has."""
    return 10.0 ** (math.floor(math.log10(abs(value))) - 2) if value else 0.001


def text_of(value: Any) -> str:
    """A number, a word, a range or a list of these, as it is typed: ``0.1``, ``best``, ``0.1..0.2``, ``0, 1..2``."""
    if isinstance(value, tuple):
        ranged = len(value) == 2 and not any(isinstance(each, tuple) for each in value)
        return (".." if ranged else ", ").join(map(text_of, value))
    return value if isinstance(value, str) else repr(value)


def value_of(name: str, text: str) -> Any:
    """What was typed; None for nothing.

    Raises:
        InvalidSetting: It is neither numbers, ranges nor a word.
    """
    text = text.strip()
    if not text:
        return None
    if "," in text:
        return tuple(value_of(name, part) for part in text.split(","))
    if ".." in text:
        return tuple(_number(name, part) for part in text.split("..", 1))
    return text if text.isalpha() and text not in ("nan", "inf") else _number(name, text)


def _number(name: str, text: str) -> int | float:
    try:
        return int(text) if text.strip().lstrip("+-").isdigit() else float(text)
    except ValueError:
        raise InvalidSetting(f"{name}: a number, a range such as 0.1..0.2, or nothing; got {text!r}") from None
