"""Information is the documentation's own text, in a checkout and in a wheel."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

pytest.importorskip("viser")

from pin_metaik.gui.pages.information import DOCUMENTS, SUBJECTS

ROOT = Path(__file__).parents[2]


def test_every_subject_has_words_of_its_own_and_no_picture_that_is_not_there() -> None:
    texts = {title: text() for title, text in SUBJECTS.items()}
    assert all(len(text) > 50 and "![" not in text for text in texts.values())
    assert len(set(texts.values())) == len(texts)


def test_wheels_are_built_with_the_documents_that_are_shown() -> None:
    build = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    packed = build["force-include"]
    for name in DOCUMENTS.values():
        inside = f"pin_metaik/gui/docs/{name}"
        assert packed.get(f"docs/{name}") == inside or packed["docs/papers"] == str(Path(inside).parent)
        assert (ROOT / "docs" / name).is_file()
