"""Running a paper's jobs under a progress bar; Ctrl-C is raised with the results of the jobs that are done."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import Any

from pin_metaik.compare.papers.paper import AnyPaper, Options
from pin_metaik.compare.report import Section
from pin_metaik.watching import Progress, Watch, ended, tell


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


def reproduce(paper: AnyPaper, options: Options, watch: Watch | None = None) -> Reproduction:
    """Run a paper's jobs one after the other and report on them.

    Args:
        paper: The paper.
        options: How much of it to run.
        watch: Called before every job with the sizes of jobs done and in all; True ends the experiment there.

    Raises:
        Interrupted: Ctrl-C; its ``result`` reports on the jobs that are done.
    """
    began = perf_counter()
    jobs = list(paper.jobs(options))
    done: list[Any] = []

    def again() -> Reproduction:
        return Reproduction(paper, options, paper.sections(done, options), len(done), len(jobs), perf_counter() - began)

    try:
        for job in jobs:
            size = sum(each.size for each in jobs[: len(done)])
            tell(watch, Progress(size, sum(each.size for each in jobs), label=f"{paper.name}: {job.label}"))
            done.append(job.work())
    except KeyboardInterrupt as stop:
        return ended(stop, again())
    return again()
