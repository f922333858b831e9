"""``pin-metaik robots`` and ``pin-metaik urdf``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from pin_metaik.errors import InvalidSetting
from pin_metaik.output import writable
from pin_metaik.robots import load_robot, robot_names, write_urdfs


def robots(
    words: Annotated[list[str] | None, typer.Argument(help="Only those that hold all of these words.")] = None,
) -> None:
    """List the robots that can be loaded by name."""
    table = Table("robot", "from", "joints", "default frame", box=None)
    for robot in robot_names():
        if not all(word.lower() in f"{robot.name} {robot.source} {robot.frame}".lower() for word in words or ()):
            continue
        table.add_row(robot.name, robot.source, str(robot.dof), robot.frame)
    Console().print(table)


def urdf(
    robot: Annotated[str | None, typer.Argument(help="A robot's name, or the path of a DH table (.toml).")] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="File to write; default: print it.")] = None,
    every: Annotated[bool, typer.Option("--all", help="Write the whole catalogue to a folder: -o, or urdf/.")] = False,
) -> None:
    """Write the URDF of a robot by its name, or of your own DH table."""
    if every == (robot is not None):
        raise InvalidSetting("name one robot, or give --all for the whole catalogue")
    if robot is None:
        for path in write_urdfs(output or Path("urdf")):
            print(path)
        return
    if output is not None:
        writable(output)
    text = load_robot(robot).urdf
    if output is None:
        print(text, end="")
    else:
        output.write_text(text, encoding="utf-8")
        print(output)
