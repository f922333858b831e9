"""Compiling loops: the only folder that imports numba. Import it from kernel files only, and late: it takes 0.4 s."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from functools import cache, wraps
from threading import Timer
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.compiled.on_disk import MachineCode
from pin_metaik.interrupts import Pressed

Floats = Array
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
F = TypeVar("F", bound=Callable[..., Any])

# Other threads may run meanwhile; division by zero gives inf as in C.
OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
# Sums may be taken in another order and a b + c be rounded once; infinities and NaN keep their meaning.
LOOSE = {"contract", "reassoc", "nsz", "arcp"}

WAIT = 3.0  # s; reading machine code from the cache takes a tenth of it
NOTICE = "pin_metaik: compiling inner loops for this machine, once; this takes ten to sixty seconds ..."


def kept(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Numba's dispatcher of a function, whose machine code is kept on disk."""

    def dispatcher(function: Callable[..., Any]) -> Any:
        loop = numba.njit(**options)(function)
        loop._cache = MachineCode(function)
        return loop

    return dispatcher


def jit(signature: str) -> Callable[[F], F]:
    """A function that is compiled for this numba signature when first called, or read from the cache.

    One argument's type may end in ``?``: it may be None, and the function is compiled apart for that, without what
    depends on it.
    """
    optional = _place_of_optional(signature)
    versions = signature.replace("?", ""), re.sub(r"[a-z0-9]+\[[^\]]*\]\?", "none", signature)

    def lazy(function: F) -> F:
        @cache
        def version(without: bool) -> Callable[..., Any]:
            with Pressed(held=True) as pressed:  # broken off, numba would compile nothing more in this process
                loop = _loop(function, versions[without])
                pressed.check()
            return loop

        @wraps(function)
        def call(*arguments: Any) -> Any:
            return version(optional is not None and arguments[optional] is None)(*arguments)

        def compiled(without: bool = False) -> Callable[..., Any]:
            return version(without)

        call.compiled = compiled  # type: ignore[attr-defined]  # for callers so frequent that one more frame counts
        return cast(F, call)

    return lazy


def _loop(function: Callable[..., Any], signature: str) -> Callable[..., Any]:
    """A function compiled for a signature, or read from the cache; it says so if that takes long."""
    notice = Timer(WAIT, _tell)
    notice.daemon = True
    notice.start()
    try:
        loop = kept(fastmath=LOOSE, **OPTIONS)(function)
        loop.compile(signature)
        loop.disable_compile()
        return cast(Callable[..., Any], loop)
    finally:
        notice.cancel()


@cache
def _tell() -> None:
    """Say, once a process, what the wait is for."""
    print(NOTICE, file=sys.stderr, flush=True)


def _place_of_optional(signature: str) -> int | None:
    """The number of the argument whose type ends in ``?``."""
    plain = re.sub(r"\[[^\]]*\]|Array\([^)]*\)", "", signature)
    arguments = plain[plain.rindex("(") + 1 :]
    return next((i for i, one in enumerate(arguments.split(",")) if "?" in one), None)


# Parts of loops see arrays but neither make nor return any, so that nobody need count who holds them: counting took
# a quarter of the time of a descent.
PART: dict[str, Any] = {**OPTIONS, "_nrt": False}


def inline(function: F) -> F:
    """A part of a loop: compiled into each loop that calls it, with what is constant there."""
    return cast(F, kept(fastmath=LOOSE, forceinline=True, **PART)(function))


def shared(function: F) -> F:
    """A part that several loops call: compiled once, for all of them."""
    return cast(F, kept(fastmath=LOOSE, **PART)(function))


def exact(function: F) -> F:
    """A part of a loop whose roundings must come in the order written."""
    return cast(F, kept(fastmath={"contract"}, forceinline=True, **PART)(function))


def allocating(function: F) -> F:
    """What makes arrays for a loop, before it begins, or returns parts of them."""
    return cast(F, kept(**OPTIONS)(function))
