"""Parts of the fuzzing that are kept: those of these sources, and of earlier ones where these have none of a reader."""

from pathlib import Path

import pytest
from fuzz import Counts, Kept, all_counted, elsewhere, page

OLD, NEW = ("WKT", 0, 10), ("GeoJSON", 0, 10)


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file with a part of two readers that earlier sources read, and one of them again."""
    path = tmp_path / "kept.jsonl"
    for digest, parts in {"earlier": (OLD, NEW), "now": (NEW,)}.items():
        monkeypatch.setattr("fuzz.sources", lambda *_, digest=digest: digest)
        kept = Kept(path)
        for part in parts:
            kept.add(part, Counts(10, 4, 5, {f"one of {digest} (input 3)": 1}, 0.5))
    return path


def test_parts_count_that_the_same_sources_read(file: Path) -> None:
    assert set(Kept(file).parts) == {NEW}
    assert list(Kept(file).parts[NEW].faults) == ["one of now (input 3)"]


def test_earlier_parts_count_where_there_is_no_later_one_of_the_reader(file: Path) -> None:
    kept = Kept(file, earlier=True)
    assert kept.by == {"WKT": "earlier", "GeoJSON": "now"}
    assert list(kept.parts[NEW].faults) == ["one of now (input 3)"]
    with elsewhere():
        counts = all_counted({"WKT": 10, "GeoJSON": 10}, 0, 0.0, 1, kept)
    text = "\n".join(page(counts, kept.by))
    assert "| all | 20 | 8 | 10 | 2 | |" in text
    assert "earlier" in text.splitlines()[-1] and "now" in text.splitlines()[-1]


def test_what_is_not_kept_is_read_by_workers(tmp_path: Path) -> None:
    kept = Kept(tmp_path / "kept.jsonl")
    with elsewhere():
        counts = all_counted({"WKT": 30, "GeoJSON": 20}, 0, 5.0, 2, kept)
    assert {name: one.inputs for name, one in counts.items()} == {"WKT": 30, "GeoJSON": 20}
    assert not any(one.faults for one in counts.values())
    assert Kept(kept.file).parts == kept.parts
