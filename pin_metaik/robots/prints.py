"""Messages that C++ prints on file descriptor 2, captured: urdfdom explains its errors nowhere else."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_STDERR = threading.Lock()


@contextmanager
def caught_prints() -> Iterator[Callable[[], str]]:
    """Catch prints meanwhile; the value is a function that gives them as one line."""

    def text() -> str:
        caught.seek(0)
        lines = (line.strip() for line in caught.read().decode(errors="replace").splitlines())
        told = (line for line in lines if line and not line.startswith("at line"))
        return _sentence("; ".join(line.removeprefix("Error:").removeprefix("Warning:").strip() for line in told))

    with _STDERR, tempfile.TemporaryFile() as caught:
        sys.stderr.flush()
        saved = os.dup(2)
        os.dup2(caught.fileno(), 2)
        try:
            yield text
        finally:
            os.dup2(saved, 2)
            os.close(saved)


def explain(error: Exception) -> str:
    """The sentence in an exception of Pinocchio or coal, without the C++ file and function it comes from."""
    return _sentence(str(error))


def _sentence(text: str) -> str:
    return " ".join(text.split()).rpartition("message: ")[2]
