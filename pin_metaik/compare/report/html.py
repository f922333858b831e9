"""A report as one HTML page that needs nothing else: its figures and its style sheet are inside it."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Sequence
from html import escape
from importlib import resources

from pin_metaik.compare.report.canvas import save
from pin_metaik.compare.report.parts import Figure, Section, Table, Value
from pin_metaik.compare.report.write import need_figures

STYLE = "style.css"
LONG = 28  # letters of a cell that may be broken


def html(title: str, lead: Sequence[str], sections: Sequence[Section]) -> str:
    """The page.

    Args:
        title: Its heading.
        lead: Paragraphs below it, plain text; words in backticks are code.
        sections: The report.

    Raises:
        MissingExtra: There are figures, and matplotlib is not installed.
    """
    if any(section.figures for section in sections):
        need_figures()
    style = (resources.files(__package__) / STYLE).read_text(encoding="utf-8")
    anchors = [f"s{i}" for i in range(1, len(sections) + 1)]
    contents = "".join(
        f'<li><a href="#{anchor}">{escape(section.title)}</a></li>'
        for anchor, section in zip(anchors, sections, strict=True)
    )
    body = "\n".join(_section(anchor, section) for anchor, section in zip(anchors, sections, strict=True))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>{escape(title)}</title>
<style>
{style}</style>
</head>
<body>
<nav><ol>{contents}</ol></nav>
<main>
<header><h1>{escape(title)}</h1>
{_paragraphs(lead)}</header>
{body}
</main>
</body>
</html>
"""


def _section(anchor: str, section: Section) -> str:
    blocks = [f'<section id="{anchor}">', f"<h2>{escape(section.title)}</h2>", _paragraphs(section.text)]
    blocks += [_figure(figure) for figure in section.figures]
    blocks += [_table(table) for table in section.tables]
    return "\n".join([*blocks, "</section>"])


def _paragraphs(text: Iterable[str]) -> str:
    return "\n".join(f"<p>{_code(paragraph)}</p>" for paragraph in text)


def _code(text: str) -> str:
    """Escaped text; words in backticks are code."""
    return re.sub("`([^`]+)`", r"<code>\1</code>", escape(text))


def _table(table: Table) -> str:
    """A table; one that is not for showing is folded away."""
    words = [any(isinstance(row[i], str) for row in table.rows) for i in range(len(table.columns))]
    kinds = ["word" if wordy else "number" for wordy in words]
    head = "".join(
        f'<th class="{kind}">{escape(column.heading)}</th>' for column, kind in zip(table.columns, kinds, strict=True)
    )
    rows = "\n".join(f"<tr>{_cells(table, kinds, row)}</tr>" for row in table.rows)
    body = f'<div class="scroll"><table><thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody></table></div>'
    title = escape(table.title)
    if table.shown:
        return f'<figure class="table"><figcaption>{title}</figcaption>\n{body}</figure>'
    return f"<details><summary>{title} ({len(table.rows)} rows)</summary>\n{body}</details>"


def _cells(table: Table, kinds: Sequence[str], row: Sequence[Value]) -> str:
    cells = []
    for column, kind, value in zip(table.columns, kinds, row, strict=True):
        meter = ""
        if column.meter and isinstance(value, (int, float)):
            meter = f' style="--share:{100.0 * value:.1f}%"'
            kind = "meter"
        elif kind == "word" and len(column.text(value)) > LONG:
            kind = "word long"
        cells.append(f'<td class="{kind}"{meter}>{_code(column.text(value))}</td>')
    return "".join(cells)


def _figure(figure: Figure) -> str:
    drawn = f'<figure id="{figure.name}">\n{svg(figure)}\n<figcaption>{_code(figure.caption)}</figcaption></figure>'
    return drawn if figure.shown else f"<details><summary>{_code(figure.caption)}</summary>\n{drawn}</details>"


def svg(figure: Figure) -> str:
    """A figure as an SVG element; the same figure gives the same text, and no name in it clashes with another's."""
    from matplotlib import rc_context

    with rc_context({"svg.fonttype": "none", "svg.hashsalt": figure.name}):
        saved = io.StringIO()
        save(figure, saved, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = saved.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
    text = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>{figure.name}-", text)
    width, height = figure.size
    label = escape(figure.caption, quote=True)
    return re.sub(
        r'width="[\d.]+pt" height="[\d.]+pt"',
        f'role="img" aria-label="{label}" style="aspect-ratio:{width:g}/{height:g};max-width:{width:g}in"',
        text,
        count=1,
    ).strip()
