"""``pin-metaik stewart``: analyse, design and show general Stewart platforms."""

from __future__ import annotations

import json
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
import typer
from rich.console import Console

from pin_metaik import stewart
from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.settings import configured
from pin_metaik.errors import InvalidTarget
from pin_metaik.interrupts import kept
from pin_metaik.optimize import ALGORITHMS
from pin_metaik.output import writable
from pin_metaik.stewart import Mechanism, Verdict
from pin_metaik.stewart.conditioning import NORMS
from pin_metaik.stewart.picture import picture_file
from pin_metaik.stewart.report import (
    Lines,
    along,
    assess,
    at_pose,
    describe,
    notes,
    outcome,
    pose_values,
    values,
    way_values,
)
from pin_metaik.stewart.task import Index

app = typer.Typer(
    help="General Stewart platforms, 3x3 to 6x6: analysis and dimensional optimisation.", no_args_is_help=True
)

File = Annotated[str, typer.Argument(help="A .toml file, or one of: " + ", ".join(stewart.mechanism_names()) + ".")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object, in m and rad.")]
Picture = Annotated[Path | None, typer.Option(help="Also draw it and its workspace: .png, .svg or .pdf.")]
Norm = Annotated[str | None, typer.Option(help=f"Of the dexterity, instead of the file's: {', '.join(NORMS)}.")]
Length = Annotated[str | None, typer.Option(help="Characteristic length: rm, best, or in the file's unit.")]
Cells = Annotated[int | None, typer.Option(min=1, help="Cells along each axis, instead of the file's.")]
INDICES = ", ".join(get_args(Index))


@app.command()
def analyse(
    file: File,
    pose: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(metavar="X Y Z R P Y", help="Also one pose: its unit of length, and degrees Rz(Y) Ry(P) Rx(R)."),
    ] = None,
    to: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(metavar="X Y Z R P Y", help="Also the straight way from --pose to this pose."),
    ] = None,
    seconds: Annotated[float, typer.Option(help="How long that way takes.")] = 1.0,
    cells: Cells = None,
    norm: Norm = None,
    length: Length = None,
    picture: Picture = None,
    as_json: Json = False,
) -> None:
    """Workspace, dexterity and singularities. Ctrl-C keeps what was seen.

    Exit code 0: regular, 1: singular poses in it, or too few legs to hold it; 2: makes no sense, 130: interrupted.
    """
    mechanism = _measured(stewart.load_mechanism(file), norm, length)
    if cells is not None:
        mechanism = replace(mechanism, grid=replace(mechanism.grid, counts=(cells, cells, cells)))
    _can_write(picture=picture)
    T = None if pose is None else _pose(mechanism, pose)
    if to is not None and T is None:
        raise InvalidTarget("a way needs both ends: give --pose as well as --to")
    way = None if to is None or T is None else stewart.straight(T, _pose(mechanism, to), seconds)
    with stewart.progress_bar("surveying") as watch:
        workspace = kept(lambda: mechanism.survey(watch=watch))
    if picture is not None:
        stewart.save_picture(stewart.draw(mechanism, workspace, T), picture)
    if as_json:
        report: dict[str, Any] = values(mechanism, workspace)
        if T is not None:
            report["at_pose"] = pose_values(mechanism, T)
        if way is not None:
            report["along_way"] = way_values(mechanism, way)
        print(json.dumps(report, allow_nan=False))
    else:
        _show(mechanism.name, describe(mechanism))
        if T is not None:
            _show("at the pose", at_pose(mechanism, T))
        if way is not None:
            _show("along the way", along(mechanism, way))
        _show("workspace", assess(mechanism, workspace))
    if not workspace.complete:
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if workspace.verdict is Verdict.REGULAR else 1)


