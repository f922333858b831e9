"""``pin-metaik mobile curve``: curves of bounded curvature for cars, in the open or among obstacles."""

from __future__ import annotations

from math import degrees, radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from pin_metaik.cli.mobile.common import Pose, print_report, read_scene, say_written
from pin_metaik.cli.options import Json
from pin_metaik.errors import InvalidSetting
from pin_metaik.figures import picture_file
from pin_metaik.output import writable

if TYPE_CHECKING:
    from pin_metaik.mobile import Curve, Footprint


def curve(
    turning_radius: Annotated[float, typer.Option(help="Least turning radius of the vehicle, m.")],
    scene: Annotated[str | None, typer.Argument(help="Obstacles; default: the open plane.")] = None,
    start: Annotated[
        Pose | None,
        typer.Option("--from", metavar="X Y HEADING", help="m and degrees; default: the scene's, any heading."),
    ] = None,
    goal: Annotated[
        Pose | None,
        typer.Option("--to", metavar="X Y HEADING", help="m and degrees; default: the scene's, any heading."),
    ] = None,
    reverse: Annotated[bool, typer.Option("--reverse", help="The vehicle may also drive backwards.")] = False,
    footprint: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="LENGTH WIDTH", help="Length and width of a rectangular vehicle, m; default: a point."),
    ] = None,
    behind: Annotated[
        float | None, typer.Option(help="How much of its length is behind its reference point, m; default: half.")
    ] = None,
    margin: Annotated[
        float, typer.Option(help="Distance that the path for the curve keeps in addition to half the width, m.")
    ] = 0.1,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write its poses: .csv.")] = None,
    picture: Annotated[Path | None, typer.Option(help="Draw it: .png, .svg or .pdf.")] = None,
    ros: Annotated[Path | None, typer.Option(help="Write a nav_msgs/Path (.yaml or .json).")] = None,
    as_json: Json = False,
) -> None:
    """A curve for a car: the shortest (Dubins; Reeds and Shepp) or, among obstacles, a short one that is free.

    Exit code 0: found; 2: invalid arguments, or every curve tried meets an obstacle.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile import plots
    from pin_metaik.mobile.ros import ros_file

    if picture is not None:
        picture_file(picture)
    if output is not None:
        writable(output)
    if ros is not None:
        ros_file(ros)
    outline = None if footprint is None else mobile.Footprint.rectangle(*footprint, behind)
    if behind is not None and outline is None:
        raise InvalidSetting("--behind is about a rectangle: give --footprint LENGTH WIDTH, too")
    obstacles: Any = ()
    if scene is None:
        if start is None or goal is None:
            raise InvalidSetting("without a SCENE both ends are needed: give --from and --to X Y HEADING")
        found = mobile.shortest_curve(_pose(start), _pose(goal), turning_radius, reverse=reverse)
    else:
        world = read_scene(scene, start and start[:2], goal and goal[:2], margin)
        obstacles = world.obstacles
        half = 0.0 if footprint is None else footprint[1] / 2
        path = mobile.PathProblem.of(world, half, margin).optimum
        found = mobile.curve_through(
            path,
            turning_radius,
            obstacles,
            footprint=outline,
            start_heading=None if start is None else radians(start[2]),
            goal_heading=None if goal is None else radians(goal[2]),
            reverse=reverse,
        )
    files = [file for file in (output, picture, ros) if file is not None]
    if output is not None:
        found.write(output)
    if picture is not None:
        plots.save(picture, lambda figure: plots.draw_curve(figure, found, obstacles, outline), (7.0, 6.0))
    if ros is not None:
        mobile.write_nav_path(ros, found)
    if as_json:
        print_report({"curve": _values(found, outline)})
    else:
        _show(found)
    say_written(files, as_json)


def _pose(given: Pose) -> Pose:
    return given[0], given[1], radians(given[2])


def _values(found: Curve, outline: Footprint | None) -> dict[str, Any]:
    return {
        "word": found.word,
        "lengths": list(found.lengths),
        "length": found.length,
        "radius": found.radius,
        "start": list(found.start),
        "end": list(found.end),
        "cusps": found.cusps.tolist(),
        "footprint": None if outline is None else outline.corners.tolist(),
    }


def _show(found: Curve) -> None:
    console = Console(highlight=False)
    cusps = len(found.cusps)
    turns = "never" if not cusps else "once" if cusps == 1 else f"{cusps} times"
    console.print(f"{found.word or 'no motion'}: {found.length:.6g} m, reverses {turns}", style="green")
    names = {"L": "left", "R": "right", "S": "straight"}
    for letter, length in zip(found.word, found.lengths, strict=True):
        turned = "" if letter == "S" else f", through {degrees(abs(length) / found.radius):.5g} degrees"
        backwards = " backwards" if length < 0 else ""
        console.print(f"  {names[letter]:9}{abs(length):10.6g} m{turned}{backwards}")
