"""``pin-metaik mobile drive``: motions that begin and end with a heading and a speed; planning again on the way."""

from __future__ import annotations

import json
from dataclasses import asdict
from math import atan2
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from pin_metaik.cli.mobile.common import (
    Goal,
    SceneName,
    VehicleName,
    can_write,
    print_report,
    read_scene,
    say_written,
    state_of,
)
from pin_metaik.cli.options import Json
from pin_metaik.errors import InvalidSetting

if TYPE_CHECKING:
    from pin_metaik.mobile import Scene, State

Five = tuple[float, float, float, float, float]
Four = tuple[float, float, float, float]


def drive(
    scene: SceneName,
    state: Annotated[
        Five | None,
        typer.Option(
            "--from",
            metavar="X Y HEADING V OMEGA",
            help="Start state: m, degrees, m/s, degrees/s. Default: at rest at the scene's start, heading "
            "for the goal.",
        ),
    ] = None,
    after: Annotated[
        Path | None,
        typer.Option(help="Start from a state of this trajectory.json, as `plan --out` writes it; see --at."),
    ] = None,
    at: Annotated[
        float | None, typer.Option(help="The time, s, of that trajectory at which the new one begins.")
    ] = None,
    to: Annotated[
        Four | None,
        typer.Option(metavar="X Y HEADING V", help="Pose and speed at the end; default: at rest at the scene's goal."),
    ] = None,
    goal: Goal = None,
    vehicle: VehicleName = "nomad200",
    margin: Annotated[
        float, typer.Option(help="Distance that paths keep in addition to the vehicle's radius, m.")
    ] = 0.1,
    paths: Annotated[
        int, typer.Option(min=1, help="Number of homotopy classes to try from each of two positions.")
    ] = 3,
    out: Annotated[Path | None, typer.Option(help="Folder for trajectory.json, .csv and .png.")] = None,
    ros: Annotated[Path | None, typer.Option(help="Write a nav_msgs/Path with times (.yaml or .json).")] = None,
    figures: Annotated[bool, typer.Option(help="Draw figures into --out; needs the extra plots.")] = True,
    as_json: Json = False,
) -> None:
    """Plan a motion from a moving state to another, without jumps of speed and without needless stops.

    Exit code 0: planned, 1: it collides or misses the goal; 2: invalid arguments, or no motion leads there.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile import plots

    if (after is None) != (at is None):
        raise InvalidSetting("--after and --at go together: a trajectory, and a time in it")
    if after is not None and state is not None:
        raise InvalidSetting("give --from or --after, not both: each says where the motion begins")
    if to is not None and goal is not None:
        raise InvalidSetting("give --to or --goal, not both: each says where the motion ends")
    can_write(out, figures, ros)
    robot = mobile.load_vehicle(vehicle)
    if after is not None and at is not None:
        given: State | None = mobile.load_trajectory(after).state(at)
    else:
        given = None if state is None else state_of(state)
    place = None if given is None else (given.x, given.y)
    world = read_scene(scene, place, goal if to is None else to[:2], robot.radius + margin)
    begin = given or _at_rest(world)
    final = None if to is None else state_of(to)
    plan = mobile.replan(world, robot, start=begin, goal=final, margin=margin, paths=paths)
    files: list[Path] = []
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        files = [out / "trajectory.json", out / "trajectory.csv"]
        files[0].write_text(json.dumps(plan.as_dict(), allow_nan=False), encoding="utf-8")
        plan.trajectory.write_csv(files[1])
        if figures:
            files.append(out / "trajectory.png")
            plots.save(files[2], lambda figure: plots.draw_trajectory(figure, plan, world), (11.0, 6.5))
    if ros is not None:
        mobile.write_nav_path(ros, plan.trajectory)
        files.append(ros)
    if as_json:
        values = {key: value for key, value in plan.as_dict().items() if key != "samples"}
        print_report({"begins": asdict(begin), "trajectory": values})
    else:
        console = Console(highlight=False)
        console.print(str(plan), style="green" if plan else "yellow", soft_wrap=True)
        for note in plan.notes:
            console.print(f"  {note}", soft_wrap=True)
    say_written(files, as_json)
    raise typer.Exit(0 if plan else 1)


def _at_rest(scene: Scene) -> State:
    """Standing at the start, heading straight for the goal."""
    from pin_metaik import mobile

    (x, y), (gx, gy) = scene.start, scene.goal
    return mobile.State(x, y, atan2(gy - y, gx - x))
