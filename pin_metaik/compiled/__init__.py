"""Compiling loops: the only folder that imports numba. Import it from kernel files only, and late: it takes 0.4 s."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, wraps
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.compiled.loop import LOOSE, OPTIONS, Loop
from pin_metaik.compiled.on_disk import MachineCode
from pin_metaik.compiled.parts import Part
from pin_metaik.compiled.separate_parts import Separate

Floats = Array
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
F = TypeVar("F", bound=Callable[..., Any])

LOOPS: dict[tuple[str, str], Loop] = {}  # by module and name: those of the modules imported so far


def jit(signature: str) -> Callable[[F], F]:
    """A function that is compiled for this numba signature when first called, or read from the cache.

    One argument's type may end in ``?``: it may be None, and the function is compiled apart for that, without what
    depends on it.
    """

    def lazy(function: F) -> F:
        loop = Loop(function, signature)
        LOOPS[loop.module, loop.name] = loop
        optional, version = loop.optional, cache(loop.announced)

        @wraps(function)
        def call(*arguments: Any) -> Any:
            return version(optional is not None and arguments[optional] is None)(*arguments)

        def compiled(without: bool = False) -> Callable[..., Any]:
            return version(without)

        call.compiled = compiled  # type: ignore[attr-defined]  # for callers so frequent that one more frame counts
        return cast(F, call)

    return lazy


# Parts of loops are compiled without reference counting (no NRT): they take arrays, but neither make nor return any.
# Counting took 25 % of the time of a descent. An option that a part is not given is that of its first caller.
PART: dict[str, Any] = {**OPTIONS, "_nrt": False}


def inline(function: F) -> F:
    """A part of a loop: compiled into each loop that calls it, with the constants of that loop."""
    return cast(F, _part(Part(function, fastmath=LOOSE, forceinline=True, **PART), "inline"))


def shared(function: F) -> F:
    """A part that a loop calls from several places: it is in the loop once."""
    return cast(F, _part(Part(function, fastmath=LOOSE, forceinline=False, **PART), "shared"))


def exact(function: F) -> F:
    """A part of a loop whose roundings must come in the order written."""
    return cast(F, _part(Part(function, fastmath={"contract"}, forceinline=True, **PART), "exact"))


def allocating(function: F) -> F:
    """A part that makes arrays for a loop before it begins, or returns views of them."""
    return cast(F, _part(Part(function, fastmath=LOOSE, forceinline=False, **OPTIONS), "allocating"))


def separate(function: F) -> F:
    """A part that many loops call seldom: it has machine code of its own, and is in none of them."""
    return cast(F, _part(Separate(function, fastmath=LOOSE, forceinline=False, **PART), "separate"))


def separate_allocating(function: F) -> F:
    """The same of a part that makes arrays."""
    return cast(
        F, _part(Separate(function, fastmath=LOOSE, forceinline=False, _nrt=True, **OPTIONS), "separate_allocating")
    )


def _part(part: Part, variant: str) -> Part:
    part._cache = MachineCode(part.py_func, variant)
    return part
