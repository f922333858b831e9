"""Parts of the fuzzing that are kept, of these sources or earlier ones, and runs that go on from another's page."""

from pathlib import Path

import pytest
from fuzz import Counts, Kept, all_counted, counted_on, elsewhere, page

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
        counts = all_counted({"WKT": range(10), "GeoJSON": range(10)}, 0.0, 1, kept)
    text = "\n".join(page(counts, {}, kept.by, ""))
    assert "| all | 20 | 20 | 8 | 10 | 2 | |" in text
    assert "earlier" in text.splitlines()[-1] and "now" in text.splitlines()[-1]


def test_a_run_goes_on_from_the_page_of_another_and_counts_both(file: Path, tmp_path: Path) -> None:
    kept, first = Kept(file), tmp_path / "page.md"
    first.write_text("\n".join(page({"GeoJSON": kept.parts[NEW]}, {}, kept.by, "")))
    before, sources = counted_on(first)
    assert before == {"GeoJSON": Counts(10, 4, 5, {"on the page before": 1}, 0.5)}
    with elsewhere():
        counts = all_counted({"GeoJSON": range(10, 30), "WKT": range(10)}, 5.0, 1, kept)
    text = "\n".join(page(counts, before, kept.by, sources))
    assert (
        "| GeoJSON | 30 | 20 |" in text
        and "| WKT | 10 | 10 |" in text
        and "| all | 40 | 30 |" in text
        and " | 1 | |" in text
    )
    assert text.splitlines()[-1].endswith(f"Before: {sources}")
    assert "\n".join(page({}, before, {}, sources)).endswith(f"| all | 10 | 0 | 4 | 5 | 1 | |\n{sources}"), (
        "nothing new"
    )


def test_what_is_not_kept_is_read_by_workers(tmp_path: Path) -> None:
    kept = Kept(tmp_path / "kept.jsonl")
    with elsewhere():
        counts = all_counted({"WKT": range(30), "GeoJSON": range(20)}, 5.0, 2, kept)
    assert {name: one.inputs for name, one in counts.items()} == {"WKT": 30, "GeoJSON": 20}
    assert not any(one.faults for one in counts.values())
    assert Kept(kept.file).parts == kept.parts
