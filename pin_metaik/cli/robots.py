"""``pin-metaik robots`` and ``pin-metaik urdf``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from pin_metaik.cli import complete
from pin_metaik.cli.options import Json
from pin_metaik.cli.versions import print_json
from pin_metaik.errors import InvalidSetting
from pin_metaik.kinematics import Chain
from pin_metaik.output import writable
from pin_metaik.robots import RobotName, load_robot, write_urdfs
from pin_metaik.robots.robot import named_robots

WIDE = 150  # columns for files and pipes, which have no width
MANY = 9
"""Coordinates from which on little is proved unreachable; see ``solve_ik``."""


def robots(
    words: Annotated[
        list[str] | None, typer.Argument(help="Show only robots whose line contains all of these words.")
    ] = None,
    as_json: Json = False,
) -> None:
    """List the robots that can be loaded by name: joints, tip, closed form, and what is proved of a pose.

    There are two numbers of joints: all of the model, and those that move the tip. The last columns name the methods
    (`closed form`, `boxes`, `count`) that prove a pose unreachable, or prove that all solutions of a pose are found.
    """
    rows = [
        {"robot": name.name, "source": name.source, **known(name, Chain(robot.model, robot.frame))}
        for name, robot in named_robots()
        if all(word.lower() in f"{name.name} {name.source} {name.frame}".lower() for word in words or ())
    ]
    if as_json:
        print_json({"robots": rows})
        return
    headings = ("robot", "from", "joints", "to the tip", "tip", "closed form", "unreachable", "all solutions")
    table = Table(*headings, box=None)
    for row in rows:
        table.add_row(*("yes" if value is True else "" if value is False else str(value) for value in row.values()))
    Console(width=None if sys.stdout.isatty() else WIDE).print(table)


def known(name: RobotName, chain: Chain) -> dict[str, object]:
    """Numbers of joints, tip, whether there is a closed form, and what proves the two kinds of answers."""
    closed = len(chain.form) > 0
    unreachable = "closed form" if closed else "boxes" if chain.n < MANY else "little"
    complete_by = {6: "count or boxes", 7: "boxes, as curves"}
    every = "closed form" if closed else "boxes" if chain.n < 6 else complete_by.get(chain.n, "none")
    return {
        "joints": name.dof,
        "joints_to_tip": chain.n,
        "tip": name.frame,
        "closed_form": closed,
        "unreachable_proved_by": unreachable,
        "all_solutions_proved_by": every,
    }


def urdf(
    robot: Annotated[
        str | None,
        typer.Argument(help="A robot's name, or the path of a DH table (.toml).", autocompletion=complete.robots),
    ] = None,
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
