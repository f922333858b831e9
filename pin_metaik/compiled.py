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

# Machine code is kept on disk; other threads may run meanwhile; division by zero gives inf as in C.
OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
# Sums may be taken in another order and a b + c be rounded once; infinities and NaN keep their meaning.
LOOSE = {"contract", "reassoc", "nsz", "arcp"}


def jit(signature: str) -> Callable[[F], F]:
    """Compile a function of this numba signature when its module is imported, or read it from the cache."""
    return cast(Callable[[F], F], numba.njit(signature, fastmath=LOOSE, **OPTIONS))


def inline(function: F) -> F:
    """A part of a loop: compiled into the loop that calls it, with what is constant there."""
    return cast(F, numba.njit(fastmath=LOOSE, forceinline=True, **OPTIONS)(function))


def exact(function: F) -> F:
    """A part of a loop whose roundings must come in the order written."""
    return cast(F, numba.njit(fastmath={"contract"}, forceinline=True, **OPTIONS)(function))
