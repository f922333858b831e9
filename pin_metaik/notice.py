"""Notices of work that takes more than a second: a line on stderr that names it and, on a terminal, counts steps."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock, Timer

WAIT = 1.0  # s that work may take without a word
PAUSE = 0.1  # s between two counts on a terminal


class Notice:
    """A line about work that is going on; only written once the work has taken ``WAIT``.

    Attributes:
        text: The work, and where its result is kept.
        total: Of how many steps; 0 if they cannot be counted.
        done: Steps done.
    """

    def __init__(self, text: str, total: int = 0) -> None:
        self.text, self.total, self.done = text, total, 0
        self._written, self._open, self._lock = 0.0, True, Lock()
        self._timer = Timer(WAIT, self._write)
        self._timer.daemon = True
        self._timer.start()

    def step(self) -> None:
        """One more step is done."""
        self.done += 1
        last = self.done == self.total
        if self._written and self._counts and (last or time.monotonic() - self._written > PAUSE):
            self._write()

    def close(self) -> None:
        """The work is over, or given up."""
        self._timer.cancel()
        with self._lock:
            self._open = False
            if self._written and self._counts:
                print(file=sys.stderr, flush=True)

    @property
    def _counts(self) -> bool:
        """Whether the line can be written over."""
        return self.total > 0 and sys.stderr is not None and sys.stderr.isatty()

    def _write(self) -> None:
        with self._lock:
            if self._open and sys.stderr is not None:
                line = f"pin_metaik: {self.text} ..."
                counted = f"\r{line} {self.done} of {self.total}"
                print(*((counted,) if self._counts else (line,)), end="" if self._counts else "\n", file=sys.stderr)
                sys.stderr.flush()
                self._written = time.monotonic()


@contextmanager
def notice(text: str, total: int = 0) -> Iterator[Notice]:
    """Announce work on stderr, if it takes more than a second.

    Args:
        text: What, e.g. ``"simplifying 50 meshes of talos, once"``.
        total: Of how many steps; whoever works calls ``step()`` after each.
    """
    line = Notice(text, total)
    try:
        yield line
    finally:
        line.close()
