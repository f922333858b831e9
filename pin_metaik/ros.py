"""Messages of ROS as plain values, and files of them: YAML as ``ros2 topic pub`` takes it, or JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pin_metaik.errors import InvalidSetting, MissingExtra
from pin_metaik.output import writable

NANO = 1_000_000_000
LAST_STAMP = 2**31 - 1  # s, of a ``builtin_interfaces/Time``


def header(frame: str, t: float) -> dict[str, Any]:
    """A ``std_msgs/Header`` at a time t, s since ROS' epoch."""
    return {"stamp": time(t), "frame_id": frame}


def time(t: float) -> dict[str, int]:
    """A ``builtin_interfaces/Time`` or ``Duration`` of t s."""
    seconds, nanoseconds = divmod(round(t * NANO), NANO)
    return {"sec": seconds, "nanosec": nanoseconds}


def message_file(file: str | Path, kind: str) -> Path:
    """The path of a file that a message of a kind can be written to, before it is made.

    Raises:
        InvalidSetting: Another suffix than ``.yaml``, ``.yml`` or ``.json``.
        CannotWrite: The file cannot be written.
        MissingExtra: YAML is wanted and PyYAML is not installed.
    """
    suffix = Path(file).suffix.lower()
    if suffix not in (".yaml", ".yml", ".json"):
        raise InvalidSetting(f"a {kind} is written as .yaml or .json, not as {str(file)!r}")
    if suffix != ".json" and find_spec("yaml") is None:
        raise MissingExtra(f"writing {file}", "mobile")
    return writable(file)


def write_message(file: Path, message: Mapping[str, Any]) -> None:
    """Write a message to a file that ``message_file`` has looked at."""
    if file.suffix.lower() == ".json":
        text = json.dumps(message, allow_nan=False)
    else:
        import yaml

        text = yaml.safe_dump(message, sort_keys=False)
    file.write_text(text, encoding="utf-8")
