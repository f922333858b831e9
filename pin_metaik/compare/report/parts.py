"""A report as data: sections of sentences, tables and figures, to be printed or written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

Value: TypeAlias = str | int | float | None


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        heading: The quantity, with its unit.
        form: Format of its numbers, e.g. ``".3g"``; the CSV file has them in full.
        meter: Whether its numbers are shares from 0 to 1 that a page may show as bars.
    """

    heading: str
    form: str = ""
    meter: bool = False

    def text(self, value: Value) -> str:
        """A value as text; ``None`` is a dash."""
        if value is None:
            return "-"
        return value if isinstance(value, str) else format(value, self.form)


@dataclass(frozen=True)
class Table:
    """A table; a file of its own when written.

    Attributes:
        name: Stem of its CSV file, unique in the report.
        title: One line.
        columns: Its columns.
        rows: One value for each column.
        shown: Whether it is printed; raw data, e.g. every single run, is only written to its CSV file.
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: list[tuple[Value, ...]]
    shown: bool = True


@dataclass(frozen=True)
class Figure:
    """A figure, drawn only when it is written.

    Attributes:
        name: Stem of its PNG file, unique in the report.
        caption: One sentence on its contents.
        draw: Draws into an empty ``matplotlib.figure.Figure``; needs the extra ``plots``.
        size: Width and height in inches.
        shown: Whether a page opens with it; otherwise it is folded away.
    """

    name: str
    caption: str
    draw: Callable[[Any], None]
    size: tuple[float, float] = (9.0, 4.0)
    shown: bool = True


@dataclass(frozen=True)
class Section:
    """A section of a report: sentences, then tables, then figures.

    Attributes:
        title: Its heading.
        text: Paragraphs, plain text.
        tables: Its tables.
        figures: Its figures.
    """

    title: str
    text: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    figures: tuple[Figure, ...] = ()
