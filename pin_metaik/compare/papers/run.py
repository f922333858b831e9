"""Running a paper's jobs under a progress bar; Ctrl-C goes through with those that are done."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Column

from pin_metaik.compare.papers.paper import AnyPaper, Options
from pin_metaik.compare.report import Section
from pin_metaik.interrupts import Interrupted


@dataclass(frozen=True)
class Reproduction:
    """A paper's experiment, run here.

    Attributes:
        paper: The paper.
        options: How much of it was run.
        sections: The report.
        done: Jobs done.
        planned: Jobs there were.
        seconds: Time taken, in s.
    """

    paper: AnyPaper
    options: Options
    sections: list[Section]
    done: int
    planned: int
    seconds: float

    @property
    def partial(self) -> bool:
        """Whether it was interrupted."""
        return self.done < self.planned

    def __str__(self) -> str:
        if self.partial:
            return f"PARTIAL: interrupted after {self.done} of {self.planned} jobs, {self.seconds:.0f} s."
        return f"All {self.planned} jobs done in {self.seconds:.0f} s."


def reproduce(paper: AnyPaper, options: Options, console: Console | None = None) -> Reproduction:
    """Run a paper's jobs one after the other and report on them.

    Args:
        paper: The paper.
        options: How much of it to run.
        console: Where to show a progress bar; nowhere if None.

    Raises:
        Interrupted: Ctrl-C; its ``result`` reports on the jobs that are done.
    """
    began = perf_counter()
    jobs = list(paper.jobs(options))
    done: list[Any] = []
    label = TextColumn("{task.description}", table_column=Column(no_wrap=True, overflow="ellipsis", ratio=1))
    times = [kind(table_column=Column(no_wrap=True, min_width=7)) for kind in (TimeElapsedColumn, TimeRemainingColumn)]
    columns = (label, BarColumn(bar_width=20), times[0], TextColumn("left"), times[1])
    bar = Progress(
        *columns, console=console or Console(quiet=True), transient=True, disable=console is None, expand=True
    )

    def again() -> Reproduction:
        return Reproduction(paper, options, paper.sections(done, options), len(done), len(jobs), perf_counter() - began)

    try:
        with bar:
            task = bar.add_task(paper.name, total=sum(job.size for job in jobs))
            for job in jobs:
                bar.update(task, description=f"{paper.name}: {job.label}")
                done.append(job.work())
                bar.advance(task, job.size)
    except KeyboardInterrupt:
        raise Interrupted(again()) from None
    return again()
