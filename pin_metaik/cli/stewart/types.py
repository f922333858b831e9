"""``pin-metaik stewart types``: a design of every type of platform for one task, side by side."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from pin_metaik import stewart
from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.stewart.common import File, Json
from pin_metaik.cli.versions import print_json
from pin_metaik.output import writable


def types(
    file: File,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[TYPE]...", help=f"Default: {', '.join(stewart.NAMED)}; with servos 6x3 to 6x6."),
    ] = None,
    evaluations: Annotated[int | None, typer.Option(min=1, help="Number of designs to evaluate in each run.")] = None,
    runs: Annotated[int, typer.Option(min=1, help="Number of runs for each type, each with its own seed.")] = 1,
    rng: Annotated[int | None, typer.Option(min=0, help="The first seed.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder for the best design of each type: .toml.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Design every type of platform for the task of a file, and compare the designs.

    Exit code 0: each has a design, 1: some have none, 2: invalid arguments, 130: interrupted.
    """
    mechanism = stewart.load_mechanism(file)
    if evaluations is not None and mechanism.task is not None:
        mechanism = replace(mechanism, task=replace(mechanism.task, evaluations=evaluations))
    if output is not None:
        writable(output, folder=True)
    with progress_bar("designing") as watch:
        found = stewart.compare_types(mechanism, names or None, runs, rng=rng, watch=watch)
    if output is not None:
        output.mkdir(parents=True, exist_ok=True)
        for one in found:
            if one.designed.success:
                stewart.save_mechanism(one.designed.mechanism, output / f"{one.type}.toml")
    rows = [one.as_dict() for one in found]
    if as_json:
        print_json({"types": rows})
    else:
        _show(rows)
    if any(one.designed.interrupted for one in found):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if all(one.designed.success for one in found) else 1)


def _show(rows: list[dict[str, object]]) -> None:
    columns = {"type": "type", "fitness": "fitness", "dexterity": "dexterity", "workspace": "V / cube^3"}
    columns |= {"base_radius": "rb m", "platform_radius": "rm m"}
    table = Table(*columns.values())
    for row in rows:
        cells = (row[name] for name in columns)
        table.add_row(*(f"{cell:.4f}" if isinstance(cell, float) else str(cell or "-") for cell in cells))
    Console(highlight=False).print(table)
