"""``pin-metaik mobile compare``: path planners on the same scenes, in one table, with pictures of all runs."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from datetime import date
from pathlib import Path
from shlex import join
from typing import Annotated

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.mobile.common import (
    FITNESS,
    FitnessName,
    Goal,
    Rng,
    Start,
    can_write,
    fitness_with,
    planner_with,
    print_report,
    read_scene,
    say_written,
)
from pin_metaik.cli.options import Json, split
from pin_metaik.cli.progress import progress_bar
from pin_metaik.compare.planners.report import sections
from pin_metaik.compare.planners.run import compare_planners
from pin_metaik.compare.report.show import show
from pin_metaik.compare.report.write import write
from pin_metaik.errors import InvalidSetting
from pin_metaik.interrupts import kept
from pin_metaik.optimize import Budget

WIDE = 150  # columns for files and pipes, which have no width
USUAL = ("exact", "astar", "rrt", "rrtstar", "prm", "ga", "pso")


def compare(
    scenes: Annotated[list[str], typer.Argument(metavar="SCENE", help="One or several scenes, as for `plan`.")],
    methods: Annotated[
        list[str] | None,
        typer.Option(
            help=f"Planners, as for `plan --method`, separated by commas or repeated; default: {', '.join(USUAL)}."
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="METHOD.KEY=VALUE",
            help="A setting of a planner, such as ga.agents=60, or fitness.penalty=20. May be repeated.",
        ),
    ] = None,
    runs: Annotated[
        int, typer.Option(min=1, help="Number of runs of every planner on every scene, each with its own seed.")
    ] = 10,
    start: Start = None,
    goal: Goal = None,
    radius: Annotated[float, typer.Option(help="Radius of the robot.")] = 0.0,
    margin: Annotated[float, typer.Option(help="Distance to keep in addition to the radius.")] = 0.0,
    fitness: FitnessName = "exact",
    via: Annotated[int, typer.Option(min=1, help="Via points of metaheuristics.")] = 5,
    evaluations: Annotated[
        int, typer.Option(min=1, help="Budget of each run: paths of metaheuristics, straight lines of other planners.")
    ] = 5000,
    rng: Rng = 0,
    out: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder for the report, every run as CSV, and figures.")
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw figures into --out; needs the extra plots.")] = True,
    as_json: Json = False,
) -> None:
    """Compare path planners on the same scenes by their gap to the shortest path. Ctrl-C keeps what is done.

    Run 0 of a planner is what `plan` gives with the same --rng, run 1 with --rng + 1, and so on.
    """
    from pin_metaik import mobile

    can_write(out, figures)
    names = split(methods or USUAL)
    own = _of_each(settings or (), names)
    chosen = {name: planner_with(name, own[name]) for name in names}
    problems = [
        mobile.PathProblem.of(read_scene(scene, start, goal, radius + margin), radius, margin) for scene in scenes
    ]
    cost = fitness_with(fitness, [each for each in settings or () if each.startswith(FITNESS)])
    with progress_bar("comparing") as watch:
        found = kept(
            lambda: compare_planners(
                problems,
                chosen,
                runs,
                fitness=cost,
                via=via,
                budget=Budget(evaluations=evaluations),
                rng=rng,
                watch=watch,
            )
        )
    parts = sections(found)
    if as_json:
        print_report(found.as_dict())
    else:
        show(parts, Console(width=None if sys.stdout.isatty() else WIDE))
    if out is not None:
        preamble = ["# Path planners", f"`{join(['pin-metaik', *sys.argv[1:]])}`, {date.today()}."]
        say_written(write(out, "planners", preamble, parts, figures), as_json)
    raise typer.Exit(INTERRUPTED if found.partial else 0)


def _of_each(settings: Sequence[str], names: Sequence[str]) -> dict[str, list[str]]:
    """The settings of each planner, without its name in front.

    Raises:
        InvalidSetting: One is of none of them, nor of the fitness.
    """
    own: dict[str, list[str]] = {name: [] for name in names}
    for each in settings:
        name, _, rest = each.partition(".")
        if name not in own and not each.startswith(FITNESS):
            raise InvalidSetting(f"--set {each}: name one of the planners first, e.g. {names[-1]}.KEY=VALUE")
        own.get(name, []).append(rest)
    return own
