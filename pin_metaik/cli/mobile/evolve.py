"""``pin-metaik mobile evolve``: a metaheuristic's generations, step by step, as pictures or a film."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from pin_metaik.cli.codes import INTERRUPTED
from pin_metaik.cli.mobile.common import (
    FitnessName,
    Goal,
    Rng,
    SceneName,
    Settings,
    Start,
    fitness_with,
    planner_with,
    read_scene,
    say_written,
)
from pin_metaik.errors import InvalidSetting
from pin_metaik.figures import picture_file
from pin_metaik.interrupts import kept
from pin_metaik.optimize import ALGORITHMS, Budget
from pin_metaik.watching import Population, Progress

FILM = ".gif"
PANEL = 2.7  # inches
FRAMES_A_SECOND = 4


def evolve(
    scene: SceneName,
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", help="File: generations side by side (.png, .svg, .pdf) or as an animation (.gif)."
        ),
    ],
    method: Annotated[str, typer.Option(help=f"A metaheuristic: {', '.join(ALGORITHMS)}.")] = "ga",
    settings: Settings = None,
    fitness: FitnessName = "exact",
    steps: Annotated[
        int, typer.Option(min=2, max=100, help="Number of generations to show, from the first to the last.")
    ] = 8,
    start: Start = None,
    goal: Goal = None,
    radius: Annotated[float, typer.Option(help="Radius of the robot.")] = 0.0,
    via: Annotated[int, typer.Option(min=1, help="Via points.")] = 5,
    evaluations: Annotated[int, typer.Option(min=1, help="Paths it may try.")] = 5000,
    rng: Rng = 0,
) -> None:
    """Show the generations of a metaheuristic: the paths of the population, and the best of each.

    Exit code 0: its best path is free, 1: it is not, 2: invalid arguments, 130: interrupted.
    """
    from pin_metaik import mobile

    picture_file(output, FILM)
    planner = planner_with(method, settings)
    if method not in ALGORITHMS:
        raise InvalidSetting(f"{method} has no generations: --method is one of {', '.join(ALGORITHMS)}")
    problem = mobile.PathProblem.of(read_scene(scene, start, goal, radius), radius)
    steps_seen = Steps(steps, evaluations)
    plan = kept(
        lambda: mobile.plan_path(
            problem,
            planner,
            fitness=fitness_with(fitness, settings),
            via=via,
            budget=Budget(evaluations=evaluations),
            rng=rng,
            watch=steps_seen,
        )
    )
    _draw(output, problem, steps_seen.by_title)
    Console(highlight=False).print(str(plan), style="green" if plan else "yellow", soft_wrap=True)
    say_written([output], as_json=False)
    raise typer.Exit(INTERRUPTED if plan.interrupted else 0 if plan else 1)


class Steps:
    """A watch that keeps some generations of a search, from the first to the last, most of them early."""

    def __init__(self, count: int, evaluations: int) -> None:
        self._marks = [evaluations * (k / (count - 1)) ** 2 for k in range(count)]  # the first ones change most
        self._kept: list[tuple[str, Population]] = []
        self._last: tuple[str, Population] | None = None
        self._generations = 0

    def __call__(self, at: Progress) -> None:
        """Keep a generation if it is its turn."""
        if at.population is None:
            return
        self._generations += 1
        self._last = f"generation {self._generations:,}, {int(at.done):,} paths", at.population
        if len(self._kept) < len(self._marks) and at.done >= self._marks[len(self._kept)]:
            self._kept.append(self._last)

    @property
    def by_title(self) -> dict[str, Population]:
        """What was kept, and the last."""
        return dict(self._kept if self._last is None else [*self._kept, self._last])


def _draw(output: Path, problem: Any, generations: dict[str, Population]) -> None:
    from pin_metaik.mobile import plots

    if output.suffix.lower() != FILM:
        columns = min(len(generations), plots.WIDEST)
        size = (PANEL * columns, PANEL * -(-len(generations) // columns))
        plots.save(output, lambda figure: plots.draw_generations(figure, problem, generations), size)
        return
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0, 5.2), layout="constrained")
    FigureCanvasAgg(figure)
    ax = figure.subplots()

    def frame(entry: tuple[str, Population]) -> None:
        ax.clear()
        plots.draw_generation(ax, problem, entry[1])
        ax.set_title(f"{entry[0]}: best {entry[1].costs.min():.4g}", fontsize="medium")

    film = FuncAnimation(figure, frame, frames=list(generations.items()), cache_frame_data=False)
    film.save(output, PillowWriter(fps=FRAMES_A_SECOND))
