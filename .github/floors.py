"""The lowest versions that pyproject.toml allows, as constraints: ``pip install -c floors.txt ".[...]"``.

python .github/floors.py > floors.txt
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

FLOOR = re.compile(r"^([\w.-]+)(?:\[[\w,-]+\])?>=([\w.]+)")
TOOLS = {"dev"}  # extras for developers, whose floors nobody's users meet


def floors(project: dict[str, object]) -> dict[str, str]:
    """The lowest version of each dependency, the highest of those where it is named twice."""
    extras: dict[str, list[str]] = project["optional-dependencies"]  # type: ignore[assignment]
    wanted = [*project["dependencies"], *(one for name, some in extras.items() if name not in TOOLS for one in some)]  # type: ignore[misc]
    found: dict[str, str] = {}
    for name, version in (match.groups() for one in wanted if (match := FLOOR.match(one))):
        found[name] = max(found.get(name, version), version, key=lambda text: [int(n) for n in text.split(".")])
    return found


def main() -> None:
    """Print them."""
    pyproject = Path(__file__).parents[1] / "pyproject.toml"
    for name, version in sorted(floors(tomllib.loads(pyproject.read_text(encoding="utf-8"))["project"]).items()):
        print(f"{name}=={version}")


if __name__ == "__main__":
    main()
