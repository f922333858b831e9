"""The rows of a comparison on disk: appended to a JSON Lines file one by one, and a Parquet file of all at the end."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pin_metaik.compare.folder.manifest import MANIFEST, Manifest
from pin_metaik.compare.trials.trial import Trial
from pin_metaik.errors import CannotWrite, InvalidSetting
from pin_metaik.files import json_values, read_json
from pin_metaik.lookup import need
from pin_metaik.output import replace_text, replaced

ROWS, PARQUET = "rows.jsonl", "rows.parquet"


def need_parquet() -> None:
    """Make sure a Parquet file can be written, before a comparison runs for minutes.

    Raises:
        MissingExtra: pyarrow is not installed.
    """
    need("writing Parquet", "compare", "pyarrow")


def check_manifest(folder: Path, manifest: Manifest) -> None:
    """Make sure that a folder is good for a comparison: it has none yet, or this one, which may have grown.

    Raises:
        InvalidSetting: The folder holds rows of another budget or seed, or of more than is asked for now.
    """
    if (folder / MANIFEST).exists():
        manifest.check_grown_from(read_manifest(folder), folder)


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Write the manifest of a comparison."""
    replace_text(folder / MANIFEST, json.dumps(manifest.to_json(), indent=2) + "\n")


def read_manifest(folder: Path) -> Manifest:
    """The comparison of a folder.

    Raises:
        InvalidSetting: The folder holds no comparison, or its manifest is damaged.
    """
    path = folder / MANIFEST
    if not path.exists():
        raise InvalidSetting(f"{folder} holds no comparison: make one with pin-metaik compare --out {folder}")
    return Manifest.from_json(read_json(path, InvalidSetting), path)


def read_rows(folder: Path) -> list[Trial]:
    """The rows so far; a last line that was cut off while it was written is left out.

    Raises:
        InvalidSetting: A line in the middle is no row.
    """
    path = folder / ROWS
    if not path.exists():
        return []
    lines = path.read_bytes().split(b"\n")[:-1]
    rows: dict[tuple[Any, ...], Trial] = {}
    for number, line in enumerate(lines, start=1):
        try:
            trial = Trial.from_row(json_values(line, f"line {number}", InvalidSetting))
        except (InvalidSetting, TypeError):  # TypeError: a vector that is none
            raise InvalidSetting(f"line {number} of {path} is not a row: delete it to go on") from None
        rows.setdefault(trial.key, trial)
    return list(rows.values())


class Appender:
    """Appends rows to the file of a folder, whole lines at a time; each is with the operating system at once."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / ROWS

    def __enter__(self) -> Appender:
        """Cut off a last line that a killed writer left incomplete, and open the file."""
        self._path.touch()
        with self._path.open("r+b") as file:
            text = file.read()
            file.truncate(text.rfind(b"\n") + 1)
        self._file = self._path.open("ab", buffering=0)
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def add(self, trials: Iterable[Trial]) -> None:
        """Append rows, all of them or none.

        Raises:
            CannotWrite: There is no room for them, or the file is gone.
        """
        lines = (json.dumps(trial.row(), allow_nan=False, separators=(",", ":")) for trial in trials)
        left = memoryview("".join(f"{line}\n" for line in lines).encode())
        before = os.fstat(self._file.fileno()).st_size
        try:
            while left:  # a disk that is nearly full takes a part without a word
                left = left[self._file.write(left) :]
        except OSError as error:
            self._file.truncate(before)
            raise CannotWrite(
                f"cannot write {self._path}: {error.strerror}; the rows written before are complete"
            ) from None


def write_parquet(folder: Path, trials: Iterable[Trial]) -> Path:
    """Write all rows, sorted by their names, as Parquet.

    Raises:
        MissingExtra: pyarrow is not installed.
    """
    need_parquet()
    import pyarrow as pa
    from pyarrow import parquet

    text, number, real, truth = pa.string(), pa.int64(), pa.float64(), pa.bool_()
    types = {
        "robot": text, "case": text, "method": text, "task": number, "seed": number, "budget": number,
        "solved": truth, "met": truth, "claimed": truth, "status": text, "error": text, "position_error": real,
        "orientation_error": real, "displacement": real, "evaluations": number, "x": pa.list_(real),
        "curve": pa.list_(real), "seconds": real,
    }  # fmt: skip
    rows = [trial.row() for trial in sorted(trials, key=lambda trial: trial.key)]
    path = folder / PARQUET
    with replaced(path) as partial:
        parquet.write_table(pa.Table.from_pylist(rows, pa.schema(list(types.items()))), partial)
    return path
