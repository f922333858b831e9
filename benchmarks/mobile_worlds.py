"""What the mobile planners make of many and of large worlds: sections of the page that ``mobile.py`` writes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import TypeVar

import numpy as np
from mobile_truth import FAMILIES, shortest_length
from scipy import ndimage
from scipy.sparse.csgraph import dijkstra

from pin_metaik import mobile

Found = TypeVar("Found")
Row = list[object]

SEEDS = 132  # scenes of each of five families: 660
EQUAL = 1e-6  # of lengths around 10
WHOLE = 5_000  # corners up to which all lines of sight are looked for, to compare
VERTICES = 20_000  # of one outline
SHARPEST = 1e-4  # s by which the search may be ahead


def spent(work: Callable[[], Found]) -> tuple[Found, float]:
    """What some work makes, and its processor time in s."""
    began = time.process_time()
    found = work()
    return found, time.process_time() - began


def against_another_graph(seeds: int) -> Iterator[tuple[list[str], Row]]:
    """A row for each family of random scenes: lengths against every pair of vertices tested by shapely."""
    heading = ["scenes", "number", "without a path", "other length", "other answer", "largest difference"]
    for name, make in FAMILIES.items():
        none, other, answers, worst = 0, 0, 0, 0.0
        for seed in range(seeds):
            scene = make(np.random.default_rng(seed))
            expected = shortest_length(scene.start, scene.goal, scene.obstacles, scene.bounds)
            try:
                length = mobile.plan_path(scene).length
            except mobile.NoPath:
                length = np.inf
            none += expected == np.inf
            answers += (length == np.inf) != (expected == np.inf)
            if max(length, expected) < np.inf:
                other += abs(length - expected) > EQUAL
                worst = max(worst, abs(length - expected))
        yield heading, [name, seeds, none, other, answers, f"{worst:.1e}"]


def specks(count: int) -> mobile.Scene:
    """A map of 50 x 50 m in cells of 5 cm, with single occupied ones."""
    cells = np.zeros((1000, 1000), dtype=bool)
    cells[tuple(np.random.default_rng(0).integers(5, 995, (2, count)))] = True
    grid = mobile.grid_of(cells, resolution=0.05)
    return mobile.Scene((0.1, 0.1), (49.9, 49.9), grid.polygons, grid.bounds)


def open_worlds(counts: tuple[int, ...]) -> Iterator[tuple[list[str], Row]]:
    """Rows for worlds of many small obstacles: first paths, and what a whole visibility graph would take."""
    heading = ["world", "corners", "length", "first path, s", "with all lines of sight, s", "times as long"]
    worlds = {f"{count:,} specks": specks(count) for count in counts}
    worlds |= {f"{n:,} polygons": mobile.random_scene(n, 0, size=100.0, gap=0.05) for n in counts if n <= 2000}
    for name, scene in worlds.items():
        plan, first = spent(lambda scene=scene: mobile.plan_path(scene))
        problem = mobile.PathProblem.of(scene)
        corners = len(problem.visibility.border.corners)
        whole: Row = ["", ""]
        if corners <= WHOLE:
            length, took = spent(lambda scene=scene: by_the_whole_graph(scene))
            assert abs(length - plan.length) < EQUAL
            whole = [f"{took:.2f}", f"{took / first:.0f}"]
        yield heading, [name, f"{corners:,}", f"{plan.length:.3f}", f"{first:.2f}", *whole]


def by_the_whole_graph(scene: mobile.Scene) -> float:
    """The length of the shortest path by Dijkstra over all lines of sight."""
    space = mobile.FreeSpace.of(scene)
    graph = mobile.Visibility(space).between(scene.start, scene.goal)
    return float(dijkstra(graph.weights, indices=graph.start)[graph.goal])


def country(width: int) -> mobile.OccupancyGrid:
    """A map of so many cells of 5 cm each way, hills and valleys."""
    height = ndimage.gaussian_filter(np.random.default_rng(0).standard_normal((width, width)), 12)
    occupied = height > np.quantile(height, 0.7)
    occupied[:40, :40] = occupied[-40:, -40:] = False
    return mobile.grid_of(occupied, resolution=0.05)


def outline(rough: float) -> mobile.Scene:
    """One obstacle of many vertices, wavy or rough, between start and goal."""
    rng, angle = np.random.default_rng(0), 2 * np.pi * np.arange(VERTICES) / VERTICES
    walk = rng.standard_normal(VERTICES).cumsum() / np.sqrt(VERTICES)
    radius = 3 + 0.4 * np.sin(37 * angle) + rough * walk
    return mobile.Scene((-6, 0), (6, 0), [radius[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))])


def large_worlds(width: int) -> Iterator[tuple[list[str], Row]]:
    """Rows for a large map and for outlines of many vertices."""
    heading = ["world", "vertices", "radius", "to polygons, s", "free space, s", "first path, s", "length"]
    grid = country(width)
    polygons, took = spent(lambda: grid.polygons)
    end = 0.05 * width - 0.3
    hills = mobile.Scene((0.3, 0.3), (end, end), polygons, grid.bounds)
    worlds = {f"{width:,} x {width:,} cells": (hills, f"{took:.1f}")}
    worlds |= {f"a {word} outline": (outline(rough), "") for word, rough in (("wavy", 0.0), ("rough", 0.05))}
    for name, (scene, read) in worlds.items():
        for radius in (0.0, 0.2):
            problem, grown = spent(lambda scene=scene, radius=radius: mobile.PathProblem.of(scene, radius))
            plan, first = spent(lambda problem=problem: mobile.plan_path(problem))
            assert plan.verify()
            vertices = sum(len(ring) for ring in outlines(scene))
            times = [f"{grown:.1f}", f"{first:.1f}"]
            yield heading, [name, f"{vertices:,}", radius, read, *times, f"{plan.length:.3f}"]


def outlines(scene: mobile.Scene) -> Iterator[np.ndarray]:
    """The rings of a scene's obstacles."""
    for obstacle in scene.obstacles:
        for ring in (obstacle.exterior, *obstacle.interiors):
            yield np.asarray(ring.coords)[:-1]


