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


def servos(poses: int = 10_000) -> Iterator[str]:
    """Rows: platforms of servos, by their makers' numbers, at random poses and on either branch."""
    yield "| platform | branch | rod error m | FK(IK) - pose | IK a second | FK a second | FK by Pinocchio | ratio |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, height in (("servo_sg90", 0.115), ("servo_esp32", 0.133)):
        mechanism = stewart.load_mechanism(name)
        rng = np.random.default_rng(0)
        places = np.array([0.0, 0.0, height]) + rng.uniform(-0.006, 0.006, (2 * poses, 3))
        turns = rng.uniform(-0.1, 0.1, (2 * poses, 3))
        T = np.array([stewart.pose_at(place, turn) for place, turn in zip(places, turns, strict=True)])
        T = T[stewart.transmission(mechanism.geometry, T).min(axis=1) > 0.3][:poses]
        assert len(T) == poses
        for branch in (1, -1):
            yield f"| {name} | {branch:+d} | {servo_row(mechanism, branch, T)} |"


def servo_row(mechanism: stewart.Mechanism, branch: int, T: np.ndarray) -> str:
    """Errors and speeds of a platform of servos at poses T (k, 4, 4)."""
    geometry = replace(mechanism.geometry, servos=replace(mechanism.geometry.servos, branches=branch))
    q = stewart.inverse(geometry, T).coordinates
    tips, rods = geometry.actuation.held(geometry.b, q)
    error = np.abs(np.linalg.norm(geometry.b + stewart.leg_vectors(geometry, T) - tips, axis=-1) - rods).max()
    start = T @ stewart.pose_at((0.002, -0.001, 0.001), (0.02, 0.01, -0.02))
    again = np.abs(stewart.forward(geometry, q, start).poses - T).max()
    closed = stewart.closed_model(replace(mechanism, geometry=geometry, limits=stewart.ServoLimits(-3.1, 3.1)))
    inverse = best_time(lambda: stewart.inverse(geometry, T)) / len(T)
    one = best_time(lambda: [stewart.forward(geometry, q[k], start[k]) for k in range(100)]) / 100
    loops = best_time(lambda: [closed.forward(q[k], start[k]) for k in range(100)], 3) / 100
    return f"{error:.1e} | {again:.1e} | {rate(1 / inverse)} | {rate(1 / one)} | {rate(1 / loops)} | {loops / one:.0f}"


def servo_workspaces() -> Iterator[str]:
    """Rows: workspaces of servos and of slides that see the same poses, assemblies, and a design."""
    mechanism = stewart.load_mechanism("servo_sg90")
    geometry, grid = mechanism.geometry, Grid((120, 120, 60), (-0.06, 0.06), (-0.06, 0.06), (0.09, 0.13))
    found = stewart.survey(geometry, mechanism.limits, grid)
    slides = replace(geometry, servos=None)
    legs = stewart.LegLimits(0.12 - 0.015, 0.12 + 0.015)
    by_slides = stewart.survey(slides, legs, grid)
    yield "| what | |"
    yield "|---|---|"
    for label, legged, limits, each in (
        ("servos", geometry, mechanism.limits, found),
        ("slides of 105 to 135 mm", slides, legs, by_slides),
    ):
        seconds = best_time(lambda legged=legged, limits=limits: stewart.survey(legged, limits, grid))
        share = f"{int(each.reached.sum()):,} of {each.states.size:,} reached"
        yield f"| poses of a grid a second, {label} ({share}) | {rate(each.states.size / seconds)} |"
    pose = stewart.pose_at((0.005, 0, 0.115), (0.05, 0.03, 0.0))
    q = stewart.inverse(geometry, pose).coordinates[0]
    every = stewart.all_forward(geometry, q)
    seconds = best_time(lambda: stewart.all_forward(geometry, q), 3)
    yield f"| all assemblies ({every}), s | {seconds:.3f} |"
    began = process_time()
    designed = stewart.design(mechanism)
    seconds = process_time() - began
    yield f"| design of platform, horn and rod, 1,200 designs: {designed.score.fitness:.4f}, s | {seconds:.1f} |"


