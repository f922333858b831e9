import csv
import sys

import pytest
from rich.console import Console

from pin_metaik.compare.report import Column, Figure, Section, Table
from pin_metaik.compare.report.show import show
from pin_metaik.compare.report.write import markdown, markdown_table, write
from pin_metaik.errors import MissingExtra

TABLE = Table("t", "Costs", (Column("method"), Column("F mm", ".2g")), [("GWO", 1 / 3), ("MTDE", None)])
RAW = Table("raw", "Every run", (Column("F"),), [(1 / 3,)], shown=False)
FIGURE = Figure("f", "A line.", lambda canvas: canvas.subplots().plot([0, 1], [0, 1]))
SECTION = Section("Results", ("A sentence.",), (TABLE, RAW), (FIGURE,))


def test_numbers_are_shown_in_their_columns_form_and_missing_ones_as_a_dash():
    assert markdown_table(TABLE).splitlines() == [
        "| method | F mm |",
        "| --- | ---: |",
        "| GWO | 0.33 |",
        "| MTDE | - |",
    ]


def test_the_terminal_shows_sentences_and_tables_but_not_raw_data():
    console = Console(record=True, width=80, quiet=False)
    show([SECTION], console)
    text = console.export_text()
    assert "Results" in text and "A sentence." in text and "0.33" in text
    assert "Every run" not in text


def test_files_are_markdown_a_csv_a_table_and_a_png_a_figure(tmp_path):
    written = write(tmp_path / "new", "page", ["# Title"], [SECTION], figures=True)
    assert [path.name for path in written] == ["page.md", "t.csv", "raw.csv", "f.png"]
    assert all(path.stat().st_size for path in written)
    page = written[0].read_text()
    assert page.startswith("# Title\n\n## Results")
    assert "![A line.](f.png)" in page and "[raw.csv](raw.csv)" in page


def test_a_csv_file_has_all_digits_and_nothing_for_a_missing_value(tmp_path):
    write(tmp_path, "page", [], [SECTION], figures=False)
    with (tmp_path / "t.csv").open(newline="") as file:
        assert list(csv.reader(file)) == [["method", "F mm"], ["GWO", str(1 / 3)], ["MTDE", ""]]


def test_without_figures_the_page_shows_none():
    assert "png" not in markdown([], [SECTION], figures=False)


def test_without_matplotlib_tables_are_written_and_figures_name_the_extra(tmp_path, monkeypatch):
    monkeypatch.setattr("pin_metaik.lookup.find_spec", lambda name: None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    write(tmp_path / "tables", "page", [], [SECTION], figures=False)
    with pytest.raises(MissingExtra, match=r"\[plots\]"):
        write(tmp_path / "figures", "page", [], [SECTION], figures=True)
    assert not (tmp_path / "figures").exists()


def test_a_bar_in_a_cell_does_not_end_it() -> None:
    table = Table("t", "T", (Column("what"),), [("|x - x0|",)])
    assert markdown_table(table).splitlines()[-1] == r"| \|x - x0\| |"