def sharp_polylines(count: int) -> Iterator[tuple[list[str], Row]]:
    """One row: dynamic programming against differential evolution on polylines of two to four sharp corners."""
    heading = ["polylines", "most that de is ahead, s", f"ahead by {SHARPEST:g} s", "de behind by 1 ms", "most, s"]
    rng, ahead = np.random.default_rng(0), []
    for seed in range(count):
        path = np.vstack(((0, 0), rng.normal(0, 2, (rng.integers(3, 6), 2)).cumsum(axis=0)))
        best, found = (mobile.plan_trajectory(path, method=method, rng=seed).time for method in ("dp", "de"))
        ahead.append(best - found)
    ahead = np.array(ahead)
    most = [
        f"{ahead.max():.1e}",
        int((ahead > SHARPEST).sum()),
        int((ahead < -1e-3).sum()),
        f"{max(0.0, -ahead.min()):.3f}",
    ]
    yield heading, [count, *most]


def learned_turns(iterations: tuple[int, ...]) -> Iterator[tuple[list[str], Row]]:
    """A row for each length of training: errors of the network, and where its plans end."""
    heading = ["iterations", "s to learn", "E0, %", "Em, %", "ends off the goal on five scenes, mm"]
    for number in iterations:
        model, took = spent(lambda number=number: mobile.learn_turn(mobile.NOMAD_200, iterations=number))
        ends = []
        for seed in range(1, 6):
            scene = mobile.random_scene(15, seed, gap=0.76)
            path = mobile.PathProblem.of(scene, mobile.NOMAD_200.radius, 0.1).optimum
            plan = mobile.plan_trajectory(path, mobile.NOMAD_200, scene.obstacles, method="ann", model=model)
            ends.append(1e3 * plan.end_error)
        errors = model.errors()
        shown = [f"{took:.1f}", f"{errors.E0:.4f}", f"{errors.Em:.2f}", ", ".join(f"{end:.2f}" for end in ends)]
        yield heading, [f"{number:,}", *shown]


def dense_paths() -> Iterator[tuple[list[str], Row]]:
    """Rows for paths as samplers and grids make them, driven as they are and simplified."""
    heading = ["path", "corners", "length / v_max, s", "as it is, s", "simplified(0.05), s", "corners left"]
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    zigzag = 0.05 * np.column_stack((np.arange(200), np.arange(200) % 2))
    paths = {"a circle, 5 m": 5 * np.column_stack((np.cos(angle), np.sin(angle))), "a zigzag of 5 cm": zigzag}
    for name, points in paths.items():
        path = mobile.Path(points)
        simple = path.simplified(0.05)
        times = [mobile.plan_trajectory(each).time for each in (path, simple)]
        shown = [f"{seconds:.1f}" for seconds in (path.length / mobile.NOMAD_200.v_max, *times)]
        yield heading, [name, len(path.corners), *shown, len(simple.corners)]
