"""Output is checked before the work begins: a file that cannot be written is reported by name, not after the work."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pin_metaik.arrays import Array
from pin_metaik.errors import CannotWrite


def writable(path: str | Path, *, folder: bool = False) -> Path:
    """The path of a file that can be written, or of a folder that can be made and written into.

    Nothing is left behind: a file that was not there is not there afterwards either.

    Args:
        path: Of the file, in a folder that exists; or of the folder.
        folder: Whether it is a folder.

    Raises:
        CannotWrite: It is not; the message says why.
    """
    where = Path(path)
    try:
        return _folder(where) if folder else _file(where)
    except OSError as error:
        raise CannotWrite(f"cannot write {where}: {error.strerror or error}") from None


def replace_text(path: Path, text: str) -> None:
    """Write a file as a whole or not at all.

    Raises:
        CannotWrite: It cannot be written.
    """
    with replaced(path) as partial:
        partial.write_text(text, encoding="utf-8")


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """The path of a file to write, which takes the place of another once it is whole.

    Raises:
        CannotWrite: It cannot be written; the other one is left as it was.
    """
    partial = path.with_suffix(".partial")
    try:
        yield partial
        partial.replace(path)
    except OSError as error:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        raise CannotWrite(f"cannot write {path}: {error.strerror or error}") from None


def write_table(file: str | Path, header: Iterable[str], rows: Array) -> None:
    """Write a table (n, c) as CSV with all digits."""
    lines = [",".join(header), *(",".join(map(repr, row)) for row in rows.tolist())]
    writable(file).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _folder(where: Path) -> Path:
    there = next(parent for parent in (where, *where.absolute().parents) if parent.exists())
    if not there.is_dir():
        raise CannotWrite(f"cannot write into {where}: {there} is a file, not a folder")
    if not os.access(there, os.W_OK | os.X_OK):
        raise CannotWrite(f"cannot write into {where}: {there} is read-only")
    return where


def _file(where: Path) -> Path:
    if where.is_dir():
        raise CannotWrite(f"cannot write {where}: it is a folder; name a file in it, e.g. {where / 'FILE'}")
    if not where.parent.is_dir():
        raise CannotWrite(f"cannot write {where}: there is no folder {where.parent}")
    there = where.exists()
    with where.open("ab"):  # says what stands in the way
        pass
    if not there:
        where.unlink()
    return where
