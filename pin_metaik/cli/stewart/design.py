"""``pin-metaik stewart design``: dimensional optimisation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from pin_metaik import stewart
from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.settings import configured
from pin_metaik.cli.stewart.common import (
    INDICES,
    Cells,
    File,
    Json,
    Length,
    Norm,
    Picture,
    can_write,
    measured,
    show_lines,
)
from pin_metaik.cli.versions import print_json
from pin_metaik.interrupts import kept
from pin_metaik.optimize import ALGORITHMS
from pin_metaik.stewart.show.report import assess, describe, outcome
from pin_metaik.stewart.show.values import values


def design(
    file: File,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the mechanism found: .toml.")] = None,
    algorithm: Annotated[str | None, typer.Option(help=f"Instead of the file's: {', '.join(ALGORITHMS)}.")] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="A setting of the algorithm, such as agents=60. May be repeated."
        ),
    ] = None,
    evaluations: Annotated[int | None, typer.Option(min=1, help="Number of designs to evaluate.")] = None,
    rng: Annotated[int | None, typer.Option(min=0, help="Seed of every random choice.")] = None,
    index: Annotated[str | None, typer.Option(help=f"Index of dexterity: {INDICES}.")] = None,
    threshold: Annotated[float | None, typer.Option(help="Least nu of a dexterous pose, for lci.")] = None,
    weights: Annotated[
        tuple[float, float] | None, typer.Option(metavar="D W", help="Weights of dexterity and workspace.")
    ] = None,
    from_current: Annotated[bool | None, typer.Option(help="Also start from the present mechanism.")] = None,
    cells: Cells = None,
    norm: Norm = None,
    length: Length = None,
    history: Annotated[Path | None, typer.Option(help="Write designs evaluated and best fitness: .csv.")] = None,
    picture: Picture = None,
    as_json: Json = False,
) -> None:
    """Optimise a mechanism's dimensions; options replace settings of the file. Ctrl-C keeps the best so far.

    Another --algorithm has as many agents as that of the file. Files are written before anything is printed.

    Exit code 0: a feasible design was found, 1: none was, 2: invalid arguments, 130: interrupted.
    """
    mechanism = measured(stewart.load_mechanism(file), norm, length)
    given = {
        "evaluations": evaluations,
        "seed": rng,
        "index": index,
        "threshold": threshold,
        "weights": weights,
        "from_current": from_current,
    }
    if mechanism.task is not None:
        changed: dict[str, Any] = {key: value for key, value in given.items() if value is not None}
        if algorithm is not None or settings:
            changed["algorithm"] = configured(mechanism.task.algorithm, algorithm, settings or ())
        if cells is not None:
            changed["grid"] = replace(mechanism.task.grid, counts=(cells, cells, cells))
        mechanism = replace(mechanism, task=replace(mechanism.task, **changed))
    can_write(output, history, picture=picture)
    with progress_bar("designing") as watch:
        found = kept(lambda: stewart.design(mechanism, watch=watch))
    workspace = found.mechanism.survey() if found.success else None
    if history is not None:
        np.savetxt(history, found.history, "%.17g", ",", header="designs,fitness", comments="")
    if output is not None and found.success:
        stewart.save_mechanism(found.mechanism, output)
    if picture is not None and workspace is not None:
        stewart.save_picture(stewart.draw(found.mechanism, workspace), picture)
    if as_json:
        report = found.as_dict()
        report["workspace"] = None if workspace is None else values(found.mechanism, workspace)
        report["mechanism"] = stewart.to_toml(found.mechanism) if found.success else None
        print_json(report)
    else:
        show_lines("design", outcome(found))
        if workspace is not None:
            show_lines(found.mechanism.name, describe(found.mechanism))
            show_lines("workspace", assess(found.mechanism, workspace))
    if found.interrupted:
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if found.success else 1)