def assemblies(platforms: int = 2000) -> Iterator[str]:
    """What forward kinematics finds for random 6x6 platforms at random poses."""
    rng = np.random.default_rng(1)
    mirror = np.diag([1.0, 1.0, -1.0, 1.0])
    found = incomplete = lost = unpaired = 0
    worst, seconds = 0.0, 0.0
    for _ in track(range(platforms), "assembling", console=Console(stderr=True), transient=True):
        angles = [np.sort(rng.uniform(0, 2 * np.pi, 6)) for _ in range(2)]
        legs = tuple((i, int(m)) for i, m in enumerate(rng.permutation(6)))
        geometry = stewart.Geometry(0.3, rng.uniform(0.1, 0.4), *angles, legs)
        pose = stewart.pose_at((*rng.uniform(-0.25, 0.25, 2), rng.uniform(0.05, 0.55)), rng.uniform(-1, 1, 3))
        lengths = stewart.leg_lengths(geometry, pose)
        began = process_time()
        every = stewart.all_forward(geometry, lengths)
        seconds += process_time() - began
        found += len(every)
        incomplete += not every.complete
        lost += bool(np.abs(every.poses - pose).max(axis=(1, 2)).min() > 1e-6)
        images = mirror @ every.poses @ mirror
        unpaired += sum(bool(np.abs(every.poses - image).max(axis=(1, 2)).min() > 1e-6) for image in images)
        worst = max(worst, float(np.abs(stewart.leg_lengths(geometry, every) - lengths).max()))
    yield (
        "| random 6x6 | assemblies | not proved complete | own pose not found | without mirror image | largest error m "
        "| ms |"
    )
    yield "|---|---|---|---|---|---|---|"
    numbers = f"{found} | {incomplete} | {lost} | {unpaired} | {worst:.1e}"
    yield f"| {platforms} | {numbers} | {1e3 * seconds / platforms:.1f} |"


def narrow() -> Iterator[str]:
    """Workspaces of legs with little stroke, and designs of them, against a plain grid of 60 x 60 x 60 cells."""
    yield "| legs mm | mm3 | GDI | cells reached |"
    yield "|---|---|---|---|"
    geometry = stewart.load_mechanism("reference_6x6").geometry
    for stroke in (0.12, 0.02, 0.01, 0.005, 0.001):
        workspace = stewart.survey(geometry, stewart.LegLimits(0.41 - stroke / 2, 0.41 + stroke / 2))
        numbers = f"{1e9 * workspace.volume:.4g} | {workspace.gdi:.4f} | {workspace.cells_reached}"
        yield f"| 410 +- {500 * stroke:g} | {numbers} |"
    yield ""
    yield "| design | legs mm | V / cube^3 | on 60^3 | s |"
    yield "|---|---|---|---|---|"
    cases = (
        ("6x6", 0.69, (0.3, 0.8), (0.488, 0.498)),
        ("6x6", 0.69, (0.3, 0.8), (0.492, 0.494)),
        ("3x3", 0.3, (0.15, 0.45), (0.396, 0.404)),
    )
    for kind, radius, span, legs in cases:
        ranges = stewart.Ranges(base_radius=span, platform_radius=span)
        task = stewart.DesignTask(ranges, evaluations=1200, algorithm="pso")
        start = stewart.standard_geometry(kind, radius, radius)
        began = process_time()
        found = stewart.design(stewart.Mechanism("narrow", start, stewart.LegLimits(*legs), task=task))
        seconds = process_time() - began
        plain = plain_volume(found.mechanism) / (2 * found.mechanism.limits.stroke) ** 3
        span = f"{1e3 * legs[0]:g} to {1e3 * legs[1]:g}"
        yield f"| {kind} | {span} | {found.score.workspace:.4f} | {plain:.4f} | {seconds:.1f} |"


def plain_volume(mechanism: stewart.Mechanism, cells: int = 60) -> float:
    """Level workspace in m^3 by numpy on a grid of its own, a little wider than what is reached."""
    geometry, limits = mechanism.geometry, mechanism.limits
    reached = mechanism.survey().positions
    aside = 0.05 * np.ptp(reached, axis=0)
    low, high = reached.min(axis=0) - aside, reached.max(axis=0) + aside
    axes = [a + (np.arange(cells) + 0.5) * (b - a) / cells for a, b in zip(low, high, strict=True)]
    P = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    d = np.linalg.norm(P + geometry.m - geometry.b, axis=2)
    inside = ((d >= limits.shortest) & (d <= limits.longest)).all(axis=1)
    return float(inside.sum() * np.prod((high - low) / cells))


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
        print("\n## All assemblies\n")
        for line in assemblies():
            print(line, flush=True)
        print("\n## Servos\n")
        print(
            "10,000 random poses within 6 mm and 0.1 rad of the makers' home heights; FK one a call, in the same run.\n"
        )
        for section in (servos, servo_workspaces):
            for line in section():
                print(line, flush=True)
            print()
        print("## Narrow workspaces\n")
        for line in narrow():
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
