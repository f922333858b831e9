"""A report as files: Markdown, one CSV file a table, one PNG file a figure."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from pin_metaik.compare.report.canvas import save
from pin_metaik.compare.report.parts import Figure, Section, Table
from pin_metaik.lookup import need

DPI = 150


def need_figures() -> None:
    """Make sure figures can be drawn, before an experiment runs for minutes.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    need("drawing figures", "plots", "matplotlib")


def write(folder: Path, name: str, preamble: Sequence[str], sections: Sequence[Section], figures: bool) -> list[Path]:
    """Write a report.

    Args:
        folder: Where to; made if it is not there.
        name: Stem of the Markdown file.
        preamble: Its first lines, as Markdown: title, source, command.
        sections: The report.
        figures: Whether to draw the figures.

    Returns:
        The files written.

    Raises:
        MissingExtra: Figures are wanted and matplotlib is not installed.
    """
    if figures:
        need_figures()
    folder.mkdir(parents=True, exist_ok=True)
    page = folder / f"{name}.md"
    page.write_text(markdown(preamble, sections, figures), encoding="utf-8")
    tables = [_write_csv(folder, table) for section in sections for table in section.tables]
    drawn = [_draw(folder, figure) for section in sections for figure in section.figures if figures]
    return [page, *tables, *drawn]


def markdown(preamble: Sequence[str], sections: Iterable[Section], figures: bool) -> str:
    """A report as Markdown; raw tables and figures are links."""
    blocks = list(preamble)
    for section in sections:
        blocks += [f"## {section.title}", *section.text]
        for table in section.tables:
            link = f"[{table.name}.csv]({table.name}.csv)"
            blocks += [f"{table.title} ({link}):", markdown_table(table)] if table.shown else [f"{table.title}: {link}"]
        if figures:
            blocks += [f"![{figure.caption}]({figure.name}.png)\n\n{figure.caption}" for figure in section.figures]
    return "\n\n".join(blocks) + "\n"


def markdown_table(table: Table) -> str:
    """A table as Markdown; columns with words are set to the left, numbers to the right."""
    words = [any(isinstance(row[i], str) for row in table.rows) for i in range(len(table.columns))]
    lines = [
        [column.heading for column in table.columns],
        ["---" if wordy else "---:" for wordy in words],
        *([column.text(value) for column, value in zip(table.columns, row, strict=True)] for row in table.rows),
    ]
    escaped = [[cell.replace("|", r"\|") for cell in line] for line in lines]
    return "\n".join(f"| {' | '.join(line)} |" for line in escaped)


def _write_csv(folder: Path, table: Table) -> Path:
    """A table with all digits; ``None`` is empty."""
    path = folder / f"{table.name}.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([column.heading for column in table.columns])
        writer.writerows(table.rows)
    return path


def _draw(folder: Path, figure: Figure) -> Path:
    path = folder / f"{figure.name}.png"
    save(figure, path, dpi=DPI)
    return path
