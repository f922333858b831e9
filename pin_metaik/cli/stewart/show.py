"""``pin-metaik stewart show`` and ``new``: a mechanism printed, drawn, written for other tools, or begun."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from typing import Annotated

import typer

from pin_metaik import stewart
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.stewart.common import File, can_write, show_lines, words
from pin_metaik.stewart.show.report import describe
from pin_metaik.units import LENGTHS


def show(
    file: File,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Draw it: .png, .svg or .pdf.")] = None,
    workspace: Annotated[bool, typer.Option(help="Draw its workspace beside it.")] = True,
    above: Annotated[Path | None, typer.Option(help="Draw it from above: .png, .svg or .pdf.")] = None,
    urdf: Annotated[Path | None, typer.Option(help="Write its URDF, with open loops.")] = None,
    toml: Annotated[bool, typer.Option("--toml", help="Print it as TOML instead, with every setting.")] = False,
) -> None:
    """Show a mechanism's dimensions and limits; draw it, or write it for other tools."""
    mechanism = stewart.load_mechanism(file)
    can_write(urdf, picture=output)
    can_write(picture=above)
    if urdf is not None:
        stewart.save_urdf(mechanism, urdf)
    if output is not None:
        with progress_bar("surveying") as watch:
            found = mechanism.survey(watch=watch) if workspace else None
        stewart.save_picture(stewart.draw(mechanism, found), output)
    if above is not None:
        stewart.save_picture(stewart.draw_above(mechanism), above)
    if toml:
        print(stewart.to_toml(mechanism), end="")
    else:
        show_lines(mechanism.name, [*describe(mechanism), *words(mechanism)])


def new(
    type: Annotated[
        str, typer.Argument(metavar="TYPE", help="Number of joints of base and platform: 3x3, 4x3 ... 6x6.")
    ],
    base: Annotated[float, typer.Option(help="Radius of the base's circle, in the unit.")] = 200.0,
    platform: Annotated[float, typer.Option(help="Radius of the platform's circle.")] = 100.0,
    lengths: Annotated[
        tuple[float, float], typer.Option(metavar="MIN MAX", help="Length of a leg, retracted and extended.")
    ] = (250.0, 350.0),
    servos: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="HORN ROD", help="Use servos instead of linear actuators, with horns and rods of these lengths."
        ),
    ] = None,
    legs: Annotated[int, typer.Option(min=3, max=6, help="Number of legs.")] = 6,
    unit: Annotated[str, typer.Option(help="Unit of length: mm, cm or m.")] = "mm",
    name: Annotated[str | None, typer.Option(help="Its name; default: the type.")] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write it: .toml; default: print it.")] = None,
) -> None:
    """Make a new mechanism of a type: a .toml file to edit, analyse and design, with ranges of radii and angles."""
    can_write(output)
    length = LENGTHS.get(unit, LENGTHS["m"])  # the mechanism says which units there are
    dimensions = (length.read(Decimal(str(number))) for number in (base, platform, *(servos or lengths)))
    begin = stewart.new_servo_mechanism if servos else stewart.new_mechanism
    mechanism = begin(type, *dimensions, name=name, legs=legs, unit=unit)
    if output is None:
        print(stewart.to_toml(mechanism), end="")
    else:
        stewart.save_mechanism(mechanism, output)
        show_lines(mechanism.name, [*describe(mechanism), ("written", str(output))])
