"""Stewart platforms: how fast grids, forward kinematics and designs are, and how good the designs.

    python benchmarks/stewart.py > benchmarks/stewart.md

Checks A12 and A15 of docs/papers/stewart.md in full: every line of the design table has f >= 0.750 and a gap of 42 mm,
and the first line of the speed table at least 5e6 poses a second. Times are CPU times of one process, the best of
several, so that a busy machine matters less.
"""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import date
from time import process_time

import numpy as np
from rich.console import Console
from rich.progress import track

from pin_metaik import stewart
from pin_metaik.optimize.pso import PSO
from pin_metaik.optimize.qpso import QPSO
from pin_metaik.stewart import Dexterity, Fitness, Grid

SEEDS = range(5)
FINE = (50, 50, 50)
ALGORITHMS = {
    "PSO": PSO(agents=60),
    "PSO as printed": PSO(agents=60, variant="literal"),
    "QPSO": QPSO(agents=60),
}
REPEATS = 7


def best_time(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """Least CPU time in s; the first call, which may compile, does not count."""
    work()
    times = []
    for _ in range(repeats):
        began = process_time()
        work()
        times.append(process_time() - began)
    return min(times)


def rate(per_second: float) -> str:
    """A rate to two digits: 46,000,000."""
    return f"{float(f'{per_second:.2g}'):,.0f}"


def speeds() -> Iterator[str]:
    """Rows: what, how many a second."""
    mechanism = stewart.load_mechanism("stroke_100")
    geometry, limits = mechanism.geometry, mechanism.limits
    grid = Grid((150, 150, 125), (-0.15, 0.15), (-0.15, 0.15), (0.1, 0.35))
    found = stewart.survey(geometry, limits, grid)
    yield (
        f"The grid: stroke 100, h = 2 mm, {found.states.size:,} poses, {int(found.reached.sum()):,} reached, "
        f"{1e6 * found.volume:.1f} cm3, GDI {found.gdi:.4f}."
    )
    yield ""
    yield "| what | a second |"
    yield "|---|---|"
    for label, dexterity in (("Frobenius", Dexterity()), ("2-norm", Dexterity("two"))):
        seconds = best_time(lambda dexterity=dexterity: stewart.survey(geometry, limits, grid, dexterity))
        yield f"| poses of the grid: leg lengths, nu where reached, {label} | {rate(found.states.size / seconds)} |"
    poses = found.poses(found.reached)
    for label, dexterity in (("Frobenius", Dexterity()), ("2-norm", Dexterity("two"))):
        seconds = best_time(lambda dexterity=dexterity: stewart.conditioning(geometry, poses, dexterity))
        yield f"| nu of given poses, {label} | {rate(len(poses) / seconds)} |"

    hexapod = stewart.load_mechanism("reference_6x6")
    rng = np.random.default_rng(0)
    home = stewart.pose_at((0, 0, 0.37))
    poses = np.array(
        [
            stewart.pose_at((0, 0, 0.37) + rng.uniform(-1, 1, 3) * (0.06, 0.06, 0.042), rng.uniform(-0.3, 0.3, 3))
            for _ in range(2000)
        ]
    )
    lengths = stewart.leg_lengths(hexapod.geometry, poses)
    inverse = best_time(lambda: stewart.leg_lengths(hexapod.geometry, poses))
    yield f"| inverse kinematics, 6x6 | {rate(2000 / inverse)} |"
    many = best_time(lambda: stewart.forward(hexapod.geometry, lengths, home))
    one = best_time(lambda: [stewart.forward(hexapod.geometry, d, home) for d in lengths[:200]])
    yield f"| forward kinematics, 6x6, 2000 at once | {rate(2000 / many)} |"
    yield f"| forward kinematics, 6x6, one a call | {rate(200 / one)} |"
    closed = stewart.closed_model(hexapod)
    loops = best_time(lambda: [closed.forward(d, home) for d in lengths[:100]], 3)
    yield f"| forward kinematics by Pinocchio's closures, one a call | {rate(100 / loops)} |"
    every = best_time(lambda: stewart.all_forward(hexapod.geometry, lengths[0]), 3)
    yield f"| all assemblies of a 6x6 | {rate(1 / every)} |"


def designs() -> Iterator[str]:
    """Rows: fitness by stroke and algorithm over the seeds."""
    yield "| stroke | algorithm | f, worst | median | best | best f on 50^3 | least gap mm | median s |"
    yield "|---|---|---|---|---|---|---|---|"
    runs = [(stroke, name) for stroke in (50, 100) for name in ALGORITHMS]
    for stroke, name in track(runs, "designing", console=Console(stderr=True), transient=True):
        mechanism = stewart.load_mechanism(f"stroke_{stroke}")
        f, fine, gaps, seconds = [], [], [], []
        for seed in SEEDS:
            task = replace(mechanism.task, algorithm=ALGORITHMS[name], seed=seed)
            began = process_time()
            found = stewart.design(replace(mechanism, task=task))
            seconds.append(process_time() - began)
            if found.interrupted:
                raise KeyboardInterrupt
            assert (np.diff(found.history[:, 1]) >= 0).all()
            again = replace(task, grid=replace(task.grid, counts=FINE))
            fitness = Fitness(replace(found.mechanism, task=again))
            score = fitness.score(fitness.workspace(found.mechanism.geometry, found.mechanism.limits))
            f.append(found.score.fitness)
            fine.append(score.fitness)
            gaps.append(1e3 * found.mechanism.geometry.joint_gap)
        numbers = f"{min(f):.4f} | {np.median(f):.4f} | {max(f):.4f} | {max(fine):.4f}"
        yield f"| {stroke} | {name} | {numbers} | {min(gaps):.1f} | {np.median(seconds):.1f} |"


def main() -> None:
    print("# Stewart platforms\n")
    machine = f"{date.today()}, {os.cpu_count()}-core {platform.machine()}, Python {platform.python_version()}"
    print(f"`python benchmarks/stewart.py`, {machine}. CPU time of one process.\n")
    try:
        print("## Speed\n")
        for line in speeds():
            print(line, flush=True)
        print("\n## Designs\n")
        print(
            "f = 0.78 GDI + 0.22 V / (2 stroke)^3 with V / (2 stroke)^3 at least 0.05, seven dimensions free, 3600 "
            f"designs, 14 x 14 x 14 cells; {len(SEEDS)} seeds.\n"
        )
        for line in designs():
            print(line, flush=True)
    except KeyboardInterrupt:
        print("\nPARTIAL: interrupted.")
        sys.exit(130)


if __name__ == "__main__":
    main()
