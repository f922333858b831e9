"""``pin-metaik mobile moving``: a path with times and waits among obstacles that move."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from pin_metaik.cli.mobile.common import (
    Goal,
    Join,
    SceneName,
    Start,
    print_report,
    read_scene,
    say_written,
)
from pin_metaik.cli.options import Json
from pin_metaik.cli.progress import progress_bar
from pin_metaik.figures import picture_file
from pin_metaik.output import writable


def moving(
    scene: SceneName,
    moving_obstacles: Annotated[
        Path,
        typer.Argument(
            help='A .json: a list of {"way": [[time, x, y], ...], "radius": r} or, for a convex polygon around its '
            'origin, {"way": ..., "outline": [[x, y], ...]}; s and m.',
        ),
    ],
    speed: Annotated[float, typer.Option(help="Speed of the robot, m/s.")],
    start: Start = None,
    goal: Goal = None,
    radius: Annotated[float, typer.Option(help="Radius of the robot, m.")] = 0.0,
    margin: Annotated[float, typer.Option(help="Distance to keep in addition to the radius, m.")] = 0.0,
    join: Join = None,
    begin: Annotated[float, typer.Option(help="Start time, s, on the time axis of the obstacles.")] = 0.0,
    cells: Annotated[
        int,
        typer.Option(
            min=0, help="Number of cells along the longer side of the workspace, in whose centres it may turn and wait."
        ),
    ] = 16,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Write times and positions: .csv or .json.")
    ] = None,
    picture: Annotated[Path | None, typer.Option(help="Draw it: .png, .svg or .pdf.")] = None,
    as_json: Json = False,
) -> None:
    """The quickest path over a graph of places, with waits, among obstacles at rest and moving obstacles.

    Exit code 0: found; 2: invalid arguments, or no motion over these places keeps clear.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile import plots

    if picture is not None:
        picture_file(picture)
    if output is not None:
        writable(output)
    movers = mobile.load_moving(moving_obstacles)
    world = read_scene(scene, start, goal, radius + margin)
    problem = mobile.PathProblem.of(world, radius, margin, join)  # type: ignore[arg-type]  # it checks the join itself
    with progress_bar("windows opened") as watch:
        plan = mobile.plan_among_moving(problem, movers, speed, start_time=begin, cells=cells, watch=watch)
    if output is not None and output.suffix.lower() == ".json":
        output.write_text(json.dumps(plan.as_dict(), allow_nan=False), encoding="utf-8")
    elif output is not None:
        plan.write(output)
    if picture is not None:
        plots.save(picture, lambda figure: plots.draw_timed(figure, plan), plots.size_of(world))
    if as_json:
        print_report({"timed_path": plan.as_dict()})
    else:
        console = Console(highlight=False)
        console.print(str(plan), style="green" if plan else "yellow", soft_wrap=True)
        gap = f"{plan.clearance:.4g} m" if plan.moving else "nothing moves"
        console.print(f"  least distance from moving obstacles: {gap}, required: {problem.space.clearance:g} m")
        for t, (x, y) in zip(plan.times, plan.points, strict=True):
            console.print(f"  {t:10.4f} s  ({x:.4f}, {y:.4f})")
    say_written([file for file in (output, picture) if file is not None], as_json)
    raise typer.Exit(0 if plan else 1)
