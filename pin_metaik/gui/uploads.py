"""Files that come from a browser: bounded, named without a path, unpacked into the tab's own folder alone."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from pin_metaik.errors import InvalidSetting

MOST = 16 * 2**20  # bytes of one file
MOST_UNPACKED = 64 * 2**20  # bytes of all files of an archive together
MOST_FILES = 256
PLAIN = re.compile(r"[^\w.\-]+")


def received(name: str, content: bytes, folder: Path, suffixes: tuple[str, ...]) -> Path:
    """Keep a file that was uploaded; of an archive, everything in it.

    Args:
        name: As the browser has it; only its last part counts.
        content: Its bytes.
        folder: Where it is kept; nothing is written elsewhere.
        suffixes: What it may be, e.g. ``(".urdf", ".xml")``; of an archive, the first that it has is meant.

    Returns:
        The file that is meant.

    Raises:
        InvalidSetting: Too large, of another kind, or an archive that is damaged or reaches out of its folder.
    """
    plain = plain_name(name)
    if len(content) > MOST:
        raise InvalidSetting(f"{plain} has {len(content) / 2**20:.1f} MiB; at most {MOST // 2**20} MiB are taken")
    suffix = Path(plain).suffix.lower()
    if suffix == ".zip":
        return _meant(_unpacked(plain, content, folder), plain, suffixes)
    if suffix not in suffixes:
        raise InvalidSetting(f"{plain} is neither one of {', '.join(suffixes)} nor a .zip of them")
    path = folder / plain
    path.write_bytes(content)
    return path


def only_inside(files: Iterable[str], name: str) -> None:
    """Make sure that what was uploaded names no file outside of itself.

    Raises:
        InvalidSetting: It does; packages of installed robots may be named.
    """
    for file in files:
        inner = file.removeprefix("package://")
        if inner.startswith(("/", "~", "\\")) or ":" in inner or ".." in PurePosixPath(inner.replace("\\", "/")).parts:
            raise InvalidSetting(
                f"{name} names the file {file!r}, outside of what was uploaded: send a .zip with all of its files, "
                "named relative to it"
            )


def plain_name(name: str) -> str:
    """The last part of a file's name, of letters, digits, dots and dashes: it leads nowhere."""
    last = name.replace("\\", "/").rpartition("/")[2]
    return PLAIN.sub("_", last).strip(".")[-100:] or "file"


def _unpacked(name: str, content: bytes, folder: Path) -> list[Path]:
    """The files of an archive, written under the folder."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(content))
    except (zipfile.BadZipFile, ValueError, NotImplementedError) as reason:
        raise InvalidSetting(f"{name} is not a .zip: {reason}") from None
    entries = [entry for entry in archive.infolist() if not entry.is_dir()]
    if len(entries) > MOST_FILES:
        raise InvalidSetting(f"{name} has {len(entries)} files; at most {MOST_FILES} are taken")
    room, paths = MOST_UNPACKED, []
    for entry in entries:
        parts = PurePosixPath(entry.filename.replace("\\", "/")).parts
        if not parts or ".." in parts or parts[0].startswith("/") or ":" in entry.filename:
            raise InvalidSetting(f"{name}: {entry.filename!r} reaches out of its folder")
        try:
            with archive.open(entry) as packed:
                data = packed.read(room + 1)  # what it says of its size may be wrong
        except (zipfile.BadZipFile, zlib.error, OSError, EOFError, RuntimeError, NotImplementedError) as reason:
            raise InvalidSetting(f"{name}: cannot unpack {entry.filename!r}: {reason}") from None
        if len(data) > room:
            raise InvalidSetting(f"{name} is larger than {MOST_UNPACKED // 2**20} MiB when unpacked")
        room -= len(data)
        path = folder.joinpath(*map(plain_name, parts))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        paths.append(path)
    return paths


def _meant(paths: list[Path], name: str, suffixes: tuple[str, ...]) -> Path:
    """The file of an archive that it was sent for: by kind, then the one that is least deep."""
    for suffix in suffixes:
        found = [path for path in paths if path.suffix.lower() == suffix]
        if found:
            return min(found, key=lambda path: (len(path.parts), path.name))
    raise InvalidSetting(f"{name} has no file of the kinds {', '.join(suffixes)}")
