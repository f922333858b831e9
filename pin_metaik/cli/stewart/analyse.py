"""``pin-metaik stewart analyse``: workspace, dexterity, singularities, a pose, a straight way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from pin_metaik import stewart
from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.stewart.common import (
    Cells,
    File,
    Json,
    Length,
    Norm,
    Picture,
    Six,
    can_write,
    measured,
    pose_of,
    show_lines,
)
from pin_metaik.cli.versions import print_json
from pin_metaik.errors import InvalidTarget
from pin_metaik.interrupts import kept
from pin_metaik.stewart import Verdict
from pin_metaik.stewart.files.points import points_file
from pin_metaik.stewart.show.report import along, assess, at_pose, describe
from pin_metaik.stewart.show.values import pose_values, values, way_values


def analyse(
    file: File,
    pose: Annotated[
        Six | None,
        typer.Option(
            metavar="X Y Z R P Y",
            help="Also analyse one pose: in the file's unit of length, and degrees Rz(Y) Ry(P) Rx(R).",
        ),
    ] = None,
    to: Annotated[
        Six | None,
        typer.Option(metavar="X Y Z R P Y", help="Also analyse the straight motion from --pose to this pose."),
    ] = None,
    seconds: Annotated[float, typer.Option(help="Duration of that motion, s.")] = 1.0,
    cells: Cells = None,
    norm: Norm = None,
    length: Length = None,
    picture: Picture = None,
    points: Annotated[
        Path | None, typer.Option(help="Also write the positions reached, with their dexterity: .csv or .ply.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Analyse workspace, dexterity and singularities. Ctrl-C keeps what was surveyed.

    Exit code 0: no singular poses, 1: singular poses, or too few legs to hold the platform; 2: invalid
    arguments, 130: interrupted.
    """
    mechanism = measured(stewart.load_mechanism(file), norm, length)
    if cells is not None:
        mechanism = replace(mechanism, grid=replace(mechanism.grid, counts=(cells, cells, cells)))
    can_write(picture=picture)
    if points is not None:
        points_file(points)
    T = None if pose is None else pose_of(mechanism, pose)
    if to is not None and T is None:
        raise InvalidTarget("a motion needs both ends: give --pose as well as --to")
    way = None if to is None or T is None else stewart.straight(T, pose_of(mechanism, to), seconds)
    with progress_bar("surveying") as watch:
        workspace = kept(lambda: mechanism.survey(watch=watch))
    if points is not None:
        stewart.save_points(workspace, points, mechanism.metres)
    if picture is not None:
        stewart.save_picture(stewart.draw(mechanism, workspace, T), picture)
    if as_json:
        report: dict[str, Any] = values(mechanism, workspace)
        if T is not None:
            report["at_pose"] = pose_values(mechanism, T)
        if way is not None:
            report["along_way"] = way_values(mechanism, way)
        print_json(report)
    else:
        show_lines(mechanism.name, describe(mechanism))
        if T is not None:
            show_lines("at the pose", at_pose(mechanism, T))
        if way is not None:
            show_lines("along the way", along(mechanism, way))
        show_lines("workspace", assess(mechanism, workspace))
    if not workspace.complete:
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if workspace.verdict is Verdict.REGULAR else 1)
