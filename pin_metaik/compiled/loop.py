"""A loop: a function of the package that is compiled for one signature, or read from the cache."""

from __future__ import annotations

import gc
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import cache, cached_property
from threading import Timer
from typing import Any, cast

import numba

from pin_metaik.compiled.on_disk import MachineCode
from pin_metaik.compiled.parts import LoopCompiler
from pin_metaik.compiled.types_of_calls import found_out_once
from pin_metaik.interrupts import Pressed

# Other threads may run meanwhile; division by zero gives inf as in C.
OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
# Sums may be taken in another order and a b + c be rounded once; infinities and NaN keep their meaning.
LOOSE = {"contract", "reassoc", "nsz", "arcp"}

WAIT = 3.0  # s
NOTICE = (
    "pin_metaik: compiling inner loops for this machine, once; this takes ten to sixty seconds "
    "(`pin-metaik warm` compiles all of them ahead) ..."
)


@contextmanager
def uncollected() -> Iterator[None]:
    """Without Python's garbage collector: it took an eighth of compiling to look through what numba still uses."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


class Loop:
    """A function and the versions that it is compiled into.

    Attributes:
        function: It.
        optional: The number of the argument that may be None; None: there is no such argument.
        signatures: Numba's, by whether it is compiled without that argument.
    """

    def __init__(self, function: Callable[..., Any], signature: str) -> None:
        self.function = function
        self.optional = _place_of_optional(signature)
        self.signatures = {False: signature.replace("?", "")}
        if self.optional is not None:
            self.signatures[True] = re.sub(r"[a-z0-9]+\[[^\]]*\]\?", "none", signature)

    @property
    def module(self) -> str:
        """Of the function."""
        return self.function.__module__

    @property
    def name(self) -> str:
        """Of the function, in its module."""
        return self.function.__qualname__

    @cached_property
    def machine_code(self) -> MachineCode:
        """Where its machine code is looked for."""
        return MachineCode(self.function)

    def compiled(self, without: bool = False) -> Callable[..., Any]:
        """Numba's function, compiled now or read from the cache."""
        # broken off, numba would compile nothing more in this process
        with Pressed(held=True), uncollected():
            loop = numba.njit(pipeline_class=LoopCompiler, fastmath=LOOSE, no_cfunc_wrapper=True, **OPTIONS)(
                self.function
            )
            loop._cache = self.machine_code
            signature = self.signatures[without]
            with nullcontext() if loop._cache.has(signature) else loop._cache.turn(), found_out_once():
                loop.compile(signature)
            loop.disable_compile()
        return cast(Callable[..., Any], loop)

    def announced(self, without: bool = False) -> Callable[..., Any]:
        """The same, with a word if it is compiled and that takes long."""
        if self.machine_code.has(self.signatures[without]):  # to read it takes long on a busy machine only
            return self.compiled(without)
        notice = Timer(WAIT, _tell)
        notice.daemon = True
        notice.start()
        try:
            return self.compiled(without)
        finally:
            notice.cancel()


@cache
def _tell() -> None:
    """Announce the compilation, once a process."""
    print(NOTICE, file=sys.stderr, flush=True)


def _place_of_optional(signature: str) -> int | None:
    """The number of the argument whose type ends in ``?``."""
    plain = re.sub(r"\[[^\]]*\]|Array\([^)]*\)", "", signature)
    arguments = plain[plain.rindex("(") + 1 :]
    return next((i for i, one in enumerate(arguments.split(",")) if "?" in one), None)
