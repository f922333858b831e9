"""Paths among polygons by GA and PSO: 100 runs each, judged by an exact test and against the shortest path."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from statistics import median
from typing import Any

from pin_metaik.compare.papers.claims import claims_table
from pin_metaik.compare.papers.paper import Job, Options, Paper
from pin_metaik.compare.papers.path_planning_claims import claims, trials_of
from pin_metaik.compare.papers.path_planning_setup import (
    SEGMENTS,
    SETTINGS,
    TRAP,
    ExactTrial,
    HitTrial,
    PathTrial,
    exact,
    hit_test,
    problem,
    search,
    warm_up,
)
from pin_metaik.compare.planners.figures import Overlaid, overlay, times
from pin_metaik.compare.report import Column, Figure, Section, Table, Value, plots

C_P = 120.0  # all scenes are 10 x 10
FITNESSES = ("paper", "exact")
METHODS = ("GA", "PSO")
TRAP_RUNS = 10


def jobs(options: Options) -> Iterator[Job[Any]]:
    """The exact planner and the hit test on every scene, then all runs; the trap once."""
    problems = {name: problem(setting) for name, setting in {**SETTINGS, "U trap": TRAP}.items()}
    for name, each in problems.items():
        yield Job(f"{name}, compiling", partial(warm_up, each), 0.1)
        yield Job(f"{name}, exact", partial(exact, name, each), 0.3)
        yield Job(f"{name}, hit test", partial(hit_test, name, each, options.generator(0)), 0.3)
    for run in range(options.runs):
        for number, (name, setting) in enumerate(SETTINGS.items()):
            for fitness in FITNESSES:
                for method in METHODS:
                    work = search(name, setting, problems[name], method, fitness, run, options.generator(number, run))
                    yield Job(f"{name}, {method}, {fitness} fitness, run {run + 1}", work, setting.agents / 50)
        if run < TRAP_RUNS:
            for method in METHODS:
                work = search("U trap", TRAP, problems["U trap"], method, "paper", run, options.generator(9, run))
                yield Job(f"U trap, {method}, run {run + 1}", work)


def sections(done: Sequence[Any], options: Options) -> list[Section]:
    """The two methods on every scene, what the paper claims, its fitness in a pocket, its hit test, and the figures."""
    trials = [trial for trial in done if isinstance(trial, PathTrial)]
    return [
        Section(
            "GA and PSO",
            (
                "The paper prints no obstacles: the scenes are ours, with its start, goal, numbers and constants. A "
                "run is free if an exact test on the true obstacles says so; gaps are over free runs.",
            ),
            (claims_table("path_planning_claims", claims(trials)), comparison(trials), every_run(trials)),
            figures(trials),
        ),
        Section(
            "The shortest path",
            (speed(done),),
            (shortest([trial for trial in done if isinstance(trial, ExactTrial)]),),
        ),
        Section("A start in the pocket of a concave obstacle", (pocket(trials),)),
        Section(
            "The paper's hit test",
            (
                "It takes the line of a segment for the segment and relies on bounding boxes to tell "
                "them apart: it misses no hit, and reports some that are none.",
                invariant(trials),
            ),
            (hit_table([trial for trial in done if isinstance(trial, HitTrial)]),),
        ),
    ]


def comparison(trials: Sequence[PathTrial]) -> Table:
    """Every scene, fitness and method, in numbers."""
    rows: list[tuple[Value, ...]] = []
    for scene in SETTINGS:
        for fitness in FITNESSES:
            for method in METHODS:
                runs = trials_of(trials, scene, method, fitness)
                if runs:
                    gaps = [100 * trial.gap for trial in runs if trial.gap is not None]
                    gap = (min(gaps), median(gaps), max(gaps)) if gaps else (None, None, None)
                    free = 100 * sum(trial.free for trial in runs) / len(runs)
                    cost, ms = median(trial.f for trial in runs), 1e3 * median(trial.seconds for trial in runs)
                    rows.append((scene, fitness, method, len(runs), free, *gap, cost, ms))
    columns = (
        *(Column("scene"), Column("fitness"), Column("method"), Column("runs"), Column("free %", ".0f")),
        *(Column("best gap %", ".2f"), Column("median gap %", ".2f"), Column("worst gap %", ".1f")),
        *(Column("median f", ".2f"), Column("ms a run", ".1f")),
    )
    return Table("path_planning", "Gap to the shortest path", columns, rows)


def speed(done: Sequence[Any]) -> str:
    """The exact planner against the searches, in a sentence."""
    exact = {trial.scene: trial.seconds for trial in done if isinstance(trial, ExactTrial)}
    searches = [t for t in done if isinstance(t, PathTrial) and t.scene in exact and t.fitness == "paper"]
    if not searches:
        return "A visibility graph and Dijkstra's algorithm give the shortest path itself, without a seed."
    ratios = [t.seconds / exact[t.scene] for t in searches]
    return (
        "A visibility graph and Dijkstra's algorithm give the shortest path itself, without a seed, and proven free; a "
        f"run of GA or PSO takes {median(ratios):.0f} times as long (median)."
    )


def shortest(trials: Sequence[ExactTrial]) -> Table:
    """The shortest paths."""
    columns = (Column("scene"), Column("length", ".9f"), Column("corners"), Column("processor ms", ".1f"))
    rows: list[tuple[Value, ...]] = [(t.scene, t.length, t.corners, 1e3 * t.seconds) for t in trials]
    return Table("path_planning_exact", "Shortest paths, from the polygons on", columns, rows)


def pocket(trials: Sequence[PathTrial]) -> str:
    """The effect of convex hulls on a start in a pocket, in a sentence."""
    runs = [trial for trial in trials if trial.scene == "U trap"]
    if not runs:
        return "Not run."
    clean, free, best = sum(t.f < C_P for t in runs), sum(t.free for t in runs), min(t.f for t in runs)
    return (
        f"U trap: the paper fills pockets in, so its fitness penalises every path out of one. {clean} of {len(runs)} "
        f"runs end without a penalty (best f {best:.1f}), and {free} are free. The exact planner gets out."
    )


def invariant(trials: Sequence[PathTrial]) -> str:
    """Whether a fitness below c_p means free, in a sentence."""
    below = [trial.free for trial in trials if trial.f < C_P]
    return (
        f"A fitness below c_p = {C_P:g} has no penalty in it. Of {len(below)} such runs {sum(below)} are free by the "
        "exact test."
    )


def hit_table(trials: Sequence[HitTrial]) -> Table:
    """The hit test in numbers."""
    columns = (
        Column("scene"),
        Column("hits", ","),
        Column("missed"),
        Column("made up"),
        Column("% of the hits", ".1f"),
    )
    rows: list[tuple[Value, ...]] = [
        (t.scene, t.hits, t.missed, t.invented, 100 * t.invented / t.hits if t.hits else None) for t in trials
    ]
    return Table("path_planning_hits", f"{SEGMENTS:,} random segments against the convex hulls", columns, rows)


def every_run(trials: Sequence[PathTrial]) -> Table:
    """Every run, for the CSV file."""
    headings = ("scene", "method", "fitness", "run", "f", "length", "free", "gap", "seconds")
    rows: list[tuple[Value, ...]] = [
        (t.scene, t.method, t.fitness, t.run, t.f, t.length, int(t.free), t.gap, t.seconds) for t in trials
    ]
    return Table("path_planning_runs", "Every run", tuple(map(Column, headings)), rows, shown=False)


def figures(trials: Sequence[PathTrial]) -> tuple[Figure, ...]:
    """The paper's Figs. 10 to 13: convergence, time of every run, and the paths of all runs."""
    trials = [trial for trial in trials if trial.fitness == "paper" and trial.scene in SETTINGS]
    scenes = list(dict.fromkeys(trial.scene for trial in trials))
    if not scenes:
        return ()

    def convergence(canvas: Any) -> None:
        panels = {
            scene: {method: [t.trace for t in trials_of(trials, scene, method, "paper")] for method in METHODS}
            for scene in scenes
        }
        plots.convergence(canvas, panels, "best fitness so far", 1e-3)

    def duration(canvas: Any) -> None:
        times(
            canvas,
            {
                scene: {method: [t.seconds for t in trials_of(trials, scene, method, "paper")] for method in METHODS}
                for scene in scenes
            },
        )

    def paths(canvas: Any) -> None:
        worlds = {scene: problem(SETTINGS[scene]) for scene in scenes}
        runs = {method: {scene: trials_of(trials, scene, method, "paper") for scene in scenes} for method in METHODS}
        rows = {
            method: {scene: Overlaid([t.points for t in ran], [t.free for t in ran]) for scene, ran in by.items()}
            for method, by in runs.items()
        }
        overlay(canvas, worlds, rows)

    wide = plots.size(*[1] * len(scenes))
    return (
        Figure(
            "path_planning_paths",
            "All runs over one another, dotted if they collide; dashed: the shortest path.",
            paths,
            (wide[0], 7.6),
        ),
        Figure("path_planning_convergence", "Best fitness so far: medians thick, runs thin.", convergence, wide),
        Figure("path_planning_times", "Processor time of every run.", duration, wide),
    )


PATH_PLANNING = Paper(
    "path_planning",
    "Paths among polygons by GA and PSO",
    "Toz, Erdogmus and Sahin, e-J. New World Sci. Acad. 6(4), 2011, 1A0269",
    100,
    jobs,
    sections,
)
