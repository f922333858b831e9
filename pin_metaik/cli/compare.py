"""``pin-metaik compare``, ``report`` and ``replay``: methods on hard cases, and the report on them."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from shlex import join
from typing import Annotated

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.options import Json, split
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.versions import print_json
from pin_metaik.compare import CASES, Suite, write_report
from pin_metaik.compare import compare as run
from pin_metaik.compare import replay as again
from pin_metaik.interrupts import kept


class Backend(StrEnum):
    """Where the work is done."""

    LOKY = "loky"
    DASK = "dask"


def compare(
    robot: Annotated[list[str], typer.Option(help="Robots: names, or paths of .urdf and DH .toml files.")],
    out: Annotated[
        Path,
        typer.Option(
            file_okay=False, help="Folder for the rows; if it holds some already, the comparison goes on with them."
        ),
    ],
    cases: Annotated[list[str], typer.Option(help=f"{', '.join(CASES)}, or module:object.")],
    methods: Annotated[
        list[str],
        typer.Option(
            help="default; REFINER, REFINER+restarts, SEEDER or SEEDER+REFINER, e.g. lm, lm+restarts, gwo, gwo+dls; "
            "ikpy, pink, trac_ik or toolbox if installed; or module:object."
        ),
    ],
    tasks: Annotated[
        int, typer.Option("--tasks", "--targets", min=1, help="Number of tasks of each case for each robot.")
    ] = 100,
    seeds: Annotated[int, typer.Option(min=1, help="Number of repetitions of each method on each task.")] = 1,
    budget: Annotated[int, typer.Option(min=1, help="Kernel evaluations for each target.")] = 5000,
    rng: Annotated[int, typer.Option(min=0, help="Seed of every random choice.")] = 0,
    jobs: Annotated[
        int, typer.Option(help="Number of processes; -1: one for each core. The rows do not depend on it.")
    ] = 1,
    backend: Annotated[
        Backend, typer.Option(help="Processes on this machine (loky), or a Dask cluster (dask).")
    ] = Backend.LOKY,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of the Dask scheduler, e.g. tcp://localhost:8786.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare methods on hard cases at equal budgets. After Ctrl-C the same command goes on."""
    sys.path.insert(0, "")  # module:object may be in the folder one is in
    suite = Suite(split(robot), split(cases), split(methods), tasks, seeds, budget, rng)
    command = join(["pin-metaik", *sys.argv[1:]])
    with progress_bar("comparing") as watch:
        outcome = kept(
            lambda: run(suite, out, jobs=jobs, backend=backend.value, scheduler=scheduler, command=command, watch=watch)
        )
    if as_json:
        print_json(outcome.as_dict())
    else:
        console = Console(highlight=False)
        console.print(str(outcome), style="yellow" if outcome.partial else None, markup=False, soft_wrap=True)
        console.print(f"next: pin-metaik report {out}", markup=False, soft_wrap=True)
    raise typer.Exit(INTERRUPTED if outcome.partial else 0)


def report(
    folder: Annotated[Path, typer.Argument(help="Folder of a comparison, finished or not.")], as_json: Json = False
) -> None:
    """Write the report on a comparison: one HTML page, and Markdown with tables and figures beside it."""
    with Console(stderr=True).status(f"writing the report on {folder} ..."):
        page, markdown, *others = write_report(folder)
    if as_json:
        print_json({"page": str(page), "files": [str(file) for file in (markdown, *others)]})
        return
    print(page)
    print(markdown, f"and {len(others)} tables and figures")


def replay(
    folder: Annotated[Path, typer.Argument(help="Folder of a comparison.")],
    trial: Annotated[str, typer.Argument(help="ROBOT/CASE/TASK/METHOD/SEED, as the report lists them.")],
    as_json: Json = False,
) -> None:
    """Run one trial of a comparison again. Exit code 0: its row is the same, 1: it differs."""
    sys.path.insert(0, "")
    replayed = again(folder, trial)
    if as_json:
        print_json(replayed.as_dict())
    else:
        console = Console(highlight=False)
        for line in replayed.lines():
            console.print(line, markup=False, soft_wrap=True)
    raise typer.Exit(0 if replayed.same else 1)
