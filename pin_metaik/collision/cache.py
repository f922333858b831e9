"""Arrays kept on disk, under a key that is a digest of the data they are computed from."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pin_metaik.cache_folder import cache_folder

VERSION = b"6"  # of what is kept: a new one when the way to work it out changes
Arrays = dict[str, NDArray[np.float64]]


def where_kept() -> str:
    """Where results are kept, or what to set so that they are, as part of a sentence."""
    folder = cache_folder()
    if folder is None:
        return "not kept: set PIN_METAIK_CACHE to a folder to keep it in"
    there = next((above for above in (folder, *folder.parents) if os.access(above, os.F_OK)), folder)
    if not (os.access(there, os.W_OK | os.X_OK) and there.is_dir()):
        return f"not kept, as {folder} cannot be written: set PIN_METAIK_CACHE to a folder that can"
    return f"kept in {folder}"


def kept(kind: str, content: bytes, make: Callable[[], Arrays]) -> Arrays:
    """The arrays that ``make`` returns, from disk if they were made from this content before.

    What cannot be read is made again; where nothing can be written, everything works, only not as soon.
    """
    path = _path(kind, content)
    arrays = _read(path)
    if arrays is None:
        arrays = make()
        _write(path, arrays)
    return arrays


def _path(kind: str, content: bytes) -> Path | None:
    folder = cache_folder()
    return folder and folder / f"{kind}-{hashlib.sha256(VERSION + content).hexdigest()[:32]}.npz"


def _read(path: Path | None) -> Arrays | None:
    if path is None:
        return None
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: stored[name] for name in stored.files}
    except Exception:  # a damaged archive fails in a dozen ways: whichever it is, it is made again
        return None


def _write(path: Path | None, arrays: Arrays) -> None:
    if path is None:
        return
    half: Path | None = None
    with suppress(OSError):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".tmp", delete=False) as file:
                half = Path(file.name)
                np.savez(file, allow_pickle=False, **arrays)
            half.replace(path)  # at once, so that two processes never see half a file
        except BaseException:
            if half is not None:
                half.unlink(missing_ok=True)
            raise
