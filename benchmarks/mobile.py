"""What the mobile planners take and reach, longer than the tests can wait for.

    pip install -e '.[mobile,plots]'
    python benchmarks/mobile.py --out benchmarks/mobile.md

An hour, most of it for the networks of the paper on learned turns; ``--quick`` takes a minute. Reports that are there
already are not made again. Times on the page are processor time of this process, so that a busy machine does not count;
ratios mean more than digits.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

import mobile_worlds as worlds
import numpy as np
import shapely

from pin_metaik import mobile
from pin_metaik.learn import fit
from pin_metaik.mobile.motion.turn import lead_time
from pin_metaik.mobile.motion.turn_data import clustered_points, coarse_grid, fine_grid
from pin_metaik.optimize import Budget
from pin_metaik.optimize.de import DE
from pin_metaik.optimize.ga import GA
from pin_metaik.optimize.pso import PSO

GAP = 0.75  # m between obstacles: the Nomad 200 with a margin of 0.1 m fits through most


def cpu(work: Callable[[], object], repeats: int = 5) -> float:
    """Median processor time of one call, ms, after one that may compile."""
    work()
    times = []
    for _ in range(repeats):
        began = time.process_time()
        work()
        times.append(1e3 * (time.process_time() - began))
    return median(times)


def table(heading: list[str], rows: list[list[object]], numbers: str = "---:") -> str:
    lines = [heading, ["---"] + [numbers] * (len(heading) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def exact_times() -> Iterator[str]:
    rows = []
    for count in (15, 50, 150, 500):
        scene = mobile.random_scene(count, 0)
        for radius in (0.0, 0.03):
            problem = mobile.PathProblem.of(scene, radius)
            whole = cpu(lambda scene=scene, radius=radius: mobile.plan_path(mobile.PathProblem.of(scene, radius)))
            graph = problem.visibility
            again = cpu(lambda p=problem: mobile.shortest_path(p.space, p.scene.start, p.scene.goal, p.visibility))
            k_best = cpu(lambda p=problem: p.alternatives(5), 3)
            corners, edges = len(graph.border.corners), int(graph.mutual.sum()) // 2
            rows.append([count, radius, corners, edges, *(f"{ms:.1f}" for ms in (whole, again, k_best))])
    yield "## The exact planner\n"
    yield "ms from the polygons to a proved shortest path; another query in the same scene; five alternatives.\n"
    heading = ["polygons", "radius", "corners", "edges", "from polygons", "another query", "5 alternatives"]
    yield table(heading, rows)


def planners(runs: int) -> Iterator[str]:
    contenders = {
        "GA (Table 2)": GA(agents=50, crossover_rate=0.9, mutation_rate=0.4),
        "GA tournament, blend": GA(agents=50, crossover_rate=0.9, selection="tournament", crossover="blend"),
        "PSO (Table 2)": PSO(agents=50, variant="inertia", c1=2.0, c2=2.0, w_max=1.2, w_min=0.4, v_max=0.1),
        "PSO constriction": PSO(agents=50),
        "DE rand/1": DE(agents=50),
        "DE best/1": DE(agents=50, strategy="best/1/bin"),
        **{name: name for name in ("mtde", "gwo", "igwo", "sfla", "qpso", "cmaes")},
    }
    scenes = {name: mobile.load_scene(name) for name in ("ten_obstacles", "fifteen_obstacles")}
    scenes |= {f"random:{seed}": mobile.random_scene(15, seed, start=(0.1, 0.1), goal=(8.5, 8)) for seed in range(10)}
    problems = {name: mobile.PathProblem.of(scene) for name, scene in scenes.items()}
    rows = []
    for label, method in contenders.items():
        gaps: list[float] = []
        medians, free, spent = [], 0, 0.0
        for problem in problems.values():
            began = time.process_time()
            plans = [mobile.plan_path(problem, method, fitness="paper", rng=run) for run in range(runs)]
            spent += time.process_time() - began
            found = [plan.gap for plan in plans if plan.gap is not None]
            free += len(found)
            gaps += found
            medians += [median(found)] if found else []
        total = runs * len(problems)
        cells = [min(gaps), median(gaps), max(medians)] if gaps else []
        rows.append(
            [label, f"{100 * free / total:.0f}", *(f"{100 * gap:.2f}" for gap in cells), f"{1e3 * spent / total:.0f}"]
        )
    yield "## Metaheuristics over five via points, the paper's fitness, 5,000 evaluations\n"
    yield f"{len(problems)} scenes, {runs} runs each; gaps to the shortest path in percent, of free runs.\n"
    yield table(["planner", "free %", "best gap", "median gap", "worst scene's median", "ms a run"], rows)

    problem, rows = problems["ten_obstacles"], []
    for label, method in (("GA", GA(agents=100, mutation_rate=0.1)), ("PSO", contenders["PSO (Table 2)"])):
        for budget in (10_000, 100_000):
            plans = [
                mobile.plan_path(problem, method, fitness="paper", via=2, budget=Budget(evaluations=budget), rng=run)
                for run in range(8)
            ]
            rows.append(
                [label, f"{budget:,}", ", ".join(f"{100 * plan.gap:.2f}" for plan in plans if plan.gap is not None)]
            )
    others = [
        f"{100 * (path.length / problem.optimum.length - 1):.2f} ({len(path.corners)})"
        for path in problem.alternatives(10)
    ]
    yield "\n\nTen times the evaluations on ten_obstacles, two via points, gaps of eight runs in percent:\n"
    yield table(["planner", "evaluations", "gaps"], rows)
    yield (
        f"\n\nThe shortest paths of the best homotopy classes are {', '.join(others)} percent above the optimum, in "
        "brackets their corners. A search that ends there is on the wrong side of an obstacle; with two via points it "
        "cannot quite follow a path of three corners."
    )


def trajectories(scenes: int) -> Iterator[str]:
    rows, seed = [], 0
    worst_clearance, worst_end = np.inf, 0.0
    while len(rows) < scenes:
        scene = mobile.random_scene(15, seed, gap=GAP)
        seed += 1
        try:
            problem = mobile.PathProblem.of(scene, mobile.NOMAD_200.radius, 0.1)
            path = problem.optimum
        except mobile.NoPath:
            continue
        dp = mobile.plan_trajectory(path, obstacles=scene.obstacles)
        de = mobile.plan_trajectory(path, obstacles=scene.obstacles, method="de")
        fast = mobile.fastest_trajectory(scene)
        ms = cpu(lambda p=path, s=scene: mobile.plan_trajectory(p, obstacles=s.obstacles))
        worst_clearance = min(worst_clearance, *(plan.clearance - plan.radius for plan in (dp, de, fast)))
        worst_end = max(worst_end, *(plan.end_error for plan in (dp, de, fast)))
        assert dp.success and de.success and fast.success
        times = (dp.stop_and_turn, dp.time, max(0.0, 100 * (de.time / dp.time - 1)), fast.time)
        rows.append([seed - 1, len(dp.v), *(f"{value:.3f}" for value in times), f"{ms:.1f}"])
    yield "\n\n## Trajectories of the Nomad 200 through 15 random obstacles\n"
    yield (
        "Times in s with stops and by dynamic programming; percent that differential evolution is above it; the "
        "fastest over three paths and four margins; ms of processor time to plan.\n"
    )
    yield table(["scene", "corners", "stops", "dp", "de above %", "fastest", "ms"], rows)
    yield (
        f"\n\nLeast clearance beyond the radius: {worst_clearance:.1e} m. Largest distance of an end from its goal: "
        f"{worst_end:.1e} m."
    )


def times() -> Iterator[str]:
    vehicle = mobile.NOMAD_200
    grid, (v, theta) = fine_grid(vehicle), coarse_grid(vehicle).T
    X, y = np.column_stack((v, theta)), v * lead_time(theta, vehicle)
    cluster = cpu(lambda: clustered_points(vehicle, iterations=10), 1)
    rows = [
        ["23,779 tangent lengths, closed form", cpu(lambda: grid[:, 0] * lead_time(grid[:, 1], vehicle), 20)],
        ["3,000 iterations of Levenberg-Marquardt, 2:5:5:1", 10 * cpu(lambda: fit(X, y, (5, 5), "lm", 300), 3)],
        ["150 iterations of fuzzy c-means, 23,779 points, 1,064 centres", 15 * cluster],
    ]
    yield "\n\n## Other times\n"
    yield table(["work", "ms"], [[work, f"{ms:,.1f}"] for work, ms in rows])


Rows = Iterator[tuple[list[str], list[object]]]


def section(title: str, said: str, rows: Rows) -> Iterator[str]:
    """A section with one table."""
    found = list(rows)
    yield f"\n\n## {title}\n"
    yield f"{said}\n"
    yield table(found[0][0], [row for _, row in found])


def many_worlds(few: bool) -> Iterator[str]:
    yield from section(
        "Against another visibility graph",
        "Random scenes, shortest lengths by shapely and scipy: every vertex to every vertex, a way closed where two "
        "obstacles, or one and a wall, touch.",
        worlds.against_another_graph(5 if few else worlds.SEEDS),
    )
    yield from section(
        "Open worlds",
        "From the polygons to a first path from corner to corner, processor time; and by Dijkstra over all lines of "
        "sight, in the same run.",
        worlds.open_worlds((200,) if few else (1000, 2000, 3000)),
    )
    yield from section(
        "Large worlds",
        "A map of hills, 5 cm a cell, and one obstacle of 20,000 vertices; processor time. Free space is where a robot "
        "of the radius may be.",
        worlds.large_worlds(400 if few else 2000),
    )
    yield from section(
        "Sharp polylines",
        "Two to four corners at random: how far differential evolution is ahead of dynamic programming, or behind it.",
        worlds.sharp_polylines(10 if few else 300),
    )
    yield from section(
        "Dense paths", "Every corner is turned by itself, so many small ones take long.", worlds.dense_paths()
    )
    yield from section(
        "Learned turns",
        "The logarithmic 2:5:5:1 network by the length of its training; 300 iterations are the default.",
        worlds.learned_turns((300,) if few else (300, 4000, 30_000)),
    )


def papers(folder: Path, quick: bool) -> Iterator[str]:
    yield "\n\n## The papers\n"
    yield "Tables next to the printed ones, figures, and every run: the linked reports."
    for name, extra in (("path_planning", ["--runs", "100"]), ("trajectory", ["--long"])):
        arguments = ["reproduce", name, *(["--quick", "--runs", "2"] if quick else extra)]
        shown = [*arguments, "--out", str(folder)]
        if not (folder / f"{name}.md").exists():
            subprocess.run([sys.executable, "-m", "pin_metaik", *shown], check=True, stdout=subprocess.DEVNULL)
        with (folder / f"{name}_claims.csv").open(encoding="utf-8") as file:
            heading, *rows = csv.reader(file)
        yield f"\n`pin-metaik {' '.join(arguments)}`: [{name}]({folder.name}/{name}.md).\n"
        yield table(heading, rows, numbers="---")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--out", type=Path, required=True, help="the page; the papers' reports go to a folder beside it"
    )
    parser.add_argument("--quick", action="store_true", help="a few runs of everything")
    options = parser.parse_args()
    folder = options.out.with_suffix("")
    parts = [
        "# Mobile planners\n",
        f"`python benchmarks/mobile.py --out {options.out}{' --quick' * options.quick}`, {datetime.date.today()}, "
        f"{os.cpu_count()}-core {platform.machine()}, shared; shapely {shapely.__version__}.\n",
    ]
    few = options.quick
    for part in (
        exact_times(),
        planners(2 if few else 20),
        many_worlds(few),
        trajectories(2 if few else 10),
        times(),
        papers(folder, few),
    ):
        for text in part:
            print(text, flush=True)
            parts.append(text)
        parts.append("")
    page = re.sub("\n{3,}", "\n\n", "\n".join(parts)).rstrip() + "\n"
    options.out.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
