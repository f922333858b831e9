"""Warnings that point at the line which called this package, however deep inside they arise."""

from __future__ import annotations

import sys
import warnings

THROUGH = ("pin_metaik", "functools", "contextlib")  # what calls of this package pass through


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn, at the line outside of this package that led here; there Python's filters look and count."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in THROUGH:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
