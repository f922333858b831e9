"""Results as plain values: what JSON has, and nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from enum import Enum
from numbers import Integral, Real
from os import PathLike
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """A value as plain ones: None for a number that is not finite, lists for arrays, dicts for named tuples."""
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, Enum):
        return plain(value.value)
    if isinstance(value, (str, PathLike)):
        return str(value)
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return plain(value._asdict())
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Iterable):
        return [plain(entry) for entry in value]
    raise TypeError(f"{value!r} has no plain value")


def fields_of(result: object, *names: str) -> dict[str, Any]:
    """Attributes of a result by name, as plain values."""
    return {name: plain(getattr(result, name)) for name in names}