@app.command()
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
    evaluations: Annotated[int | None, typer.Option(min=1, help="Designs to look at.")] = None,
    rng: Annotated[int | None, typer.Option(min=0, help="Seed of every random choice.")] = None,
    index: Annotated[str | None, typer.Option(help=f"What dexterity is: {INDICES}.")] = None,
    threshold: Annotated[float | None, typer.Option(help="Of nu, for lci.")] = None,
    weights: Annotated[
        tuple[float, float] | None, typer.Option(metavar="D W", help="Of dexterity and workspace.")
    ] = None,
    from_current: Annotated[bool | None, typer.Option(help="Start from the mechanism as it is, too.")] = None,
    cells: Cells = None,
    norm: Norm = None,
    length: Length = None,
    history: Annotated[Path | None, typer.Option(help="Write designs looked at and best fitness: .csv.")] = None,
    picture: Picture = None,
    as_json: Json = False,
) -> None:
    """Optimise its dimensions; options replace settings of the file. Ctrl-C keeps the best so far.

    Another algorithm searches with as many agents as the file's. What is written is written before anything is printed.

    Exit code 0: a design was found, 1: none that can be built, 2: makes no sense, 130: interrupted.
    """
    mechanism = _measured(stewart.load_mechanism(file), norm, length)
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
    _can_write(output, history, picture=picture)
    with stewart.progress_bar("designing") as watch:
        found = kept(lambda: stewart.design(mechanism, watch=watch))
    workspace = found.mechanism.survey() if found.success else None
    if history is not None:
        np.savetxt(history, found.history, "%.17g", ",", header="designs,fitness", comments="")
    if output is not None and found.success:
        stewart.save_mechanism(found.mechanism, output)
    if picture is not None and workspace is not None:
        stewart.save_picture(stewart.draw(found.mechanism, workspace), picture)
    if as_json:
        score = None if found.score is None else vars(found.score)
        report = {"success": found.success, "ended": found.search.status.value, "score": score}
        report["workspace"] = None if workspace is None else values(found.mechanism, workspace)
        report["mechanism"] = stewart.to_toml(found.mechanism) if found.success else None
        print(json.dumps(report, allow_nan=False))
    else:
        _show("design", outcome(found))
        if workspace is not None:
            _show(found.mechanism.name, describe(found.mechanism))
            _show("workspace", assess(found.mechanism, workspace))
    if found.interrupted:
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if found.success else 1)


@app.command()
def show(
    file: File,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Draw it: .png, .svg or .pdf.")] = None,
    workspace: Annotated[bool, typer.Option(help="Draw its workspace beside it.")] = True,
    urdf: Annotated[Path | None, typer.Option(help="Write its URDF, loops open.")] = None,
    toml: Annotated[bool, typer.Option("--toml", help="Print it as TOML instead, with every setting.")] = False,
) -> None:
    """Its dimensions and limits; draw it, or write it for other tools."""
    mechanism = stewart.load_mechanism(file)
    _can_write(urdf, picture=output)
    if urdf is not None:
        stewart.save_urdf(mechanism, urdf)
    if output is not None:
        with stewart.progress_bar("surveying") as watch:
            found = mechanism.survey(watch=watch) if workspace else None
        stewart.save_picture(stewart.draw(mechanism, found), output)
    if toml:
        print(stewart.to_toml(mechanism), end="")
    else:
        _show(mechanism.name, [*describe(mechanism), *_words(mechanism)])


def _measured(mechanism: Mechanism, norm: str | None, length: str | None) -> Mechanism:
    """With another norm or characteristic length."""
    dexterity = mechanism.dexterity
    if norm is not None:
        dexterity = replace(dexterity, norm=norm)  # type: ignore[arg-type]  # the settings say whether it is one
    if length is not None:
        dexterity = replace(dexterity, length=_length(mechanism, length))
    return replace(mechanism, dexterity=dexterity)


def _length(mechanism: Mechanism, text: str) -> float | Literal["rm", "best"]:
    try:
        return float(text) * mechanism.metres
    except ValueError:
        return text  # type: ignore[return-value]  # the settings say whether it is one of theirs


def _pose(mechanism: Mechanism, pose: tuple[float, ...]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    x, y, z, *rpy = pose
    return stewart.pose_at([value * mechanism.metres for value in (x, y, z)], [radians(angle) for angle in rpy])


def _words(mechanism: Mechanism) -> Lines:
    own = [(key, text) for key in ("description", "source") if (text := getattr(mechanism, key))]
    return own + [("note", text) for text in notes(mechanism)]


def _show(title: str, lines: Lines) -> None:
    console = Console(highlight=False)
    console.print(title, style="bold", markup=False)
    for label, value in lines:
        console.print(f"  {label:20} {value}", markup=False, soft_wrap=True)


def _can_write(*files: Path | None, picture: Path | None = None) -> None:
    """Look whether files can be written, and a picture drawn, before the work that they are for."""
    for file in files:
        if file is not None:
            writable(file)
    if picture is not None:
        picture_file(picture)
