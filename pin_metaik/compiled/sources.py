"""One digest of all sources that machine code is made from.

A loop has the parts that it calls compiled into it, and constants of whatever its file imports. So machine code is
fresh only if none of these files has changed, and one digest stands for all of them: of every file that compiles
something, and of every file of the package that those import, directly or not.
"""

from __future__ import annotations

import hashlib
import re
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
COMPILES = re.compile(rb"^from pin_metaik\.compiled import", re.MULTILINE)
IMPORTS = re.compile(rb"^from pin_metaik(?:\.([\w.]+))? import", re.MULTILINE)


def modules() -> list[str]:
    """The modules of the package that compile something."""
    files = (path for path in sorted(PACKAGE.rglob("*.py")) if COMPILES.search(path.read_bytes()))
    return [".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts) for path in files]


@cache
def digest() -> bytes:
    """SHA-256 of the names and contents of these files; of nothing, where the package holds no sources."""
    files = {path.relative_to(PACKAGE).as_posix(): path.read_bytes() for path in sorted(PACKAGE.rglob("*.py"))}
    wanted = {name for name, text in files.items() if COMPILES.search(text)}
    todo = list(wanted)
    while todo:
        imported = {file for module in IMPORTS.findall(files[todo.pop()]) for file in _files_of(module.decode(), files)}
        todo += imported - wanted
        wanted |= imported
    total = hashlib.sha256()
    for name in sorted(wanted):
        total.update(b"%s %d\n" % (name.encode(), len(files[name])))
        total.update(files[name])
    return total.digest()


def _files_of(module: str, files: dict[str, bytes]) -> list[str]:
    """The file of a module of the package, or of a subpackage its ``__init__.py``."""
    path = module.replace(".", "/")
    return [name for name in (f"{path}.py", f"{path}/__init__.py".lstrip("/")) if name in files]
