"""Loading the compiled loops, with a word to whoever waits while they are compiled."""

from __future__ import annotations

import sys
from functools import cache
from threading import Timer
from types import ModuleType

WAIT = 2.0  # s; a cached load takes half a second

NOTICE = "pin_metaik: compiling its inner loops for this machine, once; this takes about half a minute ..."


@cache
def load_kernels() -> ModuleType:
    """The module of compiled loops. The first load on a machine compiles it, later ones read numba's cache."""
    notice = Timer(WAIT, lambda: print(NOTICE, file=sys.stderr, flush=True))
    notice.daemon = True
    notice.start()
    try:
        from pin_metaik.kinematics import descent
    finally:
        notice.cancel()
    return descent
