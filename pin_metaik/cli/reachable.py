"""``pin-metaik reachability`` and ``pin-metaik place-base``: what a robot reaches, and where to put it."""

from __future__ import annotations

import time
from math import degrees, radians
from pathlib import Path
from typing import Annotated

import numpy as np
import pinocchio as pin
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from pin_metaik.cli.options import Json
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.versions import print_json
from pin_metaik.collision import CollisionWorld, load_scene, scene_names
from pin_metaik.errors import InvalidTarget
from pin_metaik.figures import FORMATS, picture_file
from pin_metaik.files import read_csv
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.optimize import ALGORITHMS, Budget
from pin_metaik.reachable import Grid, place_base, save_reachability
from pin_metaik.reachable import reachability as survey
from pin_metaik.reachable.files import format_of
from pin_metaik.robots import Robot, load_robot

RobotName = Annotated[str, typer.Argument(help="A robot's name (see `robots`), or the path of a .urdf or DH .toml.")]
FrameName = Annotated[str | None, typer.Option("--frame", help="The frame to place; default: the robot's tip.")]
WorldName = Annotated[
    str | None,
    typer.Option("--world", help=f"A scene of obstacles: .toml or .json, or one of {', '.join(scene_names())}."),
]
Seed = Annotated[int, typer.Option("--rng", min=0, help="Seed of every random choice.")]


def reachability(
    robot: RobotName,
    frame: FrameName = None,
    spacing: Annotated[float, typer.Option(help="Distance between neighbouring positions, m.")] = 0.1,
    orientations: Annotated[
        int, typer.Option(min=0, help="Number of orientations at each position, spread evenly; 0: at any orientation.")
    ] = 20,
    box: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(metavar="X Y Z X Y Z", help="Least and greatest corner, m; default: as far as the robot reaches."),
    ] = None,
    world: WorldName = None,
    jobs: Annotated[
        int | None, typer.Option(help="Number of processes; -1: one for each core; default: threads.")
    ] = None,
    folder: Annotated[
        Path | None, typer.Option(help="Folder to store parts of the map in; the same command resumes from it.")
    ] = None,
    output: Annotated[
        list[Path] | None,
        typer.Option("--output", "-o", help="Write the map (.npz, .parquet) or a picture; may be repeated."),
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Show it in the browser until Ctrl-C.")] = False,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the page; 0: any free port.")] = 8080,
    rng: Seed = 0,
    as_json: Json = False,
) -> None:
    """Map the positions a robot reaches, the share of orientations at each, and its manipulability."""
    outputs = output or []
    for path in outputs:
        if path.suffix.lower() in FORMATS:
            picture_file(path)
        else:
            format_of(path)
    loaded, chain, around = _asked(robot, frame, world)
    grid = Grid.around(chain, spacing) if box is None else Grid(box[:3], box[3:], spacing)
    with progress_bar("reachability") as watch:
        found = survey(chain, grid, orientations or None, world=around, jobs=jobs, folder=folder, rng=rng, watch=watch)
    for path in outputs:
        if path.suffix.lower() in FORMATS:
            save_reachability(found, path)
        else:
            found.save(path)
    if as_json:
        print_json({"robot": loaded.name, "frame": chain.frames[0], **found.as_dict()})
    else:
        print(found)
    if show:
        from pin_metaik.reachable.viewer import show_reachability

        shown = show_reachability(found, CollisionWorld(loaded) if around is None else around, port)
        print(f"http://localhost:{shown.viewer.get_port()} until Ctrl-C", flush=True)
        while True:
            time.sleep(1.0)


def place(
    robot: RobotName,
    poses: Annotated[Path, typer.Argument(help="CSV of poses in the world: x,y,z in m, or x,y,z,roll,pitch,yaw.")],
    frame: FrameName = None,
    world: WorldName = None,
    algorithm: Annotated[str, typer.Option(help=f"The metaheuristic: {', '.join(ALGORITHMS)}.")] = "mtde",
    places: Annotated[int, typer.Option(min=1, help="Number of placements to try.")] = 1000,
    rng: Seed = 0,
    in_degrees: Annotated[bool, typer.Option("--degrees", help="Read and print angles in degrees.")] = False,
    as_json: Json = False,
) -> None:
    """Find where on the floor to put a robot so that it reaches poses. Exit code 0: all of them, 1: not all."""
    _, chain, around = _asked(robot, frame, world)
    targets = read_targets(poses, in_degrees)
    with progress_bar("places") as watch:
        found = place_base(
            chain, targets, world=around, algorithm=algorithm, budget=Budget(evaluations=places), rng=rng, watch=watch
        )
    if as_json:
        print_json(found.as_dict())
    else:
        print(found)
        table = Table("pose", "status", "manipulability", "q", box=None)
        turn = degrees(1.0) if in_degrees else 1.0
        for number, (result, worth) in enumerate(zip(found.results, found.manipulability, strict=True)):
            x = np.where(chain.limits.rotates, turn, 1.0) * chain.x(result.q)
            table.add_row(f"{number}", f"{result.status}", f"{worth:.3g}", " ".join(f"{value:.4g}" for value in x))
        Console().print(table)
    raise typer.Exit(0 if found else 1)


def _asked(robot: str, frame: str | None, scene: str | None) -> tuple[Robot, Chain, CollisionWorld | None]:
    """The robot, its chain, and the world around it."""
    loaded = load_robot(robot)
    chain = Chain(loaded.model, loaded.frame if frame is None else frame)
    return loaded, chain, None if scene is None else CollisionWorld(loaded, load_scene(scene))


def read_targets(path: Path, in_degrees: bool) -> list[pin.SE3] | NDArray[np.float64]:
    """Poses, or positions (k, 3), from a CSV file; a line of headings may come first."""
    lines = [line for line in read_csv(path, InvalidTarget) if line and not line[0].lstrip().startswith("#")]
    rows = []
    for number, line in enumerate(lines):
        try:
            rows.append([float(word) for word in line])
        except ValueError:
            if number:
                raise InvalidTarget(
                    f"{path}: row {number + 1} has words that are no numbers: {','.join(line)}"
                ) from None
    if not rows or {len(row) for row in rows} not in ({3}, {6}) or not np.isfinite(rows).all():
        raise InvalidTarget(
            f"{path}: each row is x,y,z or x,y,z,roll,pitch,yaw, finite, the same in all; and there is one"
        )
    if len(rows[0]) == 3:
        return np.array(rows)
    turn = radians(1.0) if in_degrees else 1.0
    return [pin.SE3(rpy_matrix(*(turn * angle for angle in row[3:])), np.array(row[:3])) for row in rows]
