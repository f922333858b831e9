"""Pictures of scenes, paths and trajectories, drawn into a matplotlib figure that is handed in.

Nothing here imports matplotlib: make a ``matplotlib.figure.Figure`` (the extra ``plots``), or let ``save`` do it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path as File
from typing import Any

import numpy as np
import shapely

from pin_metaik.arrays import Array
from pin_metaik.figures import new_figure
from pin_metaik.mobile.curves.curve import Curve
from pin_metaik.mobile.curves.footprint import Footprint
from pin_metaik.mobile.motion.result import TrajectoryPlan
from pin_metaik.mobile.moving.waiting import WaitingPath
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.paths.result import PathPlan, PathStatus
from pin_metaik.mobile.world.border import rings
from pin_metaik.mobile.world.scene import Scene
from pin_metaik.watching import Population

# Okabe and Ito: told apart by every eye and in grey.
BLUE, RED, GREEN, GREY, STONE = "#0072b2", "#d55e00", "#009e73", "#999999", "#c9c5bd"
EDGE = "#6b675f"
DPI = 150
OUTLINES, MOMENTS, WIDEST = 25, 9, 4  # outlines along a curve, times of a timed path, generations side by side


def save(file: str | File, draw: Callable[[Any], None], size: tuple[float, float] = (6.0, 6.0)) -> None:
    """Draw a figure and write it.

    Args:
        file: The file; its suffix gives the format (``.png``, ``.svg``, ``.pdf``).
        draw: Draws into an empty figure, e.g. ``lambda figure: draw_plan(figure, plan)``.
        size: Width and height in inches.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    figure = new_figure(size)
    draw(figure)
    figure.savefig(file, dpi=DPI)


def draw_scene(ax: Any, scene: Scene, region: shapely.Geometry | None = None) -> None:
    """Obstacles, walls, start and goal on axes; with the free region the obstacles' growth as dotted lines."""
    for obstacle in scene.obstacles:
        _draw_obstacle(ax, obstacle)
    if region is not None:
        for ring in rings(region):
            ax.plot(*np.vstack((ring, ring[:1])).T, ":", color=GREY, linewidth=0.8)
    x_min, y_min, x_max, y_max = _window(scene)
    if scene.bounds is not None:
        ax.plot([x_min, x_max, x_max, x_min, x_min], [y_min, y_min, y_max, y_max, y_min], color="black", linewidth=1.2)
    ax.plot(*scene.start, "o", color=GREEN, markersize=7, zorder=5)
    ax.plot(*scene.goal, "*", color=RED, markersize=12, zorder=5)
    room = 0.02 * max(x_max - x_min, y_max - y_min)
    ax.set(xlim=(x_min - room, x_max + room), ylim=(y_min - room, y_max + room), aspect="equal")


def size_of(scene: Scene, width: float = 6.5, below: float = 1.6) -> tuple[float, float]:
    """Width and height in inches that fit a scene, with room below for what is said there."""
    x_min, y_min, x_max, y_max = _window(scene)
    share = (y_max - y_min) / (x_max - x_min) if x_max > x_min else 2.0
    return width, min(max(share * width, 2.0), 2 * width) + below


def draw_plan(figure: Any, plan: PathPlan, others: Sequence[Path] = ()) -> None:
    """A planned path in its scene, thin lines for others; a path that collides is red and says so."""
    ax = figure.subplots()
    problem = plan.problem
    draw_scene(ax, problem.scene, problem.space.region if problem.space.clearance else None)
    for path in others:
        ax.plot(*path.points.T, color=BLUE, linewidth=1, alpha=0.4)
    ax.plot(*plan.path.points.T, "-o", color=BLUE if plan.success else RED, linewidth=2, markersize=3)
    ax.set_title(
        f"{plan.problem.scene.name}, {plan.method}: length {plan.length:.4g}, {_verdict(plan)}", fontsize="medium"
    )


def draw_runs(
    ax: Any,
    scene: Scene,
    runs: Sequence[Path],
    optimum: Path | None,
    colour: str = BLUE,
    colliding: Sequence[Path] = (),
) -> None:
    """Many runs over one another in their scene, the shortest path dashed, and dotted what collides."""
    draw_scene(ax, scene)
    alpha = max(0.08, min(0.6, 6 / max(len(runs) + len(colliding), 1)))
    for path in runs:
        ax.plot(*path.points.T, color=colour, linewidth=0.7, alpha=alpha)
    for path in colliding:
        ax.plot(*path.points.T, ":", color="black", linewidth=0.9, alpha=alpha)
    if optimum is not None:
        ax.plot(*optimum.points.T, "--", color="black", linewidth=1.4)


