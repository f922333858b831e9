"""The directive ``layers``: a drawing of the layers that import-linter holds, made from its contracts.

A row is a layer; its rooms may be imported by every row above it, and by none below.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

WIDTH, ROW, GAP, CHARACTER, PADDING = 760, 30, 8, 7.4, 12  # pixels


@dataclass(frozen=True)
class Drawing:
    """A contract of layers: its name, and the rooms of each layer, the highest first."""

    name: str
    rows: tuple[tuple[str, ...], ...]

    def svg(self) -> str:
        """The drawing, in the colours of the page around it."""
        lines = [line for row in self.rows for line in _wrapped(row)]
        height = len(lines) * (ROW + GAP) + GAP
        boxes, y = [], GAP
        for line in lines:
            width = sum(_width(room) for room in line) + GAP * (len(line) - 1)
            x = (WIDTH - width) / 2
            for room in line:
                boxes.append(
                    f'<rect x="{x:.1f}" y="{y}" width="{_width(room):.1f}" height="{ROW}" rx="5"/>'
                    f'<text x="{x + _width(room) / 2:.1f}" y="{y + ROW / 2 + 5}">{escape(room)}</text>'
                )
                x += _width(room) + GAP
            y += ROW + GAP
        return (
            f'<svg class="layers" role="img" aria-label="{escape(self.name)}" viewBox="0 0 {WIDTH} {height}">'
            f"{''.join(boxes)}</svg>"
        )


def drawings(project: Path) -> list[Drawing]:
    """Those of all contracts about layers in a pyproject.toml, with the rooms that are there."""
    contracts = tomllib.loads(project.read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    made = []
    for contract in contracts:
        if contract["type"] == "layers":
            folder = project.parent.joinpath(*contract["containers"][0].split("."))
            there = {path.stem for path in folder.iterdir()}
            rows = (tuple(room for room in re.findall(r"\w+", layer) if room in there) for layer in contract["layers"])
            made.append(Drawing(contract["name"], tuple(row for row in rows if row)))
    return made


def _width(room: str) -> float:
    return len(room) * CHARACTER + 2 * PADDING


def _wrapped(row: tuple[str, ...]) -> list[list[str]]:
    """The rooms of a layer in lines that are no wider than the drawing."""
    lines: list[list[str]] = [[]]
    for room in row:
        if sum(_width(other) + GAP for other in (*lines[-1], room)) > WIDTH and lines[-1]:
            lines.append([])
        lines[-1].append(room)
    return lines


class Layers(SphinxDirective):
    """Without content: every contract as a figure with its name."""

    def run(self) -> list[nodes.Node]:
        """The drawings, the whole package first."""
        project = Path(self.env.srcdir, "pyproject.toml")
        self.env.note_dependency(str(project))
        made: list[nodes.Node] = []
        for drawing in drawings(project):
            figure = f'<figure class="layers"><figcaption>{escape(drawing.name)}</figcaption>{drawing.svg()}</figure>'
            made.append(nodes.raw("", figure, format="html"))
        return made


def setup(app: Any) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("layers", Layers)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
