"""Numbers given by a caller as floats, NaN for anything that is not a number."""

from __future__ import annotations

import math
from numbers import Real

import numpy as np


def real(value: object) -> float:
    """A number as a float; NaN for a text, a truth value, or a number too large for a float."""
    try:
        return float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    except OverflowError:
        return math.nan


def three(value: object) -> tuple[float, float, float] | None:
    """Three finite numbers of a list, tuple or array; None, if that is not what was given."""
    listed = value.tolist() if isinstance(value, np.ndarray) else value
    if not isinstance(listed, list | tuple) or len(listed) != 3:
        return None
    x, y, z = map(real, listed)
    return (x, y, z) if math.isfinite(x) and math.isfinite(y) and math.isfinite(z) else None
