"""Files of maps: NumPy's ``.npz``, or a Parquet table with a row for each pose."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.files import HEAVIEST, read_arrays
from pin_metaik.ik import IKStatus
from pin_metaik.lookup import need
from pin_metaik.output import replaced, writable

KIND = "a map that Reachability.save has written"
STATUSES = (None, *IKStatus)
"""What the numbers of a map's status mean; 0: not looked at."""

Arrays: TypeAlias = Mapping[str, NDArray[Any]]
"""Of a map: positions, orientations, status, manipulability, shape, seconds."""


class Format(NamedTuple):
    """How maps are written and read."""

    write: Callable[[Path, Arrays], None]
    read: Callable[[Path], Arrays]


def format_of(path: str | Path) -> Format:
    """The format that the ending of a path names.

    Raises:
        InvalidSetting: It names none.
        MissingExtra: pyarrow is needed and not installed.
    """
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise InvalidSetting(f"a map is a file that ends in {' or '.join(FORMATS)}, got {str(path)!r}")
    if ending == ".parquet":
        need("a map as Parquet", "compare", "pyarrow")
    return FORMATS[ending]


def write_map(path: str | Path, arrays: Arrays) -> Path:
    """Write a map as its ending says, as a whole or not at all.

    Raises:
        InvalidSetting: Its ending names no format.
        MissingExtra: pyarrow is needed and not installed.
        CannotWrite: The file cannot be written.
    """
    chosen, where = format_of(path), writable(path)
    with replaced(where) as partial:
        chosen.write(partial, arrays)
    return where


def read_map(path: str | Path) -> Arrays:
    """Read what ``write_map`` has written.

    Raises:
        InvalidSetting: Its ending names no format, there is no such file, or it holds no map.
        MissingExtra: pyarrow is needed and not installed.
    """
    chosen = format_of(path)
    try:
        return chosen.read(Path(path))
    except (OSError, ValueError, KeyError, EOFError, TypeError, OverflowError) as error:
        raise InvalidSetting(f"{path} is not {KIND}: {error}") from None


def _write_npz(path: Path, arrays: Arrays) -> None:
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **arrays)


def _read_npz(path: Path) -> Arrays:
    return read_arrays(path, InvalidSetting, KIND)


def _write_parquet(path: Path, arrays: Arrays) -> None:
    """A row for each pose; orientations, shape and seconds are in the table's metadata."""
    import pyarrow as pa
    from pyarrow import parquet

    status, dexterity = arrays["status"], arrays["manipulability"]
    k, m = status.shape
    names = pa.array([None if one is None else one.value for one in STATUSES])
    columns = {
        "position": pa.array(np.repeat(np.arange(k, dtype=np.int32), m)),
        **{axis: pa.array(np.repeat(arrays["positions"][:, i], m)) for i, axis in enumerate("xyz")},
        "orientation": pa.array(np.tile(np.arange(m, dtype=np.int32), k)),
        "status": names.take(pa.array(status.ravel())),
        "manipulability": pa.array(dexterity.ravel(), from_pandas=True),
    }
    said = {name: arrays[name].tolist() for name in ("orientations", "shape", "seconds")}
    table = pa.table(columns).replace_schema_metadata({"reachability": json.dumps(said)})
    parquet.write_table(table, path)


def _read_parquet(path: Path) -> Arrays:
    import pyarrow as pa
    from pyarrow import parquet

    try:
        with parquet.ParquetFile(path) as file:
            rows = file.metadata
            if sum(rows.row_group(i).total_byte_size for i in range(rows.num_row_groups)) > HEAVIEST:
                raise ValueError(f"unpacked it has more than {HEAVIEST >> 20:,} MiB")
            table = file.read()
    except pa.ArrowException as reason:
        raise ValueError(str(reason)) from None
    said = json.loads((table.schema.metadata or {})[b"reachability"])
    k = math.prod(said["shape"])
    names = {None if one is None else one.value: number for number, one in enumerate(STATUSES)}
    values = {name: table.column(name).to_numpy().reshape(k, -1) for name in ("x", "y", "z", "manipulability")}
    return {
        "positions": np.column_stack([values[axis][:, 0] for axis in "xyz"]),
        "orientations": np.array(said["orientations"], dtype=float).reshape(-1, 3, 3),
        "status": np.array([names[one] for one in table.column("status").to_pylist()]).reshape(k, -1),
        "manipulability": values["manipulability"],
        "shape": np.array(said["shape"]),
        "seconds": np.array(said["seconds"]),
    }


FORMATS: dict[str, Format] = {
    ".npz": Format(_write_npz, _read_npz),
    ".parquet": Format(_write_parquet, _read_parquet),
}
