"""What is worked out once is kept on disk: arrays under a key that is a digest of what they were worked out from."""

from __future__ import annotations

import hashlib
import os
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

VERSION = b"2"  # of what is kept: a new one when the way to work it out changes
Arrays = dict[str, NDArray[np.float64]]


def cache_folder() -> Path:
    """Where it is kept: ``$PIN_METAIK_CACHE``, else ``pin_metaik`` in ``$XDG_CACHE_HOME`` or ``~/.cache``."""
    if folder := os.environ.get("PIN_METAIK_CACHE"):
        return Path(folder)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pin_metaik"


def kept(kind: str, content: bytes, make: Callable[[], Arrays]) -> Arrays:
    """The arrays that ``make`` returns, from disk if they were made from this content before.

    What cannot be read is made again; where nothing can be written, everything works, only not as soon.
    """
    path = cache_folder() / f"{kind}-{hashlib.sha256(VERSION + content).hexdigest()[:32]}.npz"
    try:
        with np.load(path, allow_pickle=False) as stored:
            return {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        pass
    arrays = make()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".tmp", delete=False) as file:
            np.savez(file, allow_pickle=False, **arrays)
        Path(file.name).replace(path)  # at once, so that two processes never see half a file
    except OSError:
        pass
    return arrays
