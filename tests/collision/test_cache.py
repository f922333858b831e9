from pathlib import Path

import numpy as np
import pytest

from pin_metaik.collision.cache import Arrays, kept


def test_what_was_made_once_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path / "cache"))
    made = []

    def make() -> Arrays:
        made.append(1)
        return {"x": np.arange(3.0)}

    for content in (b"a", b"a", b"b"):
        assert kept("test", content, make)["x"].tolist() == [0.0, 1.0, 2.0]
    assert len(made) == 2


def test_a_damaged_file_is_made_again_and_no_place_to_write_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PIN_METAIK_CACHE", str(tmp_path / "cache"))
    kept("test", b"a", lambda: {"x": np.zeros(1)})
    (file,) = (tmp_path / "cache").glob("*.npz")
    file.write_bytes(b"PK damaged")
    assert kept("test", b"a", lambda: {"x": np.ones(1)})["x"].tolist() == [1.0]
    monkeypatch.setenv("PIN_METAIK_CACHE", str(file / "no folder"))
    assert kept("test", b"a", lambda: {"x": np.ones(1)})["x"].tolist() == [1.0]
