"""What the commands about mobile robots share: options, how a scene is read with them, what they print and write."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer
from rich.console import Console

from pin_metaik.cli.settings import values_of, with_values
from pin_metaik.cli.versions import versions
from pin_metaik.compare.report.write import need_figures
from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.output import writable

if TYPE_CHECKING:  # shapely is an extra, and none of the other commands should wait for it
    from pin_metaik.mobile import Fitness, PathPlanner, Scene, State
    from pin_metaik.optimize import Metaheuristic

UNITS = {"length": "that of the scene, m with a trajectory", "angle": "rad", "time": "s"}
RANDOM = "random:"
GAP = 0.1  # what random scenes keep between obstacles on top of the robot
FITNESS = "fitness."

Place: TypeAlias = tuple[float, float] | None
Pose: TypeAlias = tuple[float, float, float]

SceneName = Annotated[
    str,
    typer.Argument(
        help="A scene (.json), polygons (.geojson, .wkt), an occupancy grid (.npy), a ROS map (.yaml), the name "
        "of a scene that comes with the package, or random:SEED, random:SEED:OBSTACLES or "
        "random:SEED:OBSTACLES:CONCAVE, where CONCAVE is the share of concave ones.",
    ),
]
Start = Annotated[Place, typer.Option(metavar="X Y", help="Replaces that of the scene.")]
Goal = Annotated[Place, typer.Option(metavar="X Y", help="Replaces that of the scene.")]
Join = Annotated[
    str | None,
    typer.Option(help="Corners of grown obstacles: mitre or round; default: mitre, or round if mitre leaves no path."),
]
Unknown = Annotated[str | None, typer.Option(help="For a grid: unknown cells are blocked (the default) or free.")]
Threshold = Annotated[
    float | None, typer.Option(help="For a grid: cells above it are occupied; default: 0, for a ROS map 99.")
]
Specks = Annotated[
    int | None, typer.Option(min=1, help="For a grid: groups of fewer occupied cells than this are left out.")
]
Resolution = Annotated[float | None, typer.Option(help="For a .npy: width of a cell, m; default: 1.")]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="A setting of the planner, such as agents=60, or of its fitness, such as fitness.penalty=20. May be "
        "repeated.",
    ),
]
VehicleName = Annotated[
    str,
    typer.Option(
        help="The vehicle: nomad200, nomad200_driver, turtlebot3_burger, turtlebot3_waffle, or a .json with others."
    ),
]
FitnessName = Annotated[str, typer.Option(help="What a metaheuristic minimises: exact or paper (its Eq. 5).")]
Rng = Annotated[int, typer.Option(min=0, help="Seed of every random choice.")]


@dataclass(frozen=True)
class Cells:
    """How a grid is read; None for what was not said."""

    unknown: str | None = None
    threshold: float | None = None
    specks: int | None = None
    resolution: float | None = None

    @property
    def given(self) -> dict[str, Any]:
        """What was said."""
        return {key: value for key, value in vars(self).items() if value is not None}


def read_scene(source: str, start: Place, goal: Place, clearance: float = 0.0, cells: Cells | None = None) -> Scene:
    """The scene of a source.

    Args:
        source: As the command has it.
        start: Instead of its own.
        goal: Instead of its own.
        clearance: Of the robot, that random scenes leave room for.
        cells: How a grid is read.
    """
    from pin_metaik import mobile

    given = {} if cells is None else cells.given
    if not source.startswith(RANDOM):
        return mobile.load_scene(source, start, goal, **given)
    if given:
        raise InvalidSetting(
            f"{', '.join(f'--{key}' for key in given)}: only for an occupancy grid, which a random scene is not"
        )
    seed, count, concave = (*source.removeprefix(RANDOM).split(":"), "", "")[:3]
    try:
        obstacles, share = int(count or 15), float(concave or 0.0)
        if not seed.isdigit() or source.count(":") > 3:
            raise ValueError
    except ValueError:
        forms = "random:SEED, random:SEED:OBSTACLES or random:SEED:OBSTACLES:CONCAVE"
        raise InvalidSetting(f"a random scene is {forms}, not {source!r}") from None
    gap = GAP + 2 * clearance  # with round joins the robot fits through everywhere
    scene = mobile.random_scene(obstacles, int(seed), gap=gap, concave=share, start=start, goal=goal)
    return mobile.Scene(scene.start, scene.goal, scene.obstacles, scene.bounds, source)


def planner_with(method: str, settings: list[str] | None) -> str | Metaheuristic | PathPlanner:
    """A planner with settings, of which those of the fitness are none; without any its name.

    Raises:
        InvalidSetting: Settings of the exact planner, which has none.
    """
    from pin_metaik import mobile

    own = [each for each in settings or () if not each.startswith(FITNESS)]
    if not own:
        return method
    if method == "exact":
        raise InvalidSetting(f"--set {own[0]}: the exact planner has no settings; give --method, too")
    planner = mobile.planner_of(method)
    return with_values(planner, values_of(planner, own))


def fitness_with(name: str, settings: list[str] | None) -> Fitness:
    """A fitness with its settings, which begin with ``fitness.``."""
    from pin_metaik import mobile

    if name not in mobile.FITNESSES:
        raise UnknownName("fitness", name, mobile.FITNESSES)
    fitness = mobile.FITNESSES[name]()
    own = [each.removeprefix(FITNESS) for each in settings or () if each.startswith(FITNESS)]
    return with_values(fitness, values_of(fitness, own))


def warm_up() -> None:
    """Plan round a box, so that what is compiled and imported once is not in the times shown."""
    from pin_metaik import mobile

    box = mobile.read_polygons([[(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]])
    mobile.plan_path(mobile.Scene((0.0, 0.0), (3.0, 0.0), box))


def state_of(numbers: tuple[float, ...]) -> State:
    """The state that x, y (m), heading (degrees), speed (m/s) and perhaps turning rate (degrees/s) stand for."""
    from pin_metaik import mobile

    x, y, heading, v, *turning = numbers
    return mobile.State(x, y, radians(heading), v, *(radians(rate) for rate in turning))


def can_write(out: Path | None, figures: bool, ros: Path | None = None) -> None:
    """Look whether a folder, its figures and a file for ROS can be written, before the work that they are for."""
    if out is not None:
        writable(out, folder=True)
        if figures:
            need_figures()
    if ros is not None:
        from pin_metaik.mobile.ros import ros_file

        ros_file(ros)


def print_report(report: Mapping[str, Any]) -> None:
    """Print an answer as one JSON object, versions and units first."""
    print(json.dumps({"versions": versions(), "units": UNITS, **report}, allow_nan=False))


def say_written(files: list[Path], as_json: bool) -> None:
    """Names of files, where they are in nobody's way."""
    for file in files:
        Console(stderr=as_json).print(str(file), markup=False, highlight=False, soft_wrap=True)
