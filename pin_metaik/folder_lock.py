"""One process at a time in a folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from pin_metaik import locks
from pin_metaik.errors import InvalidSetting


@contextmanager
def locked(folder: Path, work: str) -> Iterator[None]:
    """Hold the lock of a folder, which must be there, for a kind of work.

    Raises:
        InvalidSetting: Another process holds it.
    """
    with ExitStack() as held:
        try:
            held.enter_context(locks.locked(folder / f".{work}.lock", wait=False))
        except locks.Taken as taken:
            raise InvalidSetting(
                f"another process{f' ({taken.holder})' if taken.holder else ''} works on the {work} in {folder}: wait "
                "for it, stop it, or choose another folder"
            ) from None
        yield