def draw_trajectory(figure: Any, plan: TrajectoryPlan, scene: Scene) -> None:
    """Path and motion in the scene; beside it speed, turning rate and clearance over time."""
    grid = figure.add_gridspec(3, 2, width_ratios=(1.25, 1))
    samples = plan.trajectory.sample()
    world = figure.add_subplot(grid[:, 0])
    draw_scene(world, scene)
    world.plot(*plan.route.path.points.T, "--", color=GREY, linewidth=1)
    _along(figure, world, samples.xy, samples.v)
    for k in np.linspace(0, len(samples.t) - 1, 12).astype(int):
        world.add_patch(_disc(samples.xy[k], plan.radius))
    world.set(xlabel="x, m", ylabel="y, m")
    verdict = "" if plan.success else ", collides" if not plan.collision_free else ", misses the goal"
    stops = f", with stops at all corners {plan.stop_and_turn:.2f} s" if np.isfinite(plan.stop_and_turn) else ""
    said = f"{plan.method}: driven in {plan.time:.2f} s{stops}{verdict}"
    world.set_title(said, fontsize="medium", color="black" if plan.success else RED)

    vehicle = plan.route.vehicle
    speed, turning, clear = (figure.add_subplot(grid[i, 1]) for i in range(3))
    speed.plot(samples.t, samples.v, color=BLUE)
    speed.axhline(vehicle.v_max, color=GREY, linewidth=0.8, linestyle=":", label="limit")
    speed.set_ylabel("speed, m/s")
    turning.plot(samples.t, np.degrees(samples.omega), color=RED)
    for side, name in ((-1, None), (1, "limits")):
        limit = side * np.degrees(vehicle.omega_at(samples.v))
        turning.plot(samples.t, limit, color=GREY, linewidth=0.8, linestyle=":", label=name)
    turning.set_ylabel("turning, deg/s")
    if plan.obstacles:
        clear.plot(
            samples.t, shapely.distance(shapely.points(samples.xy), shapely.union_all(plan.obstacles)), color=GREEN
        )
        clear.axhline(plan.radius, color=GREY, linewidth=0.8, linestyle=":", label="radius")
        clear.set_ylim(bottom=0)
    clear.set(xlabel="time, s", ylabel="clearance, m")
    for ax in (speed, turning, clear):
        ax.grid(alpha=0.3)
        ax.set_xlim(0, plan.time)
        if ax.get_legend_handles_labels()[0]:
            ax.legend(fontsize="small", framealpha=0.8)


def draw_curve(
    figure: Any, curve: Curve, obstacles: Sequence[shapely.Geometry] = (), footprint: Footprint | None = None
) -> None:
    """A curve among obstacles, forwards and backwards in two colours, with the vehicle's outline along it."""
    ax = figure.subplots()
    for obstacle in obstacles:
        _draw_obstacle(ax, obstacle)
    ends = curve.boundaries
    for a, b, length in zip(ends[:-1], ends[1:], curve.lengths, strict=True):
        xy = curve.poses(np.linspace(a, b, 40))[:, :2]
        ax.plot(*xy.T, color=BLUE if length >= 0 else RED, linewidth=2)
    for name, colour, driven in (("forwards", BLUE, 1), ("backwards", RED, -1)):
        if any(driven * length > 0 for length in curve.lengths):
            ax.plot([], [], color=colour, label=name)
    poses = curve.poses(np.linspace(0, curve.length, OUTLINES))
    if footprint is not None:
        for shape in shapely.buffer(footprint.at(poses), footprint.around):
            ax.plot(*shapely.get_coordinates(shape).T, color=GREY, linewidth=0.6)
    x, y, heading = curve.poses([0.0, curve.length]).T
    ax.quiver(x, y, np.cos(heading), np.sin(heading), color=[GREEN, RED], zorder=5, width=0.006)
    ax.set(aspect="equal", xlabel="x, m", ylabel="y, m")
    ax.set_title(f"{curve.word or 'no way at all'}: {curve.length:.4g} m, radius {curve.radius:g} m", fontsize="medium")
    ax.grid(alpha=0.3)
    ax.legend(fontsize="small", framealpha=0.8)


