"""Reading files: their contents, or an error of ours that names the file and the key."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Collection, Mapping
from decimal import Decimal
from importlib.resources.abc import Traversable
from io import StringIO
from pathlib import Path
from typing import Any
from zipfile import ZipFile, is_zipfile

import numpy as np

from pin_metaik.errors import MetaIKError, meant

Error = type[MetaIKError]

DEEPEST = 100  # values in each other
LARGEST = 10**308  # whole numbers beyond it are none that a float holds
LONGEST = 1 << 28  # bytes of a file, but of arrays
HEAVIEST = 1 << 30  # bytes of the arrays in a file, unpacked


def read_bytes(path: Path | Traversable, error: Error) -> bytes:
    """The bytes of a file.

    Args:
        path: The file; ``~`` in front is the user's home.
        error: What to raise if it is missing, or has more than a file of its kind ever has, or no end, as
            ``/dev/zero``; made from one sentence.
    """
    try:
        with (path.expanduser() if isinstance(path, Path) else path).open("rb") as file:
            content: bytes = file.read(LONGEST + 1)
    except (OSError, RuntimeError, ValueError) as reason:  # there is no home, or a null character
        raise error(f"cannot read {path}: {getattr(reason, 'strerror', None) or reason}") from None
    if len(content) > LONGEST:
        raise error(f"cannot read {path}: it has more than {LONGEST >> 20} MiB")
    return content


def read_text(path: Path | Traversable, error: Error, kind: str = "text") -> str:
    """The text of a file in UTF-8, without a byte order mark.

    Args:
        path: The file; ``~`` in front is the user's home.
        error: What to raise if it is missing or no text; made from one sentence.
        kind: Kind of the file, for the message.
    """
    try:
        return StringIO(read_bytes(path, error).decode("utf-8-sig"), newline=None).read()
    except UnicodeDecodeError as reason:
        raise error(f"{path} is not {kind}: it is not UTF-8 text: {reason}") from None


def read_json(path: Path | Traversable, error: Error, kind: str = "JSON") -> Any:
    """The contents of a JSON file.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed, or has a key twice; made from one sentence.
        kind: Kind of the file, for the message.
    """
    return json_values(read_text(path, error, kind), path, error, kind)


def json_values(text: str | bytes, place: object, error: Error, kind: str = "JSON") -> Any:
    """The contents of a text in JSON.

    Args:
        text: The text.
        place: Where it is.
        error: What to raise if it is malformed, or has a key twice; made from one sentence.
        kind: What it is, for the message.
    """
    try:
        content = json.loads(text, object_pairs_hook=_once)
    except (ValueError, RecursionError) as reason:
        raise error(f"{place} is not {kind}: {reason}") from None
    return plain_values(content, len(text), place, error, kind)


def plain_values(content: Any, size: int, place: object, error: Error, kind: str) -> Any:
    """The contents of a text, if they are such that whatever is done with them ends.

    Args:
        content: Values in lists and mappings.
        size: Characters of the text: where there are more values, they are aliases of each other, as YAML has them,
            and to write them down may take for ever.
        place: Where the text is.
        error: What to raise if values are so many, too deep in each other, or whole numbers that no float holds.
        kind: What the text is, for the message.
    """
    waiting, count = [(content, 0)], 0
    while waiting:
        value, depth = waiting.pop()
        count += 1
        if depth > DEEPEST or count > size + 1:
            wrong = "values are nested too deeply" if depth > DEEPEST else "its aliases stand for too many values"
            raise error(f"{place} is not {kind} that can be read: {wrong}")
        if _too_large(value):
            raise error(f"{place} is not {kind} that can be read: it has a number of more than 308 digits")
        if isinstance(value, dict):
            waiting += [(one, depth + 1) for pair in value.items() for one in pair]
        elif isinstance(value, (list, tuple, set)):
            waiting += [(one, depth + 1) for one in value]
    return content


def _too_large(value: object) -> bool:
    """Whether it is a finite number that no float holds."""
    if isinstance(value, Decimal):
        return value.is_finite() and value.copy_abs() > LARGEST
    return isinstance(value, int) and abs(value) > LARGEST


def read_csv(path: Path, error: Error) -> list[list[str]]:
    """The rows of a CSV file.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.
    """
    try:
        return list(csv.reader(read_text(path, error, "CSV").splitlines(keepends=True)))
    except csv.Error as reason:
        raise error(f"{path} is not CSV: {reason}") from None


def read_array(path: Path, error: Error, kind: str) -> np.ndarray:
    """The one array in a ``.npy`` file; arguments as of ``read_arrays``."""
    arrays = read_arrays(path, error, kind)
    if "" not in arrays:
        raise error(f"{path} is not {kind}: it holds several arrays")
    return arrays[""]


def read_arrays(path: Path, error: Error, kind: str) -> dict[str, np.ndarray]:
    """The arrays in a ``.npz`` file by name, or that of a ``.npy`` by no name; never an object, which could run code.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed, or its arrays are too large.
        kind: Kind of the file, for the message.
    """
    try:
        file = path.expanduser()
        if is_zipfile(file):
            with ZipFile(file) as archive:
                if sum(member.file_size for member in archive.infolist()) > HEAVIEST:
                    raise error(f"{path} is not {kind}: unpacked it has more than {HEAVIEST >> 20:,} MiB")
            with np.load(file, allow_pickle=False) as opened:
                arrays = {name: opened[name] for name in opened.files}
            if others := [name for name, one in arrays.items() if not isinstance(one, np.ndarray)]:
                raise error(f"{path} is not {kind}: {others[0]!r} is no array")
            return arrays
        return {"": np.load(file, allow_pickle=False)}
    except MetaIKError:
        raise
    except OSError as reason:
        raise error(f"cannot read {path}: {reason.strerror or reason}") from None
    except Exception as reason:  # a damaged file fails in a dozen ways: numpy reads its header as Python
        raise error(f"{path} is not {kind}: {reason}") from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object whose keys are all different."""
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"the key {next(name for name in names if names.count(name) > 1)!r} occurs twice")
    return content


def known_keys(
    content: Mapping[Any, Any],
    place: object,
    error: Callable[[str], MetaIKError],
    needed: Collection[str],
    optional: Collection[str] = (),
) -> None:
    """Make sure that a mapping has no unknown key, then that it has all required ones.

    Args:
        content: Contents of a file, or a part of them.
        place: The file, and where in it.
        error: What to raise, with the key that was perhaps meant; made from one sentence.
        needed: Keys that must be there.
        optional: Keys that may be there.
    """
    for key in content:
        if key not in needed and key not in optional:
            raise error(f"{place}: unknown key {key!r}; {meant(str(key), (*needed, *optional))}")
    for key in needed:
        if key not in content:
            raise error(f"{place}: {key} is missing")
