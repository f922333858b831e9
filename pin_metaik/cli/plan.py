"""``pin-metaik plan``: a path for a mobile robot, and the trajectory along it."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.progress import progress_bar
from pin_metaik.cli.versions import versions
from pin_metaik.compare.report.write import need_figures
from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import kept
from pin_metaik.optimize import ALGORITHMS, AskTell, Budget
from pin_metaik.output import writable

if TYPE_CHECKING:  # shapely is an extra, and none of the other commands should wait for it
    from pin_metaik.mobile import PathPlan, Scene, TrajectoryPlan, Vehicle

UNITS = {"length": "that of the scene, m with a trajectory", "angle": "rad", "time": "s"}
MARGIN = 0.1  # m, when a trajectory is wanted: curves need room inside the corners
RANDOM = "random:"
TRAJECTORIES = ("dp", "de", "ann")
Tick = Callable[[AskTell], None]
Place = tuple[float, float] | None


def plan(
    scene: Annotated[
        str,
        typer.Argument(
            help="A scene (.json), polygons (.geojson, .wkt), an occupancy grid (.npy), a ROS map (.yaml), the name "
            "of a scene that comes with the package, or random:SEED or random:SEED:OBSTACLES."
        ),
    ],
    method: Annotated[str, typer.Option(help=f"exact, or a metaheuristic: {', '.join(ALGORITHMS)}.")] = "exact",
    fitness: Annotated[str, typer.Option(help="What a metaheuristic minimises: exact or paper (its Eq. 5).")] = "exact",
    trajectory: Annotated[
        str | None, typer.Option(help=f"Plan a trajectory, too: {', '.join(TRAJECTORIES)}; lengths are metres.")
    ] = None,
    start: Annotated[tuple[float, float] | None, typer.Option(metavar="X Y", help="Instead of the scene's.")] = None,
    goal: Annotated[tuple[float, float] | None, typer.Option(metavar="X Y", help="Instead of the scene's.")] = None,
    radius: Annotated[float | None, typer.Option(help="Of the robot; default: 0, or the vehicle's.")] = None,
    margin: Annotated[
        float | None, typer.Option(help=f"To keep on top of that; default: 0, or {MARGIN} with a trajectory.")
    ] = None,
    join: Annotated[
        str | None, typer.Option(help="Corners of grown obstacles: mitre or round; default: mitre, round if it must.")
    ] = None,
    unknown: Annotated[
        str | None, typer.Option(help="Of a grid: unknown cells are blocked (the default) or free.")
    ] = None,
    threshold: Annotated[
        float | None, typer.Option(help="Of a grid: cells above it are occupied; default: 0, of a ROS map 99.")
    ] = None,
    specks: Annotated[
        int | None, typer.Option(min=1, help="Of a grid: groups of fewer occupied cells are left out.")
    ] = None,
    resolution: Annotated[float | None, typer.Option(help="Of a .npy: width of a cell, m; default: 1.")] = None,
    vehicle: Annotated[
        str,
        typer.Option(
            help="Whose limits the trajectory keeps: nomad200, nomad200_driver, turtlebot3_burger, turtlebot3_waffle, "
            "or a .json with others."
        ),
    ] = "nomad200",
    paths: Annotated[
        int, typer.Option(min=1, help="Homotopy classes to try; with a trajectory the quickest of them counts.")
    ] = 1,
    via: Annotated[int, typer.Option(min=1, help="Via points of a metaheuristic.")] = 5,
    evaluations: Annotated[int, typer.Option(min=1, help="Paths a metaheuristic may try.")] = 5000,
    seeded: Annotated[bool, typer.Option("--seeded", help="Start one individual at the shortest path.")] = False,
    rng: Annotated[int, typer.Option(min=0, help="Seed of every random choice.")] = 0,
    out: Annotated[Path | None, typer.Option(help="Folder for scene, path and trajectory: JSON, CSV, PNG.")] = None,
    ros: Annotated[
        Path | None,
        typer.Option(help="A .yaml or .json for the path as a nav_msgs/Path; with a trajectory its poses and times."),
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw figures into --out; needs the extra plots.")] = True,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Plan a path among obstacles. Ctrl-C keeps the best so far.

    Exit code 0: planned, 1: what was found collides, 2: the call makes no sense, 130: interrupted.
    """
    from pin_metaik import mobile
    from pin_metaik.mobile.ros import ros_file

    if out is not None:
        writable(out, folder=True)
        if figures:
            need_figures()
    if ros is not None:
        ros_file(ros)
    if trajectory is not None and trajectory not in TRAJECTORIES:
        raise InvalidSetting(f"no trajectory {trajectory!r}; known: {', '.join(TRAJECTORIES)}")
    if paths > 1 and method != "exact":
        raise InvalidSetting("--paths is for --method exact: a metaheuristic finds one path")
    robot = mobile.load_vehicle(vehicle)
    keep = radius if radius is not None else robot.radius if trajectory else 0.0
    room = margin if margin is not None else MARGIN if trajectory else 0.0
    cells = {"unknown": unknown, "threshold": threshold, "specks": specks, "resolution": resolution}
    given = {key: value for key, value in cells.items() if value is not None}
    world = _scene(scene, start, goal, keep + room, given)
    problem = mobile.PathProblem.of(world, keep, room, join)  # type: ignore[arg-type]  # it checks the join itself
    _warm_up()
    with progress_bar("path") as watch:
        path = kept(
            lambda: mobile.plan_path(
                problem,
                method,
                fitness=fitness,
                via=via,
                budget=Budget(evaluations=evaluations),
                rng=rng,
                seeded=seeded,
                watch=watch,
            )
        )
    plans = mobile.plan_alternatives(problem, paths) if paths > 1 else [path]
    motions = (
        list(_motions(plans, robot, keep, trajectory, rng))
        if trajectory and path.success and not path.interrupted
        else []
    )
    best = min(range(len(motions)), key=lambda i: (not motions[i].success, motions[i].time), default=0)
    motion = motions[best] if motions else None

    found = plans[best].as_dict()
    if len(plans) > 1:
        found["alternatives"] = [each.as_dict() for i, each in enumerate(plans) if i != best]
    report: dict[str, Any] = {"versions": versions(), "units": UNITS, "path": found}
    if motion is not None:
        report["trajectory"] = {key: value for key, value in motion.as_dict().items() if key != "samples"}
    if as_json:
        print(json.dumps(report, allow_nan=False))
    else:
        _show(plans, motions, best)
    if out is not None:
        for file in _write(out, plans, best, found, motion, figures):
            Console(stderr=as_json).print(str(file), markup=False, highlight=False, soft_wrap=True)
    if ros is not None:
        mobile.write_nav_path(ros, plans[best].path if motion is None else motion.trajectory)
        Console(stderr=as_json).print(str(ros), markup=False, highlight=False, soft_wrap=True)
    if path.interrupted or any(each.interrupted for each in motions):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if path.success and (motion is None or motion.success) else 1)


