"""Running a comparison: work items go to joblib's workers, rows are written as they come back, none is run twice."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from pin_metaik.arguments import checked
from pin_metaik.compare.cases.case import NoTask
from pin_metaik.compare.folder.environment import append_environment
from pin_metaik.compare.folder.manifest import Manifest
from pin_metaik.compare.folder.robot_files import copy_robots
from pin_metaik.compare.folder.store import (
    ROWS,
    Appender,
    check_manifest,
    need_parquet,
    read_rows,
    write_manifest,
    write_parquet,
)
from pin_metaik.compare.trials.suite import Suite
from pin_metaik.folder_lock import locked
from pin_metaik.interrupts import Pressed
from pin_metaik.optimize.settings import one_of
from pin_metaik.output import writable
from pin_metaik.plain import fields_of
from pin_metaik.watching import Progress, Watch, ended, tell
from pin_metaik.workers import Backend, check_jobs, need_joblib, worked


@dataclass(frozen=True)
class Outcome:
    """Progress of a comparison when its run ended.

    Attributes:
        folder: Folder with its rows.
        done: Number of rows in the folder.
        planned: Number of rows of the whole comparison.
        fresh: Number of rows added by this run.
        errors: Number of rows whose method raised an error.
        seconds: Time taken by this run, s.
        absent: Pairs of robot and case without tasks, and why.
        error: The most frequent error; empty if there was none.
    """

    folder: Path
    done: int
    planned: int
    fresh: int
    errors: int
    seconds: float
    absent: tuple[str, ...] = ()
    error: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        names = ("folder", "done", "planned", "partial", "fresh", "errors", "seconds", "absent", "error")
        return fields_of(self, *names)

    @property
    def partial(self) -> bool:
        """Whether it was interrupted."""
        return self.done < self.planned

    def __str__(self) -> str:
        fresh = f"{self.fresh:,} of them now, in {self.seconds:.0f} s"
        errors = f"; {self.errors:,} raised an error, most often {self.error}" if self.errors else ""
        state = "interrupted: the same command resumes from here" if self.partial else "done"
        without = [f"without {line}" for line in self.absent]
        return "\n".join([*without, f"{self.done:,} of {self.planned:,} rows, {fresh}{errors}: {state}"])


@checked
def compare(
    suite: Suite,
    folder: Path,
    *,
    jobs: int = 1,
    backend: Backend = "loky",
    scheduler: str | None = None,
    command: str = "pin_metaik.compare.compare(...)",
    watch: Watch | None = None,
) -> Outcome:
    """Run a comparison, or the rest of it, into a folder. Finished tasks are never lost by Ctrl-C or a kill.

    Apart from their times, rows do not depend on ``jobs``, the backend or interruptions. A case without a task for a
    robot is left out, which ``Outcome.absent`` reports.

    Args:
        suite: What to compare.
        folder: Folder for the rows; it is made if it does not exist.
        jobs: Number of processes; -1: one for each core. Ignored by the Dask backend, which uses all workers of the
            cluster.
        backend: Of joblib: ``"loky"`` for processes on this machine, ``"dask"`` for a Dask cluster.
        scheduler: Address of the Dask scheduler, e.g. ``"tcp://node1:8786"``.
        command: The command to record in the folder.
        watch: Called after every task with the rows done and in all; returning True ends the run.

    Raises:
        MissingExtra: joblib, pyarrow or distributed are not installed.
        InvalidSetting: The folder holds another comparison, another process works on it, ``jobs`` is 0, or the
            scheduler cannot be reached.
        CannotWrite: The folder cannot be made or written into.
        NoTask: None of the cases has a task for any of the robots.
        Interrupted: Ctrl-C; its ``result`` is the outcome so far, and the same call goes on from there.
    """
    need_parquet()
    check_jobs(jobs)
    one_of("backend", backend, Backend)
    writable(folder, folder=True)
    need_joblib("comparing methods")
    began = perf_counter()
    absent = suite.absent()
    if len(absent) == len(suite.robots_by_name) * len(suite.cases_by_name):
        raise NoTask("; ".join(f"{name}: {reason}" for name, reason in absent.items()))
    manifest = replace(Manifest.from_suite(suite), absent=absent)
    check_manifest(folder, manifest)
    folder.mkdir(parents=True, exist_ok=True)
    writable(folder / ROWS)
    with locked(folder, "comparison"):
        write_manifest(folder, replace(manifest, files=copy_robots(folder, suite)))
        append_environment(folder, command)
        rows = {trial.key: trial for trial in read_rows(folder)}
        before = len(rows)

        def outcome() -> Outcome:
            write_parquet(folder, rows.values())
            errors = Counter(trial.error for trial in rows.values() if trial.error is not None)
            ((error, _),) = errors.most_common(1) or [("", 0)]
            counts = (len(rows), manifest.trials, len(rows) - before, errors.total(), perf_counter() - began)
            return Outcome(folder, *counts, tuple(f"{name}: {why}" for name, why in absent.items()), error)

        try:
            with Pressed() as pressed, Appender(folder) as file:
                for trials in worked(list(suite.work_items(rows.keys(), absent)), jobs, backend, scheduler):
                    pressed.check()
                    file.add(trials)
                    rows.update((trial.key, trial) for trial in trials)
                    label = f"{trials[-1].robot}, {trials[-1].case}"
                    tell(watch, Progress(len(rows), manifest.trials, label=label))
        except KeyboardInterrupt as stop:
            return ended(stop, outcome())
        return outcome()
