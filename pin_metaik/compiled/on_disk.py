"""Machine code kept on disk, stamped with one digest over all the sources it is made from.

Numba's own cache looks at the one file that a loop stands in, so that a loop kept the old code of the parts it has from
other files; and it wants a folder it can write to even where the code is there to be read. Here code is read from the
first folder that has it and written to the first that takes it; without any, everything is compiled anew in each
process.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from hashlib import sha256
from pathlib import Path
from pickle import UnpicklingError
from typing import Any

from numba.core import caching, config

from pin_metaik.cache_folder import cache_folder
from pin_metaik.compiled.sources import PACKAGE, digest


def folders(file: Path) -> Iterator[Path]:
    """Where machine code of a source file of the package may be kept, in the order of looking.

    ``$NUMBA_CACHE_DIR`` if it is set, then ``__pycache__`` beside the file, then the user's cache folder.
    """
    inside = file.parent.relative_to(PACKAGE)
    installation = f"{PACKAGE.name}-{sha256(bytes(PACKAGE)).hexdigest()[:16]}"  # several may share a folder
    if config.CACHE_DIR:
        yield Path(config.CACHE_DIR) / installation / inside
    yield file.parent / "__pycache__"
    if (own := cache_folder()) is not None:
        yield own / "machine_code" / installation / inside


class MachineCode(caching.NullCache):
    """What numba's dispatcher asks for the machine code of one function."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._shelves = [Shelf(function, folder) for folder in folders(Path(function.__code__.co_filename))]

    def load_overload(self, signature: Any, context: Any) -> Any:
        """The code for a signature from the first folder that has it, or None."""
        for shelf in self._shelves:
            try:
                code = shelf.load_overload(signature, context)
            except (OSError, EOFError, ValueError, UnpicklingError):  # may not be read, or was cut off
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
            except (OSError, EOFError, ValueError, UnpicklingError):
                continue
            return


class Shelf(caching.FunctionCache):
    """Numba's cache of one function in a given folder, which need be neither writable nor there."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        self._impl_class = partial(_Implementation, folder=folder)
        super().__init__(function)


class _Implementation(caching.CompileResultCacheImpl):
    """How numba names and writes the files of one function."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        self._lineno = function.__code__.co_firstlineno
        self._locator = _Locator(function, folder)
        name = f"{Path(function.__code__.co_filename).stem}.{function.__qualname__}"
        self._filename_base = self.get_filename_base(name, getattr(sys, "abiflags", ""))


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
