"""Mechanisms by name: a file of one's own, or one of the package's catalogue."""

from __future__ import annotations

from pathlib import Path

from pin_metaik.arguments import checked
from pin_metaik.errors import UnknownName
from pin_metaik.stewart.files.reading import read_mechanism
from pin_metaik.stewart.mechanism.mechanism import Mechanism

FOLDER = Path(__file__).parents[1] / "catalog"


def mechanism_names() -> list[str]:
    """Names of the catalogue, sorted."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


@checked
def load_mechanism(name: str | Path) -> Mechanism:
    """Load a mechanism by its name in the catalogue, or by the path of a ``.toml`` file.

    Raises:
        UnknownName: Neither a name of the catalogue nor a path.
        MetaIKError: What ``read_mechanism`` says about the file.
    """
    path = Path(name)
    if path.suffix == ".toml" or path.parent != Path():
        return read_mechanism(path)
    if str(name) not in mechanism_names():
        raise UnknownName("mechanism", str(name), mechanism_names())
    return read_mechanism(FOLDER / f"{name}.toml")
