"""Path planners side by side, and paths with times among obstacles that move.

    pip install -e '.[planners]'
    python benchmarks/mobile_planners.py --out benchmarks/mobile_planners.md

Six minutes; ``--quick`` takes one. Times are processor time of this process.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import numpy as np
import shapely

from pin_metaik import mobile
from pin_metaik.compare.planners.report import comparison_table
from pin_metaik.compare.planners.run import compare_planners
from pin_metaik.compare.report.write import markdown_table
from pin_metaik.optimize import Budget

METHODS = ("exact", "astar", "rrt", "rrtconnect", "rrtstar", "informed", "prm", "ga", "pso", "de", "sfla")
BUDGETS = (500, 5_000, 50_000)
CELLS = (25, 50, 100, 200, 400)


def table(heading: list[str], rows: list[list[object]]) -> str:
    lines = [heading, ["---"] + ["---:"] * (len(heading) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def narrow() -> mobile.Scene:
    """Two rooms and a gap of 10 cm between them, off the straight line."""
    walls = [[(4.9, 0.0), (5.1, 0.0), (5.1, 7.0), (4.9, 7.0)], [(4.9, 7.1), (5.1, 7.1), (5.1, 10.0), (4.9, 10.0)]]
    return mobile.Scene((1.0, 2.0), (9.0, 2.0), walls, (0.0, 0.0, 10.0, 10.0), "a gap of 10 cm")


def scenes() -> list[mobile.PathProblem]:
    concave = mobile.random_scene(20, 3, concave=0.6, gap=0.3)
    stars = mobile.Scene(concave.start, concave.goal, concave.obstacles, concave.bounds, "20, 60 % concave")
    given = [mobile.load_scene(name) for name in ("ten_obstacles", "fifteen_obstacles", "u_trap")]
    return [*map(mobile.PathProblem.of, given), mobile.PathProblem.of(stars, 0.1), mobile.PathProblem.of(narrow())]


def planners(runs: int) -> Iterator[str]:
    yield "## Planners\n"
    yield (
        f"5,000 evaluations, {runs} runs; deterministic planners run once. An evaluation is a path of a metaheuristic "
        "over five via points, or a straight line that another planner tests: equal evaluations are not equal work. "
        "Gaps to the shortest path are over the runs whose path is free by the exact test; times are from the free "
        "space on. The same table for scenes of one's own: `pin-metaik mobile compare SCENE...`.\n"
    )
    yield markdown_table(comparison_table(compare_planners(scenes(), METHODS, runs))) + "\n"


def budgets(runs: int) -> Iterator[str]:
    yield "## Larger budgets and finer grids\n"
    yield "ten_obstacles: median gap in percent, and of how many runs a path is free, by the budget of evaluations.\n"
    problem, methods = scenes()[0], ("rrt", "rrtstar", "informed", "prm", "ga", "pso")
    rows: list[list[object]] = []
    found = {most: compare_planners(problem, methods, runs, budget=Budget(evaluations=most)) for most in BUDGETS}
    for method in methods:
        cells = []
        for most in BUDGETS:
            gaps = [100 * run.plan.gap for run in found[most].of("ten_obstacles", method) if run.plan.gap is not None]
            cells.append(f"{np.median(gaps):.2f} ({len(gaps)} of {runs})" if gaps else f"- (0 of {runs})")
        rows.append([method, *cells])
    yield table(["planner", *(f"{most:,}" for most in BUDGETS)], rows) + "\n"
    yield "A* by the cells along a side; eight directions cost up to 8.24 percent, however fine the grid is.\n"
    rows = []
    for cells in CELLS:
        began = time.process_time()
        plan = mobile.plan_path(problem, mobile.GridAStar(cells))
        gap = "none found" if plan.gap is None else f"{100 * plan.gap:.2f}"
        rows.append([cells, gap, f"{plan.evaluations:,}", f"{1e3 * (time.process_time() - began):.0f}"])
    yield table(["cells", "gap, %", "lines tested", "ms"], rows) + "\n"


def drawn(seed: int) -> tuple[mobile.PathProblem, list[mobile.MovingObstacle], float]:
    """A random scene, four to eight things that drive about in it, and a speed."""
    rng = np.random.default_rng(seed)
    problem = mobile.PathProblem.of(mobile.random_scene(8, seed, gap=0.5), 0.1)
    moving = []
    for _ in range(rng.integers(4, 9)):
        times = np.cumsum(rng.uniform(0.5, 6.0, 5))
        outline = mobile.Footprint(rng.uniform(-0.7, 0.7, (5, 2)), rng.uniform(0.0, 0.3))
        moving.append(mobile.MovingObstacle(outline, np.column_stack((times, rng.uniform(1.0, 9.0, (5, 2))))))
    return problem, moving, float(rng.uniform(0.5, 2.0))


def among_moving(count: int) -> Iterator[str]:
    yield "## Obstacles that move\n"
    yield (
        "Random scenes of 8 obstacles with 4 to 8 more that drive about, radius 0.1; places to turn and wait are "
        "start, goal, corners and the middles of cells. Clearance by the exact distance of relative motions, and by "
        "4,000 samples. Arrival over the time of the shortest path if nothing moved.\n"
    )
    rows: list[list[object]] = []
    for cells in (0, 8, 16, 32):
        found = none = waits = worse = 0
        least, ratios, took, opened = np.inf, [], [], []
        for seed in range(count):
            problem, moving, speed = drawn(seed)
            began = time.process_time()
            try:
                plan = mobile.plan_among_moving(problem, moving, speed, cells=cells)
            except mobile.NoTimedPath:
                none += 1
                continue
            took.append(time.process_time() - began)
            found += plan.success
            waits += bool(plan.waits)
            least = min(least, plan.clearance - problem.space.clearance)
            t = np.linspace(plan.times[0], plan.times[-1] + 10.0, 4000)
            for obstacle in moving:
                seen = shapely.points(plan.at(t) - obstacle.at(t))
                gap = shapely.distance(seen, obstacle.footprint.at(np.zeros((1, 3)))[0]).min()
                worse += gap - obstacle.footprint.around < problem.space.clearance - 1e-9
            ratios.append(plan.duration / plan.direct)
            opened.append(plan.opened)
        rows.append(
            [
                cells,
                count,
                found,
                none,
                waits,
                f"{least:.1e}",
                worse,
                f"{np.median(ratios):.3f}",
                f"{max(ratios):.2f}",
                f"{np.median(opened):.0f}",
                f"{1e3 * np.median(took):.0f}",
                f"{1e3 * max(took):.0f}",
            ]
        )
    heading = ["cells", "scenes", "free", "none", "with waits", "least beyond the clearance", "nearer by samples"]
    yield table([*heading, "arrival, median", "most", "windows opened", "ms, median", "most"], rows) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="Where to write the page.")
    parser.add_argument("--quick", action="store_true", help="A tenth of the runs.")
    options = parser.parse_args()
    flags = "".join(f" --{name}" for name, value in (("quick", options.quick),) if value)
    out = f" --out {options.out}" if options.out else ""
    machine = f"{os.cpu_count()}-core {platform.machine()}, shared"
    packages = ", ".join(f"{name} {version(name)}" for name in ("ompl", "networkx", "shapely"))
    blocks = [
        "# Path planners, and obstacles that move\n",
        f"`python benchmarks/mobile_planners.py{out}{flags}`, {datetime.date.today()}, {machine}; {packages}.\n",
    ]
    share = 10 if options.quick else 1
    for part in (planners(20 // share), budgets(10 // share), among_moving(60 // share)):
        for block in part:
            print(block)
            blocks.append(block)
    if options.out:
        options.out.write_text("\n".join(blocks), encoding="utf-8")


if __name__ == "__main__":
    main()
