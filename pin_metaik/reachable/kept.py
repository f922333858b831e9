"""Parts of a map in a folder, from which interrupted work resumes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pin_metaik.errors import InvalidSetting
from pin_metaik.files import read_arrays, read_json
from pin_metaik.output import replace_text, replaced

QUESTION = "question.json"

Answer = tuple[NDArray[np.uint8], NDArray[np.float32]]
"""Status and manipulability (c, m) of a part."""


class Kept:
    """Parts of a map in a folder."""

    def __init__(self, folder: Path, digest: str) -> None:
        """Make sure that the folder holds no other map.

        Raises:
            InvalidSetting: It does.
        """
        self._folder = folder
        path, question = folder / QUESTION, {"digest": digest}
        if path.exists() and read_json(path, InvalidSetting) != question:
            raise InvalidSetting(f"{folder} holds a map that was made with other arguments: choose another folder")
        replace_text(path, json.dumps(question) + "\n")

    def _path(self, number: int) -> Path:
        return self._folder / f"part_{number:06d}.npz"

    def read(self, number: int, shape: tuple[int, ...]) -> Answer | None:
        """A part; None if it is not there, or was cut off while it was written."""
        try:
            arrays = read_arrays(self._path(number), InvalidSetting, "a part of a map")
            status, dexterity = arrays["status"], arrays["manipulability"]
        except (InvalidSetting, KeyError):
            return None
        return (status, dexterity) if status.shape == dexterity.shape == shape else None

    def write(self, number: int, answer: Answer) -> None:
        """Keep a part, as a whole or not at all."""
        path = self._path(number)
        with replaced(path) as partial, partial.open("wb") as file:
            np.savez_compressed(file, status=answer[0], manipulability=answer[1])