def _warm_up() -> None:
    """Plan round a box, so that compiling and importing are not in the times shown."""
    from pin_metaik import mobile

    box = mobile.read_polygons([[(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]])
    mobile.plan_path(mobile.Scene((0.0, 0.0), (3.0, 0.0), box))


def _scene(source: str, start: Place, goal: Place, clearance: float, cells: dict[str, Any]) -> Scene:
    """The scene of a source; ``cells`` says how a grid is read."""
    from pin_metaik import mobile

    if not source.startswith(RANDOM):
        return mobile.load_scene(source, start, goal, **cells)
    if cells:
        raise InvalidSetting(f"{', '.join(f'--{key}' for key in cells)}: of an occupancy grid; a random scene is none")
    seed, _, count = source.removeprefix(RANDOM).partition(":")
    if not seed.isdigit() or not (count or "15").isdigit():
        raise InvalidSetting(f"a random scene is random:SEED or random:SEED:OBSTACLES, not {source!r}")
    gap = 0.1 + 2 * clearance  # with round joins the robot fits through everywhere
    return mobile.random_scene(int(count or 15), int(seed), gap=gap, start=start, goal=goal)


def _motions(plans: list[PathPlan], robot: Vehicle, radius: float, method: str, rng: int) -> Iterator[TrajectoryPlan]:
    from pin_metaik import mobile
    from pin_metaik.learn import OutsideTraining

    model = mobile.learn_turn(robot) if method == "ann" and isinstance(robot, mobile.SynchroDrive) else None
    for plan in plans:
        with progress_bar("trajectory") as watch, warnings.catch_warnings():
            warnings.simplefilter("ignore", OutsideTraining)  # the plan's notes say it
            search = partial(
                mobile.plan_trajectory,
                plan.path,
                robot,
                plan.problem.scene.obstacles,
                method=method,  # type: ignore[arg-type]  # checked where it came in
                radius=radius,
                rng=rng,
                model=model,
                watch=watch,
            )
            motion = kept(search)
        yield motion
        if motion.interrupted:
            return


def _show(plans: list[PathPlan], motions: list[TrajectoryPlan], best: int) -> None:
    console = Console(highlight=False)
    for i, each in enumerate(plans):
        good = each.success and (not motions or motions[i].success)
        style = "green" if good and i == best else None if good else "yellow"
        console.print(f"path {i + 1}: {each}" if len(plans) > 1 else str(each), style=style, soft_wrap=True)
        if each.interrupted:
            console.print("  interrupted: the best so far")
        if not each.success:
            console.print("  goes through an obstacle: not a path. Try more evaluations, or --method exact.")
        if motions:
            console.print(f"  trajectory: {motions[i]}", soft_wrap=True)
            for note in motions[i].notes:
                console.print(f"    {note}", soft_wrap=True)
    if len(motions) > 1:
        console.print(f"quickest: path {best + 1}, {motions[best].time:.3f} s")


def _write(
    folder: Path, plans: list[PathPlan], best: int, found: dict[str, Any], motion: TrajectoryPlan | None, figures: bool
) -> list[Path]:
    from pin_metaik.mobile import plots

    plan, scene = plans[best], plans[best].problem.scene
    others = [each.path for each in plans if each is not plan]
    folder.mkdir(parents=True, exist_ok=True)
    names = ["scene.json", "path.json", "path.csv"]
    (folder / "scene.json").write_text(json.dumps(scene.as_dict()), encoding="utf-8")
    (folder / "path.json").write_text(json.dumps(found, allow_nan=False), encoding="utf-8")
    plan.path.write(folder / "path.csv")
    if figures:
        plots.save(folder / "path.png", lambda figure: plots.draw_plan(figure, plan, others))
        names.append("path.png")
    if motion is not None:
        motion.trajectory.write_csv(folder / "trajectory.csv")
        (folder / "trajectory.json").write_text(json.dumps(motion.as_dict(), allow_nan=False), encoding="utf-8")
        names += ["trajectory.csv", "trajectory.json"]
        if figures:
            plots.save(
                folder / "trajectory.png", lambda figure: plots.draw_trajectory(figure, motion, scene), (11.0, 6.5)
            )
            names.append("trajectory.png")
    return [folder / name for name in names]
