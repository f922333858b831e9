"""Checks of an algorithm's settings, made once, when it is built."""

from __future__ import annotations

import math
from typing import Any, get_args

import numpy as np

from pin_metaik.arguments import shown
from pin_metaik.errors import InvalidSetting


def whole(name: str, value: int, minimum: int) -> None:
    """A whole number that is at least `minimum`.

    Raises:
        InvalidSetting: It is not.
    """
    if isinstance(value, bool) or not hasattr(value, "__index__") or isinstance(value, np.ndarray) or value < minimum:
        raise InvalidSetting(f"{name} must be a whole number of at least {minimum}, not {shown(value)}")


MANY = 10_000_000
"""Points, samples or solutions that one call may ask for: more would not fit into a machine's memory."""


def few(name: str, value: int, minimum: int = 1) -> None:
    """A whole number of things that are all held at once: at least `minimum`, at most ten million.

    Raises:
        InvalidSetting: It is not.
    """
    whole(name, value, minimum)
    if value > MANY:
        raise InvalidSetting(f"{name} is at most {MANY:,} at a time, not {shown(value)}")


def within(name: str, value: float, low: float, high: float = math.inf) -> None:
    """A number in ``[low, high]``; NaN is not.

    Raises:
        InvalidSetting: It is not.
    """
    try:
        inside = bool(low <= value <= high) and float(value) <= high
    except (TypeError, ValueError, OverflowError):
        inside = False
    if not inside:
        raise InvalidSetting(f"{name} must be a number from {low:g} to {high:g}, not {shown(value)}")


def positive(name: str, value: float) -> None:
    """A finite number above 0.

    Raises:
        InvalidSetting: It is not.
    """
    try:
        fine = bool(value > 0) and float(value) < math.inf
    except (TypeError, ValueError, OverflowError):
        fine = False
    if not fine:
        raise InvalidSetting(f"{name} must be a number above 0, not {shown(value)}")


def one_of(name: str, value: str, literal: Any) -> None:
    """One of the values of a ``Literal`` type.

    Raises:
        InvalidSetting: It is not; the message lists them.
    """
    if not isinstance(value, str) or value not in get_args(literal):
        raise InvalidSetting(f"{name} must be one of {', '.join(map(repr, get_args(literal)))}, not {shown(value)}")
