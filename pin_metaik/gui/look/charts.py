"""Charts with names along their sides, which uPlot does not have: rows of HTML, with the numbers where one points."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from pin_metaik.compare.report.figures import times
from pin_metaik.compare.results.series import Duels

BLUE, RED = (33, 102, 172), (178, 24, 43)
FULL = 2.0  # decades, at which a colour is full
DEEP, PALE = 0.75, 0.2  # how deep it is then, of a difference that is significant and of one that is not
NAME = "flex:0 0 38%;overflow:hidden;text-overflow:ellipsis;white-space:nowrap;text-align:right;padding-right:0.5em"
TRACK = "flex:1;position:relative;height:1.3em;border-left:1px solid #888;border-right:1px solid #888"


def intervals(found: Mapping[str, tuple[float, float, float]]) -> str:
    """Shares with their intervals, a row each, the highest first.

    Args:
        found: Share, lower and upper end of its interval, 0 to 1, by name.
    """
    rows = []
    for name in sorted(found, key=lambda name: found[name], reverse=True):
        share, low, high = (100.0 * value for value in found[name])
        said = escape(f"{name}: {share:.1f} %, 95 % interval {low:.1f} to {high:.1f} %", quote=True)
        bar = f"left:{low:.2f}%;width:{high - low:.2f}%;top:0.5em;height:0.3em;background:#1f5fa8;opacity:0.45"
        dot = (
            f"left:calc({share:.2f}% - 0.3em);top:0.35em;width:0.6em;height:0.6em;border-radius:50%;background:#1f5fa8"
        )
        rows.append(
            f'<div role="listitem" aria-label="{said}" title="{said}" style="display:flex">'
            f'<span style="{NAME}">{escape(name)}</span><span style="{TRACK}">'
            f'<i style="position:absolute;{bar}"></i><i style="position:absolute;{dot}"></i></span></div>'
        )
    ends = '<span style="flex:1;display:flex;justify-content:space-between"><span>0</span><span>100 %</span></span>'
    axis = f'<div aria-hidden="true" style="display:flex"><span style="{NAME}"></span>{ends}</div>'
    return _framed("".join(rows) + axis, "list", "Share solved, with its 95 % interval")


def matrix(fought: Duels) -> str:
    """Every method against every other: how many times the evaluations of the column's method the row's takes."""
    names = fought.methods
    heads = (f"<th scope=col title={_quoted(name)}>{k}</th>" for k, name in enumerate(names, start=1))
    lines = [f"<tr><th></th>{''.join(heads)}</tr>"]
    for i, row in enumerate(names):
        cells = []
        for j, column in enumerate(names):
            ratio, certain = float(fought.ratios[i, j]), bool(fought.certain[i, j])
            sure = "" if certain else "; the difference is not significant"
            said = _quoted(f"{row} takes {times(ratio)} times the evaluations of {column}{sure}")
            back, front = (_colour(ratio, DEEP), "#000") if certain else (_colour(ratio, PALE), "#666")
            look = f"background:{back};color:{front};text-align:center;padding:0 0.3em"
            cells.append("<td></td>" if i == j else f'<td title={said} style="{look}">{times(ratio)}</td>')
        lines.append(f'<tr><th scope=row style="text-align:left">{i + 1} {escape(row)}</th>{"".join(cells)}</tr>')
    table = f'<table style="border-collapse:collapse;font-size:0.9em">{"".join(lines)}</table>'
    return _framed(table, "group", "Every method against every other")


def _colour(ratio: float, depth: float) -> str:
    """White where both take the same, blue where the row takes fewer, red where it takes more; the deepest is 1."""
    share = min(abs(ratio) / FULL, 1.0)
    end = BLUE if ratio < 0.0 else RED
    return "rgb({},{},{})".format(*(round(255 + depth * share * (value - 255)) for value in end))


def _quoted(text: str) -> str:
    return f'"{escape(text, quote=True)}"'


def _framed(inside: str, role: str, label: str) -> str:
    style = "padding:0 0.75em 0.6em;font-size:0.85em;overflow-x:auto"
    return f'<div role="{role}" aria-label="{escape(label)}" style="{style}">{inside}</div>'
