"""``pin-metaik reproduce``: a paper's experiment again, next to what it printed."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from datetime import date
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from pin_metaik.cli import complete
from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.options import Json
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.versions import print_json
from pin_metaik.compare import papers
from pin_metaik.compare.papers import PAPERS, Options, Reproduction
from pin_metaik.compare.report import Section
from pin_metaik.compare.report.page import write_page
from pin_metaik.compare.report.show import show
from pin_metaik.compare.report.write import need_figures
from pin_metaik.folder_lock import locked
from pin_metaik.interrupts import kept
from pin_metaik.lookup import lookup
from pin_metaik.output import writable

QUICK_RUNS = 3
WIDE = 150  # columns for files and pipes, which have no width


def reproduce(
    name: Annotated[str, typer.Argument(help=f"One of {', '.join(PAPERS)}.", autocompletion=complete.papers)],
    runs: Annotated[int | None, typer.Option(min=1, help="Runs of each method; default: the paper's number.")] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help=f"Leave out what takes long; {QUICK_RUNS} runs unless --runs is given.")
    ] = False,
    long: Annotated[bool, typer.Option("--long", help="Also run what takes hours.")] = False,
    out: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder for HTML, Markdown, CSV files and figures.")
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw figures into --out; needs the extra plots.")] = True,
    rng: Annotated[int, typer.Option(min=0, help="Seed of every random choice.")] = 0,
    as_json: Json = False,
) -> None:
    """Run a paper's experiment again, and show its numbers beside ours. Ctrl-C keeps what is done."""
    paper = lookup("paper", name, PAPERS)
    if out is not None:
        if figures:
            need_figures()
        writable(out, folder=True)
        for before in out.glob(f"{name}*"):
            writable(before)
    options = Options(runs or (min(QUICK_RUNS, paper.runs) if quick else paper.runs), quick, long, rng)
    console = Console(width=None if sys.stdout.isatty() else WIDE, stderr=as_json)
    console.print(f"{paper.title}\n{paper.source}", markup=False, highlight=False)
    with nullcontext() if out is None else _alone_in(out):
        with progress_bar(name) as watch:
            again = kept(lambda: papers.reproduce(paper, options, watch))
        show(again.sections, console)
        console.print(f"\n{again}", style="yellow" if again.partial else None, markup=False, highlight=False)
        if out is not None:
            for path in write_page(out, name, paper.title, _lead(again), again.sections, figures=figures):
                console.print(str(path), markup=False, highlight=False, soft_wrap=True)
    if as_json:
        print_json({"paper": name, "jobs": again.done, "planned": again.planned, "sections": tables(again.sections)})
    raise typer.Exit(INTERRUPTED if again.partial else 0)


def tables(sections: Iterable[Section]) -> list[dict[str, object]]:
    """Sections of a report as plain values: their sentences, and their tables by name, a dict for each row."""
    return [
        {
            "title": section.title,
            "text": list(section.text),
            "tables": {
                table.name: [
                    dict(zip((column.heading for column in table.columns), row, strict=True)) for row in table.rows
                ]
                for table in section.tables
            },
        }
        for section in sections
    ]


@contextmanager
def _alone_in(out: Path) -> Iterator[None]:
    """Make the folder, and keep other processes out of it; what stays empty is taken away again."""
    out.mkdir(parents=True, exist_ok=True)
    try:
        with locked(out, "reproduction"):
            yield
    finally:
        with suppress(OSError):  # it holds something
            out.rmdir()


def _lead(again: Reproduction) -> list[str]:
    options = again.options
    flags = "".join(f" --{flag}" for flag in ("quick", "long") if getattr(options, flag))
    call = f"pin-metaik reproduce {again.paper.name} --runs {options.runs} --rng {options.rng}{flags}"
    return [again.paper.source, f"`{call}`, {date.today()}. {again}"]
