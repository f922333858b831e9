"""``pin-metaik mobile show``: a scene before anything is planned in it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from pin_metaik.cli.mobile.common import (
    Cells,
    Goal,
    Join,
    Resolution,
    SceneName,
    Specks,
    Start,
    Threshold,
    Unknown,
    print_report,
    read_scene,
    say_written,
)
from pin_metaik.cli.options import Json
from pin_metaik.figures import picture_file
from pin_metaik.output import writable

if TYPE_CHECKING:
    from pin_metaik.mobile import PathProblem


def show(
    scene: SceneName,
    start: Start = None,
    goal: Goal = None,
    radius: Annotated[
        float, typer.Option(help="Radius of the robot: obstacles grown by it are dotted in the picture.")
    ] = 0.0,
    join: Join = None,
    unknown: Unknown = None,
    threshold: Threshold = None,
    specks: Specks = None,
    resolution: Resolution = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Draw it: .png, .svg or .pdf.")] = None,
    save: Annotated[
        Path | None, typer.Option(help="Write the scene as .json, to edit, e.g. one made from a map.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Show a scene before planning: start, goal, obstacles, whether a robot fits; draw it, or write it.

    Exit code 0: there is a path for the robot, 1: there is none; 2: invalid arguments.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile import plots

    if output is not None:
        picture_file(output)
    if save is not None:
        writable(save)
    world = read_scene(scene, start, goal, radius, Cells(unknown, threshold, specks, resolution))
    problem, why = None, ""
    try:
        problem = mobile.PathProblem.of(world, radius, join=join)  # type: ignore[arg-type]  # it checks the join itself
        problem.optimum  # noqa: B018  # raises where there is no way
    except (mobile.Blocked, mobile.NoPath) as error:
        why = str(error)
    if output is not None:
        space = problem.space if problem is not None else mobile.FreeSpace.of(world, radius)
        plots.save(output, lambda figure: plots.draw_scene(figure.subplots(), world, space.region if radius else None))
    if save is not None:
        save.write_text(json.dumps(world.as_dict()), encoding="utf-8")
    facts = _facts(world, problem, why)
    if as_json:
        print_report({"scene": world.name, **facts})
    else:
        console = Console(highlight=False)
        console.print(world.name, style="bold", markup=False)
        for key, value in facts.items():
            text = "none: a plane without end" if value is None else value
            console.print(f"  {key.replace('_', ' '):18} {text}", markup=False, soft_wrap=True)
    say_written([file for file in (output, save) if file is not None], as_json)
    raise typer.Exit(1 if why else 0)


def _facts(world: Any, problem: PathProblem | None, why: str) -> dict[str, Any]:
    import shapely

    area = shapely.union_all(world.obstacles).area
    concave = sum(each.area < (1 - 1e-9) * each.convex_hull.area for each in world.obstacles)
    facts: dict[str, Any] = {
        "start": list(world.start),
        "goal": list(world.goal),
        "walls": None if world.bounds is None else list(world.bounds),
        "obstacles": len(world.obstacles),
        "concave_ones": int(concave),
        "corners": int(shapely.get_num_coordinates(world.obstacles).sum()) - len(world.obstacles),
        "covered_area": float(area),
    }
    if problem is not None and not why:
        facts["shortest_path"] = problem.optimum.length
        facts["bends"] = len(problem.optimum.corners)
    return facts | ({"no_way": why} if why else {})
