"""A report on the terminal."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console
from rich.table import Table as Grid

from pin_metaik.compare.report.parts import Section, Table


def show(sections: Iterable[Section], console: Console) -> None:
    """Print sections: headings, sentences and tables; figures are for files."""
    for section in sections:
        console.print(f"\n{section.title}", style="bold", markup=False, highlight=False)
        for paragraph in section.text:
            console.print(paragraph, markup=False, highlight=False)
        for table in section.tables:
            if table.shown:
                console.print(_grid(table))


def _grid(table: Table) -> Grid:
    grid = Grid(title=table.title, title_justify="left", title_style="italic", box=None, padding=(0, 1))
    for i, column in enumerate(table.columns):
        words = any(isinstance(row[i], str) for row in table.rows)
        grid.add_column(column.heading, justify="left" if words else "right", overflow="fold")
    for row in table.rows:
        grid.add_row(*(column.text(value) for column, value in zip(table.columns, row, strict=True)))
    return grid
