"""``pin-metaik stewart forward`` and ``follow``: poses from leg lengths, and legs along a way from a file."""

from __future__ import annotations

from math import radians
from pathlib import Path
from typing import Annotated, Any

import typer

from pin_metaik import stewart
from pin_metaik.cli.stewart.common import File, Json, Six, can_write, pose_of, show_lines
from pin_metaik.cli.versions import print_json
from pin_metaik.errors import InvalidConfiguration
from pin_metaik.stewart.show.notes import in_unit
from pin_metaik.stewart.show.report import Lines, along, of_legs, pose_words
from pin_metaik.stewart.show.values import way_values


def forward(
    file: File,
    coordinates: Annotated[
        list[float],
        typer.Argument(help="The length of each leg (the file's unit) or angle of each servo (degrees)."),
    ],
    start: Annotated[
        Six | None, typer.Option(metavar="X Y Z R P Y", help="The pose to start from; default: level over the base.")
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="All assemblies of six legs instead of the one nearest to the start.")
    ] = False,
    as_json: Json = False,
) -> None:
    """The pose at which the legs have these lengths or servos these angles, or all such poses.

    Exit code 0: found, 1: no pose was found, or it is not proved that these are all; 2: invalid arguments.
    """
    mechanism = stewart.load_mechanism(file)
    geometry = mechanism.geometry
    word, given = mechanism.coordinate.word, len(coordinates)
    if given != geometry.n:
        raise InvalidConfiguration(f"{mechanism.name} has {geometry.n} legs: give as many {word}s, got {given}")
    q = [coordinate * mechanism.coordinate.one for coordinate in coordinates]
    report: dict[str, Any]
    if every:
        found = stewart.all_forward(geometry, q)
        poses, good = found.poses, found.complete
        lines: Lines = [("assemblies", str(found))]
        report = {
            "poses": poses.tolist(),
            "complete": found.complete,
            "solutions": found.solutions,
            "bound": found.bound,
        }
    else:
        near = stewart.forward(geometry, q, None if start is None else pose_of(mechanism, start))
        poses, good = near.poses[near.solved], bool(near.solved.all())
        lines = [("ended", near.status.name.lower().replace("_", " ")), ("steps", str(near.iterations[0]))]
        lines += [("largest error", in_unit(mechanism, near.errors))]
        report = {"poses": poses.tolist(), "status": near.status.name.lower(), "error": float(near.errors[0])}
    if as_json:
        print_json({"name": mechanism.name, f"{word}s": q, **report})
    else:
        what = f"{geometry.actuation.words.legs} at"
        lines += [("pose", pose_words(mechanism, pose)) for pose in poses]
        show_lines(f"{mechanism.name} with {what} {of_legs(mechanism, q)}", lines)
    raise typer.Exit(0 if good else 1)


def follow(
    file: File,
    way: Annotated[
        Path, typer.Argument(help="A .csv file: time (s), x, y, z and, if it rotates, roll, pitch, yaw (degrees).")
    ],
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the legs over time: .csv.")] = None,
    picture: Annotated[Path | None, typer.Option(help="Draw the legs over time: .png, .svg or .pdf.")] = None,
    as_json: Json = False,
) -> None:
    """Move along a trajectory from a file: lengths and rates of the legs, limits, dexterity, singular poses.

    Exit code 0: every pose is within the limits, no leg too fast and no pose singular; 1: otherwise; 2: invalid
    arguments.
    """
    mechanism = stewart.load_mechanism(file)
    can_write(output, picture=picture)
    trajectory = stewart.read_trajectory(way, mechanism.metres, radians(1.0))
    motion = stewart.follow(mechanism.geometry, trajectory, mechanism.limits, mechanism.dexterity)
    if output is not None:
        stewart.save_motion(motion, output, mechanism.metres)
    if picture is not None:
        stewart.save_picture(stewart.draw_motion(motion, mechanism), picture)
    values = way_values(mechanism, trajectory)
    if as_json:
        print_json({"name": mechanism.name, **values})
    else:
        show_lines(f"{mechanism.name} along {way}", along(mechanism, trajectory))
    raise typer.Exit(0 if values["reached"] and not values["too_fast"] and not values["singular"] else 1)
