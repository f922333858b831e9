"""Locks between processes: each is a file that is there while it is held, and ends with its holder, however that ends.

The lock is the kernel's (``flock``). Where there is no ``fcntl``, as on Windows, and on file systems without locks,
nothing is locked.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

try:
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]


class Taken(Exception):
    """Another process holds the lock.

    Attributes:
        holder: Its number, "" if that is not known.
    """

    def __init__(self, holder: str) -> None:
        self.holder = holder
        super().__init__(holder)


@contextmanager
def locked(path: Path, *, wait: bool) -> Iterator[None]:
    """Hold the lock of a path, in a folder that is there and can be written.

    Args:
        path: Path of the lock file, used for nothing else.
        wait: Whether to wait for another process that holds it.

    Raises:
        Taken: Another process holds it, and this one does not wait.
        OSError: The file cannot be made.
    """
    if fcntl is None:
        yield
        return
    file = _opened(path, wait)
    try:
        if file is not None:
            os.truncate(file, 0)
            os.write(file, str(os.getpid()).encode())
        yield
    finally:
        if file is not None:
            path.unlink(missing_ok=True)
            os.close(file)


def _opened(path: Path, wait: bool) -> int | None:
    """The file of the lock, held; None on a file system without locks."""
    while True:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
            if path.exists() and os.fstat(file).st_ino == path.stat().st_ino:
                return file
        except BlockingIOError:
            holder = os.pread(file, 20, 0).decode(errors="replace")
            os.close(file)
            raise Taken(holder) from None
        except OSError:
            os.close(file)
            return None
        except BaseException:  # Ctrl-C while it waits
            os.close(file)
            raise
        os.close(file)  # its holder has just gone, with the file
