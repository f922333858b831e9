"""Machine code kept on disk, stamped with one digest over all the sources it is made from.

Numba's own cache looks at the one file that a loop stands in, so that a loop kept the old code of the parts it has from
other files; and it wants a folder it can write to even where the code is there to be read. Here code is read from the
wheel, if that carries some that fits, or the first folder that has it, and written to the first that takes it; without
any, everything is compiled anew in each process.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from hashlib import sha256
from pathlib import Path
from pickle import UnpicklingError
from typing import Any, cast

from numba.core import caching, config
from numba.core.registry import cpu_target

from pin_metaik.cache_folder import cache_folder
from pin_metaik.compiled import kept
from pin_metaik.compiled.baseline import Baseline, baseline
from pin_metaik.compiled.sources import PACKAGE, digest
from pin_metaik.locks import locked

SHIPPED = PACKAGE / "compiled" / "machine_code"  # in a wheel for one platform
UNREADABLE = OSError, EOFError, ValueError, UnpicklingError  # may not be read or written, or was cut off


def folders(file: Path) -> Iterator[Path]:
    """Where machine code of a source file of the package may be kept, in the order of looking.

    ``$NUMBA_CACHE_DIR`` if it is set, then ``__pycache__`` beside the file, then the user's cache folder.
    """
    inside = _inside(file)
    installation = f"{PACKAGE.name}-{sha256(bytes(PACKAGE)).hexdigest()[:16]}"  # several may share a folder
    if config.CACHE_DIR:
        yield Path(config.CACHE_DIR) / installation / inside
    yield file.parent / "__pycache__"
    if (own := cache_folder()) is not None:
        yield own / "machine_code" / installation / inside


def _inside(file: Path) -> Path:
    """The folder of a source file, seen from the package's."""
    return file.parent.relative_to(PACKAGE)


def kept_in(file: Path) -> Path | None:
    """The first of these folders that can be written, or made."""
    for folder in folders(file):
        there = next(above for above in (folder, *folder.absolute().parents) if above.exists())
        if there.is_dir() and os.access(there, os.W_OK | os.X_OK):
            return folder
    return None


class MachineCode(caching.NullCache):
    """What numba's dispatcher asks for the machine code of one function, or of one of its variants."""

    def __init__(self, function: Callable[..., Any], variant: str = "") -> None:
        self._function, self._file = function, Path(function.__code__.co_filename)
        self._shelves = [Shelf(function, folder, variant) for folder in folders(self._file)]
        processor = baseline()
        inside = SHIPPED / _inside(self._file)
        shipped = [] if processor is None else [Shipped(function, inside, variant, processor)]
        self._readable: list[Shelf] = [*shipped, *self._shelves]

    def has(self, signature: Any) -> bool:
        """Whether there is code for a signature, to go by the indices; a file may still turn out to be cut off."""
        for shelf in self._readable:
            with suppress(*UNREADABLE):
                if shelf.has(signature):
                    return True
        return False

    @contextmanager
    def turn(self) -> Iterator[None]:
        """While one process compiles the function, others wait for the code that it writes."""
        folder = kept_in(self._file)
        with ExitStack() as held:
            if folder is not None:  # or there is nothing to wait for
                with suppress(OSError):
                    folder.mkdir(parents=True, exist_ok=True)
                    held.enter_context(
                        locked(folder / f".{self._file.stem}.{self._function.__qualname__}.lock", wait=True)
                    )
            yield

    def ship(self) -> None:
        """Copy what is kept of it to where a wheel carries it."""
        kept = next(shelf for shelf in self._shelves if shelf.files())
        inside = SHIPPED / _inside(self._file)
        inside.mkdir(parents=True, exist_ok=True)
        for file in kept.files():
            shutil.copy(file, inside)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """The code for a signature from the first folder that has it, or None."""
        for shelf in self._readable:
            try:
                code = shelf.load_overload(signature, context)
            except UNREADABLE:
                continue
            if code is not None:
                return code
        return None

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep the code in the first folder that takes it."""
        for shelf in self._shelves:
            try:
                Path(shelf.cache_path).mkdir(parents=True, exist_ok=True)
                shelf.save_overload(signature, code)
            except UNREADABLE:
                continue
            return


class Shelf(caching.FunctionCache):
    """Numba's cache of one function in a given folder, which need be neither writable nor there."""

    def __init__(self, function: Callable[..., Any], folder: Path, variant: str) -> None:
        self._impl_class = partial(_Implementation, folder=folder, variant=variant)
        super().__init__(function)

    def has(self, signature: Any) -> bool:
        """Whether the index knows code for a signature and this processor."""
        return self._index_key(signature, cpu_target.target_context.codegen()) in self._cache_file._load_index()

    def files(self) -> list[Path]:
        """Its index, and a file for each signature."""
        return list(Path(self.cache_path).glob(f"{self._impl.filename_base}.*nb[ci]"))


class Shipped(Shelf):
    """Machine code that came with the package, for a processor with a subset of the instructions of this one."""

    def __init__(self, function: Callable[..., Any], folder: Path, variant: str, processor: Baseline) -> None:
        super().__init__(function, folder, variant)
        self._processor = processor

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        signature, (triple, _, _), source = super()._index_key(sig, codegen)
        return signature, (triple, self._processor.name, ""), source


class _Implementation(caching.CompileResultCacheImpl):
    """How numba names and writes the files of one function."""

    def __init__(self, function: Callable[..., Any], folder: Path, variant: str) -> None:
        self._lineno = function.__code__.co_firstlineno
        self._locator = _Locator(function, folder)
        name = f"{Path(function.__code__.co_filename).stem}.{function.__qualname__}{variant and '.'}{variant}"
        self._filename_base = self.get_filename_base(name, getattr(sys, "abiflags", ""))

    def reduce(self, code: Any) -> tuple[Any, ...]:
        return cast(tuple[Any, ...], super().reduce(kept.lean(code)))

    def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> Any:
        return kept.read(target_context, payload) or super().rebuild(target_context, payload)


class _Locator(caching._CacheLocator):
    """Where the files of one function are, and the stamp that says whether they are fresh."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        code = function.__code__
        self._py_file, self._line, self._folder = code.co_filename, code.co_firstlineno, folder

    def get_cache_path(self) -> str:
        return str(self._folder)

    def get_source_stamp(self) -> bytes:
        return digest()

    def get_disambiguator(self) -> str:
        return str(self._line)
