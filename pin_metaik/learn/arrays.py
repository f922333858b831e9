"""The array type of this package, and the check of a table of numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import InvalidSetting

Array = NDArray[np.float64]


def as_table(name: str, values: ArrayLike) -> Array:
    """A table (n, d) of finite floats.

    Raises:
        InvalidSetting: It is not one.
    """
    try:
        table = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        table = np.empty(0)
    if table.ndim != 2 or table.size == 0 or not np.isfinite(table).all():
        raise InvalidSetting(f"{name} must be a table (n, d) of finite numbers, got shape {np.shape(values)}")
    return table
