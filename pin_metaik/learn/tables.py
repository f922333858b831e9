"""The check of a table of numbers."""

from __future__ import annotations

from numpy.typing import ArrayLike

from pin_metaik.arguments import array
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting


def as_table(name: str, values: ArrayLike) -> Array:
    """A table (n, d) of finite floats.

    Raises:
        InvalidSetting: It is not one.
    """
    table = array(name, values, "n", "d")
    if table.size == 0:
        raise InvalidSetting(f"{name} must be a table (n, d) that is not empty, got shape {table.shape}")
    return table
