"""JSON files in: what they hold, or a named error that says what is wrong with them."""

from __future__ import annotations

import json
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from pin_metaik.errors import MetaIKError


def read_json(path: Path | Traversable, error: type[MetaIKError]) -> Any:
    """What a JSON file holds.

    Args:
        path: The file.
        error: What to raise if it is missing or malformed; made from one sentence.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as reason:
        raise error(f"cannot read {path}: {reason.strerror}") from None
    except ValueError as reason:
        raise error(f"{path} is not JSON: {reason}") from None
