"""The page: complete in itself, escaped, and shown without an error by a real browser."""

import json
import re
import subprocess
from pathlib import Path

import pytest

from pin_metaik.compare import Suite, compare, write_report
from pin_metaik.compare.report import Column, Figure, Section, Table
from pin_metaik.compare.report.html import html
from tests.compare.suites import JUMPING

MEASURE = """<script>addEventListener("load", () => {
  const drawn = svg => [...svg.querySelectorAll("path, use, text, image")].filter(e => {
    const box = e.getBoundingClientRect(); return box.width + box.height > 0; }).length;
  const of = s => { const box = s.getBoundingClientRect();
    return {name: s.closest("figure").id, width: box.width, height: box.height, drawn: drawn(s)}; };
  const ids = [...document.querySelectorAll("[id]")].map(e => e.id);
  const wide = [...document.querySelectorAll("main > *")].filter(e => e.scrollWidth > e.clientWidth + 1).length;
  document.body.dataset.seen = JSON.stringify({figures: [...document.querySelectorAll("svg")].map(of), wide,
    tables: document.querySelectorAll("table").length, twice: ids.length - new Set(ids).size,
    loaded: performance.getEntriesByType("resource").map(e => e.name)});
});</script>"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small comparison, errors among its rows, and its report."""
    out = tmp_path_factory.mktemp("comparison")
    methods = ("lm+restarts", "dls+restarts", "gwo", "mtde@60+dls", "default", JUMPING)
    compare(
        Suite(("ur5",), ("near_limit", "path"), methods, tasks=8, budget=300), out, command="pin-metaik <&> compare"
    )
    write_report(out)
    return out


def test_the_page_needs_nothing_else_and_is_escaped(folder: Path) -> None:
    page = (folder / "report" / "report.html").read_text(encoding="utf-8")
    assert "<code>pin-metaik &lt;&amp;&gt; compare</code>" in page
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert links and all(link.startswith(("#", "data:")) for link in links)
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", page)
    assert page.count("<svg") == page.count("</svg>") == 4


def test_the_same_rows_give_the_same_page(folder: Path) -> None:
    page = (folder / "report" / "report.html").read_bytes()
    write_report(folder)
    assert (folder / "report" / "report.html").read_bytes() == page


def test_the_markdown_page_has_its_tables_and_figures_beside_it(folder: Path) -> None:
    text = (folder / "report" / "report.md").read_text(encoding="utf-8")
    for link in re.findall(r"\]\(([^)]+)\)", text):
        assert (folder / "report" / link).stat().st_size > 0
    assert "| method | mean rank by evaluations | solved |" in text and "trials raised ZeroDivisionError" in text


def test_meters_are_bars_and_raw_tables_are_folded_away() -> None:
    columns = (Column("method"), Column("solved", ".0%", meter=True))
    tables = (
        Table("a", "A", columns, [("<gwo>", 0.25), ("`mtde`", None)]),
        Table("b", "Raw", columns, [], shown=False),
    )
    page = html("T", ["lead"], [Section("S & T", ("text",), tables)])
    assert '<td class="meter" style="--share:25.0%">25%</td>' in page and '<td class="number">-</td>' in page
    assert "&lt;gwo&gt;" in page and "<code>mtde</code>" in page and "<h2>S &amp; T</h2>" in page
    assert "<details><summary>Raw (0 rows)</summary>" in page


def test_names_inside_figures_do_not_clash() -> None:
    def draw(canvas: object) -> None:
        canvas.subplots().plot([1, 2])  # type: ignore[attr-defined]

    page = html("T", [], [Section("S", (), (), (Figure("one", "1.", draw), Figure("two", "2.", draw)))])
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    used = set(re.findall(r'(?:url\(#|href="#)([^)"]+)', page))
    assert used and used <= set(ids)


@pytest.mark.slow
def test_chromium_shows_every_figure_and_complains_of_nothing(folder: Path, browser: list[str], tmp_path: Path) -> None:
    page = (folder / "report" / "report.html").read_text(encoding="utf-8")
    measured = tmp_path / "measured.html"
    measured.write_text(page.replace("</head>", f"{MEASURE}</head>"), encoding="utf-8")
    profile = [f"--user-data-dir={tmp_path / 'profile'}", "--window-size=1400,1000"]
    done = subprocess.run(
        [*browser, *profile, "--dump-dom", measured.as_uri()], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert "CONSOLE" not in done.stderr
    seen = re.search(r'data-seen="([^"]*)"', done.stdout)
    assert seen is not None
    found = json.loads(seen[1].replace("&quot;", '"'))
    assert [figure["name"] for figure in found["figures"]] == ["ecdf", "rates", "duels", "convergence"]
    for figure in found["figures"]:
        assert figure["width"] > 400 and figure["height"] > 150 and figure["drawn"] > 30, figure
    assert found["tables"] == page.count("<table>") and found["twice"] == 0
    assert found["wide"] == 0  # nothing sticks out: wide tables scroll inside their box
    assert found["loaded"] == []


@pytest.mark.slow
def test_chromium_draws_the_page(folder: Path, browser: list[str], tmp_path: Path) -> None:
    from matplotlib.image import imread

    shot = tmp_path / "page.png"
    profile = [f"--user-data-dir={tmp_path / 'profile'}", "--window-size=1400,1600", f"--screenshot={shot}"]
    page = (folder / "report" / "report.html").as_uri()
    subprocess.run([*browser, *profile, page], capture_output=True, timeout=120, check=True)
    pixels = imread(shot)[..., :3]
    assert pixels.shape[:2] == (1600, 1400)
    middle = pixels[:, 300:]  # right of the contents
    coloured = (middle.max(axis=2) - middle.min(axis=2) > 0.3).any(axis=1)
    assert coloured.sum() > 100  # rows that lines of a figure cross
    assert ((middle < 0.9).any(axis=2)).mean() > 0.01
