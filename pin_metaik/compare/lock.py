"""One process at a time in a folder: a lock that ends with the process that holds it, however that ends.

It is the kernel's (``flock``), on a file that is there while it is held. Where there is no ``fcntl``, as on Windows,
and on file systems without locks, nothing is locked.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pin_metaik.errors import InvalidSetting

try:
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]


@contextmanager
def locked(folder: Path, work: str) -> Iterator[None]:
    """Hold the lock of a folder, which must be there, for a kind of work.

    Raises:
        InvalidSetting: Another process holds it.
    """
    if fcntl is None:
        yield
        return
    path = folder / f".{work}.lock"
    file = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InvalidSetting(_taken(folder, work, file)) from None
        except OSError:  # a file system without locks
            yield
            return
        if not path.exists() or os.fstat(file).st_ino != path.stat().st_ino:  # its holder has just gone, with the file
            raise InvalidSetting(_taken(folder, work, file))
        os.truncate(file, 0)
        os.write(file, str(os.getpid()).encode())
        try:
            yield
        finally:
            path.unlink(missing_ok=True)
    finally:
        os.close(file)


def _taken(folder: Path, work: str, file: int) -> str:
    holder = os.pread(file, 20, 0).decode(errors="replace")
    return (
        f"another process{f' ({holder})' if holder else ''} works on the {work} in {folder}: wait for it, stop it, or "
        "choose another folder"
    )
