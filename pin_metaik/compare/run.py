"""Running a comparison: tasks go to joblib's workers, rows come back and are on disk at once; nothing is done twice."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import Any, Literal, TypeAlias

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from pin_metaik.arguments import checked
from pin_metaik.compare import environment
from pin_metaik.compare.record import Record
from pin_metaik.compare.store import Appender, need_parquet, open_record, read_rows, write_parquet
from pin_metaik.compare.suite import Suite
from pin_metaik.compare.trial import Trial
from pin_metaik.compare.unit import Unit
from pin_metaik.errors import InvalidSetting, MissingExtra
from pin_metaik.output import writable

Backend: TypeAlias = Literal["loky", "dask"]

MOST_JOBS = 10_000
CONNECTING = 10.0  # s


@dataclass(frozen=True)
class Outcome:
    """How far a comparison is.

    Attributes:
        folder: Where its rows are.
        done: Rows there are.
        planned: Rows there shall be.
        fresh: Rows that were run now.
        errors: Rows that are errors.
        seconds: Time taken now, s.
    """

    folder: Path
    done: int
    planned: int
    fresh: int
    errors: int
    seconds: float

    @property
    def partial(self) -> bool:
        """Whether it was interrupted."""
        return self.done < self.planned

    def __str__(self) -> str:
        fresh = f"{self.fresh:,} of them now, in {self.seconds:.0f} s"
        errors = f"; {self.errors:,} raised an error" if self.errors else ""
        state = "interrupted: the same command goes on from here" if self.partial else "done"
        return f"{self.done:,} of {self.planned:,} rows, {fresh}{errors}: {state}"


@checked
def compare(
    suite: Suite,
    folder: Path,
    *,
    jobs: int = 1,
    backend: Backend = "loky",
    scheduler: str | None = None,
    command: str = "pin_metaik.compare.compare(...)",
    console: Console | None = None,
) -> Outcome:
    """Run a comparison, or what is left of it, into a folder. Ctrl-C, or worse, loses none of the finished tasks.

    Rows, but for their times, depend neither on ``jobs`` nor on the backend nor on interruptions.

    Args:
        suite: What to compare.
        folder: For the rows; made if it is not there.
        jobs: Processes; -1: one a core. Of the Dask backend: ignored, the cluster's workers are used.
        backend: joblib's: ``"loky"`` for processes here, ``"dask"`` for a Dask cluster.
        scheduler: Address of the Dask scheduler, e.g. ``"tcp://node1:8786"``.
        command: What to write down as the command that did it.
        console: Where to show a progress bar; nowhere if None.

    Raises:
        MissingExtra: joblib, pyarrow or distributed are not installed.
        InvalidSetting: The folder holds another comparison, jobs are none, or the scheduler cannot be reached.
        CannotWrite: The folder cannot be made or written into.
    """
    need_parquet()
    if jobs == 0 or abs(jobs) > MOST_JOBS:
        raise InvalidSetting(f"jobs is a number of processes, 1 to {MOST_JOBS:,}, or -1: one a core; got {jobs}")
    writable(folder, folder=True)
    need_joblib()
    began = perf_counter()
    open_record(folder, Record.of(suite))
    environment.record(folder, command)
    rows = {trial.key: trial for trial in read_rows(folder)}
    before = len(rows)
    with contextlib.suppress(KeyboardInterrupt), _bar(console) as bar, Appender(folder) as file:
        bar_task = bar.add_task("comparing", total=suite.trials, completed=before)
        for trials in _worked(list(suite.units(rows.keys())), jobs, backend, scheduler):
            file.add(trials)
            rows.update((trial.key, trial) for trial in trials)
            bar.update(bar_task, completed=len(rows), description=f"{trials[-1].robot}, {trials[-1].case}")
    write_parquet(folder, rows.values())
    errors = sum(trial.error is not None for trial in rows.values())
    return Outcome(folder, len(rows), suite.trials, len(rows) - before, errors, perf_counter() - began)


def need_joblib() -> None:
    """Make sure that tasks can be handed to workers.

    Raises:
        MissingExtra: joblib is not installed.
    """
    if find_spec("joblib") is None:
        raise MissingExtra("comparing methods", "compare")


def _worked(units: list[Unit], jobs: int, backend: Backend, scheduler: str | None) -> Iterator[list[Trial]]:
    """The rows of units, in the order in which they are finished."""
    from joblib import Parallel, delayed, parallel_config

    with contextlib.ExitStack() as stack:
        chosen: dict[str, Any] = {"backend": backend, "n_jobs": jobs}
        if backend == "dask":
            chosen |= {"client": stack.enter_context(_cluster(scheduler)), "n_jobs": -1}
        stack.enter_context(parallel_config(**chosen))
        yield from Parallel(return_as="generator_unordered", pre_dispatch="3*n_jobs")(
            delayed(Unit.work)(unit) for unit in units
        )


def _cluster(scheduler: str | None) -> Any:
    """A client of a Dask cluster, to be closed."""
    if find_spec("distributed") is None:
        raise MissingExtra("a Dask cluster", "cluster")
    from distributed import Client

    if scheduler is None:
        raise InvalidSetting("name the Dask cluster: --scheduler ADDRESS, e.g. tcp://localhost:8786")
    try:
        return Client(scheduler, timeout=CONNECTING)  # type: ignore[no-untyped-call]  # it carries no types
    except (OSError, ValueError) as error:
        raise InvalidSetting(f"no Dask scheduler answers at {scheduler}: {error}") from None


def _bar(console: Console | None) -> Progress:
    columns = (TextColumn("{task.description:28}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    return Progress(
        *columns,
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console or Console(quiet=True),
        transient=True,
        disable=console is None,
    )
