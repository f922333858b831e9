"""A report as files: one HTML page that needs nothing else, and Markdown with its tables and figures beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pin_metaik.compare.report.html import html
from pin_metaik.compare.report.parts import Section
from pin_metaik.compare.report.write import write
from pin_metaik.output import replace_text


def write_page(
    folder: Path, name: str, title: str, lead: Sequence[str], sections: Sequence[Section], *, figures: bool = True
) -> list[Path]:
    """Write a report.

    Args:
        folder: Where to; made if it is not there.
        name: Stem of the HTML and the Markdown file.
        title: Heading of both.
        lead: Paragraphs below it; words in backticks are code.
        sections: The report.
        figures: Whether to draw the figures.

    Returns:
        The files written, the HTML page first.

    Raises:
        MissingExtra: Figures are wanted and matplotlib is not installed.
    """
    shown = sections if figures else [replace(section, figures=()) for section in sections]
    written = write(folder, name, [f"# {title}", *lead], shown, figures)
    page = folder / f"{name}.html"
    replace_text(page, html(title, lead, shown))
    return [page, *written]
