"""Compiling every loop ahead of its first call, on all cores."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from importlib import import_module
from itertools import groupby, zip_longest
from multiprocessing import get_context
from pathlib import Path

from pin_metaik.compiled import LOOPS
from pin_metaik.compiled.on_disk import MachineCode, kept_in
from pin_metaik.compiled.separate_parts import SEPARATE
from pin_metaik.compiled.sources import modules
from pin_metaik.errors import CannotWrite, MissingExtra
from pin_metaik.interrupts import deaf_children


@dataclass(frozen=True)
class Version:
    """One of the functions that a loop is compiled into."""

    module: str
    name: str
    without: bool
    """Compiled for None in place of the argument that may be None."""

    @property
    def ready(self) -> bool:
        """Whether its machine code can be read from somewhere."""
        loop = LOOPS[self.module, self.name]
        return loop.machine_code.has(loop.signatures[self.without])

    def compile(self) -> None:
        """Have its machine code in this process, and on disk where that can be."""
        import_module(self.module)
        LOOPS[self.module, self.name].compiled(self.without)


def versions() -> tuple[list[Version], list[str]]:
    """All loops, and for each optional dependency that is missing a line with its extra."""
    missing: dict[str, None] = {}
    for module in modules():
        try:
            import_module(module)
        except MissingExtra as error:
            missing[str(error)] = None
    return [Version(*at, without) for at, loop in LOOPS.items() for without in loop.signatures], list(missing)


def folder_for(loops: list[Version]) -> Path | None:
    """The folder, or the one above the folders, that their machine code is written to.

    Raises:
        CannotWrite: No folder for the machine code of one of them can be written.
    """
    folders = [kept_in(Path(str(sys.modules[loop.module].__file__))) for loop in loops]
    if None in folders:
        raise CannotWrite(
            "machine code can be kept nowhere: neither beside the package nor in a cache folder; set NUMBA_CACHE_DIR "
            "to a folder that can be written"
        )
    return Path(os.path.commonpath([str(folder) for folder in folders])) if folders else None


def machine_code() -> list[MachineCode]:
    """Of all loops, and of the parts that have some of their own."""
    return [*(loop.machine_code for loop in LOOPS.values()), *(part._cache for part in SEPARATE.values())]


def each(work: Callable[[Version], None], loops: list[Version]) -> Iterator[Version]:
    """Do something to each in one of as many processes as there are cores; yields them as they are done."""
    pool = ProcessPoolExecutor(min(_cores(), max(len(loops), 1)), mp_context=get_context("spawn"))
    try:
        with deaf_children():
            waiting = {pool.submit(work, loop): loop for loop in spread(loops)}
        for done in as_completed(waiting):
            done.result()
            yield waiting[done]
    finally:
        pool.shutdown(cancel_futures=True)


def spread(loops: list[Version]) -> list[Version]:
    """Those of one folder apart: they have parts in common, which two processes at once would compile twice."""
    folders = [list(some) for _, some in groupby(loops, key=lambda loop: loop.module.rpartition(".")[0])]
    return [loop for row in zip_longest(*folders) for loop in row if loop is not None]


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
