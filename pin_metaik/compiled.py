"""Compiling loops: the only file that imports numba. Import it from kernel files only, and late: it takes 0.4 s."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
F = TypeVar("F", bound=Callable[..., Any])

# Machine code is kept on disk; other threads may run meanwhile; division by zero gives inf as in C; a b + c may be
# one rounding instead of two.
OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": {"contract"}}


def jit(signature: str) -> Callable[[F], F]:
    """Compile a function of this numba signature when its module is imported, or read it from the cache."""
    return cast(Callable[[F], F], numba.njit(signature, **OPTIONS))


def inline(function: F) -> F:
    """A part of a loop: compiled with and into the loop that calls it."""
    return cast(F, numba.njit(**OPTIONS)(function))
