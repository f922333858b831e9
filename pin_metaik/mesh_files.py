"""Files of meshes that coal's reader must not be given as they are: a damaged one ends the process, or never ends."""

from __future__ import annotations

from pathlib import Path

from pin_metaik import collada, ply
from pin_metaik.files import Error

HEAD = 4_096  # bytes by which a file without its usual ending is known


def is_ply(path: Path) -> bool:
    """Whether coal's reader would take a file for PLY."""
    return path.suffix.lower() == ply.SUFFIX or _head(path).startswith(ply.MAGIC)


def check_mesh(path: Path, error: Error) -> None:
    """Make sure that a file can be handed to coal's reader, if there is one.

    Args:
        path: The file.
        error: What to raise if it cannot; made from one sentence.
    """
    head = _head(path)
    if not head:
        return
    if is_ply(path):
        ply.read_ply(path, error)
    elif path.suffix.lower() == collada.SUFFIX or collada.MAGIC in head:
        collada.check_collada(path, error)


def _head(path: Path) -> bytes:
    """The first bytes of a file; none of what is no file that can be read, of which coal's reader tells."""
    try:
        if path.is_file():  # reading pipes and devices may never end
            with path.open("rb") as file:
                return file.read(HEAD)
    except (OSError, ValueError):  # too long, not allowed, with a null character
        pass
    return b""
