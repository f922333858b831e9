"""``pin-metaik plan``: a path for a mobile robot, and the trajectory along it."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.mobile.common import (
    Cells,
    FitnessName,
    Goal,
    Join,
    Resolution,
    Rng,
    SceneName,
    Settings,
    Specks,
    Start,
    Threshold,
    Unknown,
    VehicleName,
    can_write,
    fitness_with,
    planner_with,
    print_report,
    read_scene,
    say_written,
    warm_up,
)
from pin_metaik.cli.options import Json
from pin_metaik.cli.progress import progress_bar
from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import kept
from pin_metaik.optimize import ALGORITHMS, Budget

if TYPE_CHECKING:  # shapely is an extra, and none of the other commands should wait for it
    from pin_metaik.mobile import LearnedTurn, PathPlan, TrajectoryPlan, Vehicle

MARGIN = 0.1  # m, when a trajectory is wanted: curves need room inside the corners
TRAJECTORIES = ("dp", "de", "ann")
OTHERS = "astar, rrt, rrtconnect, rrtstar, informed, prm"


def plan(
    scene: SceneName,
    method: Annotated[
        str, typer.Option(help=f"exact; a metaheuristic: {', '.join(ALGORITHMS)}; or {OTHERS}.")
    ] = "exact",
    settings: Settings = None,
    fitness: FitnessName = "exact",
    trajectory: Annotated[
        str | None, typer.Option(help=f"Also plan a trajectory: {', '.join(TRAJECTORIES)}; lengths are in metres.")
    ] = None,
    network: Annotated[
        Path | None, typer.Option(help="For ann: a .npz of `mobile learn`; default: a network trained now.")
    ] = None,
    start: Start = None,
    goal: Goal = None,
    radius: Annotated[float | None, typer.Option(help="Radius of the robot; default: 0, or the vehicle's.")] = None,
    margin: Annotated[
        float | None, typer.Option(help=f"Distance to keep in addition; default: 0, or {MARGIN} with a trajectory.")
    ] = None,
    join: Join = None,
    unknown: Unknown = None,
    threshold: Threshold = None,
    specks: Specks = None,
    resolution: Resolution = None,
    vehicle: VehicleName = "nomad200",
    paths: Annotated[
        int,
        typer.Option(min=1, help="Number of homotopy classes to try; with a trajectory the quickest of them is taken."),
    ] = 1,
    via: Annotated[int, typer.Option(min=1, help="Number of via points of a metaheuristic.")] = 5,
    evaluations: Annotated[
        int,
        typer.Option(
            min=1, help="Budget: paths that a metaheuristic may try, or straight lines that another planner may test."
        ),
    ] = 5000,
    seeded: Annotated[
        bool, typer.Option("--seeded", help="Start one individual of a metaheuristic at the shortest path.")
    ] = False,
    rng: Rng = 0,
    out: Annotated[Path | None, typer.Option(help="Folder for scene, path and trajectory: JSON, CSV, PNG.")] = None,
    ros: Annotated[
        Path | None,
        typer.Option(help="Write the path as a nav_msgs/Path (.yaml or .json); with a trajectory its poses and times."),
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw figures into --out; needs the extra plots.")] = True,
    as_json: Json = False,
) -> None:
    """Plan a path among obstacles. Ctrl-C keeps the best so far.

    Exit code 0: planned, 1: none was found, or the one found collides, 2: invalid arguments, 130: interrupted.
    """
    from pin_metaik import mobile

    can_write(out, figures, ros)
    if trajectory is not None and trajectory not in TRAJECTORIES:
        raise InvalidSetting(f"no trajectory {trajectory!r}; known: {', '.join(TRAJECTORIES)}")
    if paths > 1 and method != "exact":
        raise InvalidSetting("--paths is for --method exact: a metaheuristic finds one path")
    robot = mobile.load_vehicle(vehicle)
    keep = radius if radius is not None else robot.radius if trajectory else 0.0
    room = margin if margin is not None else MARGIN if trajectory else 0.0
    model = None if network is None else mobile.load_turn(network)
    if model is not None and trajectory != "ann":
        raise InvalidSetting("--network is for --trajectory ann")
    planner, cost = planner_with(method, settings), fitness_with(fitness, settings)
    world = read_scene(scene, start, goal, keep + room, Cells(unknown, threshold, specks, resolution))
    problem = mobile.PathProblem.of(world, keep, room, join)  # type: ignore[arg-type]  # it checks the join itself
    warm_up()
    with progress_bar("path") as watch:
        path = kept(
            lambda: mobile.plan_path(
                problem,
                planner,
                fitness=cost,
                via=via,
                budget=Budget(evaluations=evaluations),
                rng=rng,
                seeded=seeded,
                watch=watch,
            )
        )
    path = replace(path, method=method)  # settings make an object of it, whose name is another
    plans = mobile.plan_alternatives(problem, paths) if paths > 1 else [path]
    motions = (
        list(_motions(plans, robot, keep, trajectory, rng, model))
        if trajectory and path.success and not path.interrupted
        else []
    )
    best = min(range(len(motions)), key=lambda i: (not motions[i].success, motions[i].time), default=0)
    motion = motions[best] if motions else None

    found = plans[best].as_dict()
    if len(plans) > 1:
        found["alternatives"] = [each.as_dict() for i, each in enumerate(plans) if i != best]
    report: dict[str, Any] = {"path": found}
    if motion is not None:
        report["trajectory"] = {key: value for key, value in motion.as_dict().items() if key != "samples"}
    if as_json:
        print_report(report)
    else:
        _show(plans, motions, best)
    if out is not None:
        say_written(_write(out, plans, best, found, motion, figures), as_json)
    if ros is not None:
        mobile.write_nav_path(ros, plans[best].path if motion is None else motion.trajectory)
        say_written([ros], as_json)
    if path.interrupted or any(each.interrupted for each in motions):
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if path.success and (motion is None or motion.success) else 1)


def _motions(
    plans: list[PathPlan], robot: Vehicle, radius: float, method: str, rng: int, model: LearnedTurn | None
) -> Iterator[TrajectoryPlan]:
    from pin_metaik import mobile
    from pin_metaik.learn import OutsideTraining

    if method == "ann" and model is None and isinstance(robot, mobile.SynchroDrive):
        model = mobile.learn_turn(robot)
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
            what = "no path was found" if each.status == "NOT_FOUND" else "it goes through an obstacle"
            console.print(f"  {what}. Try more evaluations, or --method exact.")
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
