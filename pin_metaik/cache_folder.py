"""The folder of this user's caches, if it can be written."""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path | None:
    """``$PIN_METAIK_CACHE``, else ``pin_metaik`` in ``$XDG_CACHE_HOME`` or ``~/.cache``; None: the user has no home.

    The folder may not exist yet, and may not be writable.
    """
    try:
        if folder := os.environ.get("PIN_METAIK_CACHE"):
            return Path(folder).expanduser()
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pin_metaik"
    except RuntimeError:  # neither HOME nor an entry in the table of users, as in many containers
        return None
