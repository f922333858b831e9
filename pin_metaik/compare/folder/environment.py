"""Where and how a comparison was run: versions, processor, command and date."""

from __future__ import annotations

import json
import os
import platform
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from pin_metaik.compare.folder.reading import entries
from pin_metaik.compare.methods.cost import FK_WITH_JACOBIAN
from pin_metaik.errors import InvalidSetting
from pin_metaik.files import read_json
from pin_metaik.output import replace_text

FILE = "environment.json"
KEYS = ("date", "command", "processor", "cores", "system", "python", "packages", "kernel_evaluations")
PACKAGES = (
    "pin-metaik", "pin", "coal", "numpy", "numba", "scipy", "qpsolvers", "osqp", "daqp", "joblib", "distributed",
    "cma", "ikpy", "pin-pink", "pytracik", "roboticstoolbox-python",
)  # fmt: skip


def environment(command: str) -> dict[str, Any]:
    """Versions, processor and command of this process, as plain values."""
    return {
        "date": datetime.now().astimezone().isoformat(timespec="seconds"),
        "command": command,
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "packages": {name: number for name in PACKAGES if (number := _version(name))},
        "kernel_evaluations": {
            "forward kinematics": 1,
            "forward kinematics with Jacobian": FK_WITH_JACOBIAN,
            "measured by": "python benchmarks/kernel_costs.py",
        },
    }


def append_environment(folder: Path, command: str) -> None:
    """Append this process to the list of processes that worked on the comparison in a folder."""
    replace_text(folder / FILE, json.dumps([*read_environment(folder), environment(command)], indent=2) + "\n")


def read_environment(folder: Path) -> list[dict[str, Any]]:
    """The processes that worked on the comparison in a folder, in their order.

    Raises:
        InvalidSetting: The file that should list them does not.
    """
    path = folder / FILE
    sessions = read_json(path, InvalidSetting) if path.exists() else []
    if not isinstance(sessions, list):
        raise InvalidSetting(f"{path} is not a list of sessions")
    return [entries(session, f"session {i} of {path}", KEYS) for i, session in enumerate(sessions, start=1)]


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _processor() -> str:
    """The processor's name, where the system tells."""
    listing = Path("/proc/cpuinfo")
    if listing.exists():
        for line in listing.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
