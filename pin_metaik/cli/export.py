"""``pin-metaik export``: an arm's inverse kinematics as a file of C or Python that needs nothing else."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pin_metaik.cli.options import split
from pin_metaik.export import write_export
from pin_metaik.kinematics import Chain
from pin_metaik.robots import load_robot


def export(
    robot: Annotated[str, typer.Argument(help="A robot's name (see `robots`), or the path of a .urdf or DH .toml.")],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="File to write: arm.c or arm.py.")],
    frame: Annotated[str | None, typer.Option(help="The frame to place; default: the robot's tip.")] = None,
    lock: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT", help="A joint that keeps its value of the neutral configuration; may be repeated."
        ),
    ] = None,
) -> None:
    """Write standalone C that computes all configurations of a six-joint arm for a pose; Python with a closed form."""
    loaded = load_robot(robot)
    chain = Chain(loaded.model, loaded.frame if frame is None else frame, locked=split(lock or ()))
    write_export(chain, out)
    print(f"wrote {out}: all configurations of {chain.model.name} for a pose of {chain.frames[0]}")
