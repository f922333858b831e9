"""Checks of an algorithm's settings, made once, when it is built."""

from __future__ import annotations

import math
from typing import Any, get_args

from pin_metaik.errors import InvalidSetting


def whole(name: str, value: int, minimum: int) -> None:
    """A whole number that is at least `minimum`.

    Raises:
        InvalidSetting: It is not.
    """
    if isinstance(value, bool) or not hasattr(value, "__index__") or value < minimum:
        raise InvalidSetting(f"{name} must be a whole number of at least {minimum}, not {value!r}")


def within(name: str, value: float, low: float, high: float = math.inf) -> None:
    """A number in ``[low, high]``; NaN is not.

    Raises:
        InvalidSetting: It is not.
    """
    try:
        inside = low <= value <= high
    except TypeError:
        inside = False
    if not inside:
        raise InvalidSetting(f"{name} must be a number from {low:g} to {high:g}, not {value!r}")


def positive(name: str, value: float) -> None:
    """A finite number above 0.

    Raises:
        InvalidSetting: It is not.
    """
    try:
        fine = 0 < value < math.inf
    except TypeError:
        fine = False
    if not fine:
        raise InvalidSetting(f"{name} must be a number above 0, not {value!r}")


def one_of(name: str, value: str, literal: Any) -> None:
    """One of the values of a ``Literal`` type.

    Raises:
        InvalidSetting: It is not; the message lists them.
    """
    if value not in get_args(literal):
        raise InvalidSetting(f"{name} must be one of {', '.join(map(repr, get_args(literal)))}, not {value!r}")