def draw_timed(figure: Any, plan: WaitingPath) -> None:
    """A path with times: robot and moving obstacles at the same times in the same colours, and where it waits."""
    ax = figure.subplots()
    scene, space = plan.problem.scene, plan.problem.space
    draw_scene(ax, scene, space.region if space.clearance else None)
    times = np.linspace(plan.times[0], plan.times[-1], MOMENTS)
    colours = _colours(figure, ax, times)
    for obstacle in plan.moving:
        ax.plot(*obstacle.at(np.linspace(times[0], times[-1], 200)).T, ":", color=GREY, linewidth=0.8)
        for colour, (x, y) in zip(colours, obstacle.at(times), strict=True):
            shape = shapely.buffer(obstacle.footprint.at(np.array([[x, y, 0.0]]))[0], obstacle.footprint.around)
            ax.plot(*shapely.get_coordinates(shape).T, color=colour, linewidth=1)
    ax.plot(*plan.path.points.T, color=BLUE, linewidth=1.5)
    for colour, place in zip(colours, plan.at(times), strict=True):
        ax.add_patch(_disc(place, space.clearance, colour))
        ax.plot(*place, "o", color=colour, markersize=4, zorder=6)
    for x, y, held in plan.waits:
        label = {"xytext": (0, 20), "textcoords": "offset points", "ha": "center", "fontsize": "small"}
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0}
        ax.annotate(f"waits {held:.3g} s", (x, y), bbox=box, zorder=7, **label)
    ax.set_title(
        f"{scene.name}: there after {plan.duration:.4g} s, {plan.direct:.4g} s if nothing moved"
        f"{'' if plan.success else ', collides'}",
        fontsize="medium",
    )


def draw_generations(figure: Any, problem: PathProblem, generations: Mapping[str, Population]) -> None:
    """The paths of a metaheuristic's generations side by side: thin the population, thick its best.

    Args:
        figure: An empty ``matplotlib.figure.Figure``.
        problem: What is planned.
        generations: By their titles, what ``Progress.population`` had of each.
    """
    columns = min(len(generations), WIDEST)
    rows = -(-len(generations) // columns)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes[len(generations) :]:
        ax.set_axis_off()
    for ax, (title, population) in zip(axes, generations.items(), strict=False):
        draw_generation(ax, problem, population)
        ax.set_title(f"{title}: best {population.costs.min():.4g}", fontsize="small")


def draw_generation(ax: Any, problem: PathProblem, population: Population) -> None:
    """The paths of one generation on axes: thin the population, thick its best, dashed the shortest."""
    paths = [problem.through(x) for x in population.X]
    draw_runs(ax, problem.scene, paths, None)
    best = paths[int(population.costs.argmin())]
    free = problem.space.holds(best.points)
    ax.plot(*best.points.T, "-o", color=BLUE if free else RED, linewidth=1.8, markersize=3)
    ax.tick_params(labelsize="x-small")


def _draw_obstacle(ax: Any, obstacle: shapely.Geometry) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    match obstacle.geom_type:
        case "Polygon":
            outlines = [Outline(np.vstack((ring, ring[:1])), closed=True) for ring in rings(obstacle)]
            shape = Outline.make_compound_path(*outlines)
            ax.add_patch(PathPatch(shape, facecolor=STONE, edgecolor=EDGE, linewidth=0.8))
        case "LineString":
            ax.plot(*shapely.get_coordinates(obstacle).T, color=EDGE, linewidth=1.2)
        case _:
            ax.plot(*shapely.get_coordinates(obstacle).T, "s", color=EDGE, markersize=2.5)


def _colours(figure: Any, ax: Any, times: Array) -> Any:
    """A colour for each time, with their scale."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    scale = ScalarMappable(Normalize(times[0], times[-1]), "viridis")
    figure.colorbar(scale, ax=ax, location="bottom", shrink=0.6, label="time, s")
    return scale.to_rgba(times)


def _along(figure: Any, ax: Any, xy: Array, v: Array) -> None:
    """A line coloured by the speed."""
    from matplotlib.collections import LineCollection

    pieces = np.stack((xy[:-1], xy[1:]), axis=1)
    line = LineCollection(list(pieces), array=(v[:-1] + v[1:]) / 2, cmap="viridis", linewidth=2.5)
    ax.add_collection(line)
    figure.colorbar(line, ax=ax, location="bottom", shrink=0.6, label="speed, m/s")


def _disc(centre: Array, radius: float, colour: Any = GREY) -> Any:
    from matplotlib.patches import Circle

    return Circle(tuple(centre), radius, facecolor="none", edgecolor=colour, linewidth=0.7)


def _verdict(plan: PathPlan) -> str:
    if not plan.success:
        return "none found" if plan.status is PathStatus.NOT_FOUND else "goes through an obstacle"
    return "the shortest" if not plan.gap else f"{100 * plan.gap:.2f} % above the shortest"


def _window(scene: Scene) -> tuple[float, float, float, float]:
    if scene.bounds is not None:
        return scene.bounds
    everything = shapely.union_all([shapely.MultiPoint([scene.start, scene.goal]), *scene.obstacles])
    x_min, y_min, x_max, y_max = everything.bounds
    return x_min, y_min, x_max, y_max
