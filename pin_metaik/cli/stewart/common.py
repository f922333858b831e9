"""Common parts of the commands about Stewart platforms: options, reading a file with them, showing lines."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated, Literal, TypeAlias, get_args

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console

from pin_metaik import stewart
from pin_metaik.figures import picture_file
from pin_metaik.output import writable
from pin_metaik.stewart import Mechanism
from pin_metaik.stewart.kinematics.conditioning import NORMS
from pin_metaik.stewart.mechanism.task import Index
from pin_metaik.stewart.show.notes import notes
from pin_metaik.stewart.show.report import Lines

File = Annotated[str, typer.Argument(help="A .toml file, or one of: " + ", ".join(stewart.mechanism_names()) + ".")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object, in m and rad.")]
Picture = Annotated[Path | None, typer.Option(help="Also draw it and its workspace: .png, .svg or .pdf.")]
Norm = Annotated[str | None, typer.Option(help=f"Norm of the dexterity, instead of the file's: {', '.join(NORMS)}.")]
Length = Annotated[str | None, typer.Option(help="Characteristic length: rm, best, or in the file's unit.")]
Six: TypeAlias = tuple[float, float, float, float, float, float]
Cells = Annotated[int | None, typer.Option(min=1, help="Cells along each axis, instead of the file's.")]
INDICES = ", ".join(get_args(Index))


def measured(mechanism: Mechanism, norm: str | None, length: str | None) -> Mechanism:
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


def pose_of(mechanism: Mechanism, numbers: tuple[float, ...]) -> NDArray[np.float64]:
    """The pose (4, 4) that x, y, z in the mechanism's unit and roll, pitch, yaw in degrees stand for."""
    x, y, z, *rpy = numbers
    return stewart.pose_at([value * mechanism.metres for value in (x, y, z)], [radians(angle) for angle in rpy])


def words(mechanism: Mechanism) -> Lines:
    """The description of a mechanism, and remarks on its figures."""
    own = [(key, text) for key in ("description", "source") if (text := getattr(mechanism, key))]
    return own + [("note", text) for text in notes(mechanism)]


def show_lines(title: str, lines: Lines) -> None:
    """Labelled lines below a title."""
    console = Console(highlight=False)
    console.print(title, style="bold", markup=False)
    for label, value in lines:
        console.print(f"  {label:20} {value}", markup=False, soft_wrap=True)


def can_write(*files: Path | None, picture: Path | None = None) -> None:
    """Look whether files can be written, and a picture drawn, before the work that they are for."""
    for file in files:
        if file is not None:
            writable(file)
    if picture is not None:
        picture_file(picture)
