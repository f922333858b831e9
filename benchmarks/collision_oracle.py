"""Collision worlds against an oracle that asks nothing of the package, and worlds of a thousand boxes.

    python benchmarks/collision_oracle.py [--configurations 20000] [--thin 20000] [--boxes 1000] [--batch 1000000]
        [--out PAGE]

The oracle (``collision_truth.py``) takes every pair of the original geometry by itself: coal's distance, for boxes
arithmetic, and for bodies inside closed meshes solid angles.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pinocchio as pin
from collision_cases import GANTRIES, aligned, around_a_gantry, around_an_arm, gantry, places
from collision_truth import Truth
from numpy.typing import NDArray
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle, Sphere, load_scene
from pin_metaik.collision.touch import random_configurations

Floats = NDArray[np.float64]
NAMED = ("ur5", "panda", "kinova", "xarm7", "rv7fl")
THIN = ("ur5", "panda", "rv7fl")
WAYS = ("none", "convex", "capsule")
DEEP = 1e-6  # m; what overlaps by more must not be called free, what is apart by more than the margin and this, not hit
AWAY = 1e-3  # m; what is farther from thin walls must not be called a collision
QUESTIONS = 1000  # asked before the same are asked again, in another order


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--configurations", type=int, default=20_000, help="of eight robots together")
    parser.add_argument("--thin", type=int, default=20_000, help="of three robots together, among thin walls")
    parser.add_argument("--boxes", type=int, default=1000)
    parser.add_argument("--batch", type=int, default=1_000_000, help="configurations of a batch")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    words = f"--configurations {options.configurations} --thin {options.thin} --boxes {options.boxes}"
    words += f" --batch {options.batch}"
    packages = ", ".join(f"{name} {version(name)}" for name in ("pin", "coal", "numpy", "numba"))
    page = [
        "# Collision worlds against an oracle",
        "",
        f"`python benchmarks/collision_oracle.py {words}`, {datetime.date.today()}, {os.cpu_count()}-core "
        f"{platform.machine()}, shared, Python {platform.python_version()}, {packages}. Times are by the clock, "
        "through Python, one thread.",
    ]
    for section, count in (
        (many_boxes, options.boxes),
        (batches, options.batch),
        (answers, options.configurations),
        (thin_walls, options.thin),
    ):
        page += section(count)
        options.out.write_text("\n".join(page) + "\n", encoding="utf-8")


def answers(count: int) -> list[str]:
    """What worlds say of configurations, half of them aligned, next to the oracle."""
    lines = [
        "",
        "## Free and colliding",
        "",
        f"{count:,} configurations of eight robots, half of them aligned (joints at multiples of 90 and 45 degrees and "
        "of 1 cm, home), among posts, boxes, walls, a bin and a concave block, margin 0. *missed*: called free, and "
        f"overlapping by more than {1e6 * DEEP:g} um. *invented*: called a collision, and apart by more than that. "
        "Each under `simplify` none, convex, capsule. *alone*: missed with `exact=False` (convex, capsule). *changed*: "
        f"answers that differ when asked again in another order after {QUESTIONS:,} other questions.",
        "",
        "| robot | configurations | overlap | missed | invented | missed alone | changed |",
        "|---|---|---|---|---|---|---|",
    ]
    sources = [*NAMED, *GANTRIES]
    for name in sources:
        row = judged(name, count // len(sources))
        lines.append(f"| {name} | " + " | ".join(str(cell) for cell in row) + " |")
        print(lines[-1], flush=True)
    return lines


def judged(name: str, count: int) -> list[object]:
    """One row of the table."""
    robot, obstacles = (mik.load_robot(name), around_an_arm()) if name in NAMED else (gantry(name), around_a_gantry())
    worlds = [mik.CollisionWorld(robot, obstacles, simplify=way) for way in WAYS]
    alone = [mik.CollisionWorld(robot, obstacles, simplify=way, exact=False) for way in WAYS[1:]]
    truth = Truth.of(worlds[1])
    rng = np.random.default_rng(1)
    half = count // 2
    Q = np.concatenate([aligned(robot.model, rng, half), random_configurations(robot.model, rng, count - half)])
    least = np.array([truth.least(q) for q in track(Q, f"{name}, oracle", transient=True)])
    said = [world.in_collision_batch(Q) for world in worlds]
    simple = [world.in_collision_batch(Q) for world in alone]
    changed = 0
    for world, before in zip(worlds, said, strict=True):
        world.in_collision_batch(random_configurations(robot.model, rng, QUESTIONS))
        order = rng.permutation(len(Q))
        changed += int((world.in_collision_batch(Q[order]) != before[order]).sum())
    return [
        len(Q),
        f"{100.0 * (least < 0.0).mean():.0f} %",
        ", ".join(str(((least < -DEEP) & ~hit).sum()) for hit in said),
        ", ".join(str(((least > DEEP) & hit).sum()) for hit in said),
        ", ".join(str(((least < -DEEP) & ~hit).sum()) for hit in simple),
        changed,
    ]


def thin_walls(count: int) -> list[str]:
    """Arms among walls thinner than a link: the mesh has the last word."""
    lines = [
        "",
        "## Thin walls",
        "",
        f"{count:,} random configurations of three arms among six walls, 1 cm thick. *invented*: called a collision "
        f"while coal's distance of the original meshes is above {1e3 * AWAY:g} mm; *missed*: called free while they "
        "overlap. Each under `simplify` none, convex, capsule.",
        "",
        "| robot | configurations | overlap | invented | missed |",
        "|---|---|---|---|---|",
    ]
    for name in THIN:
        robot = mik.load_robot(name)
        rng = np.random.default_rng(2)
        Q = random_configurations(robot.model, rng, count // len(THIN))
        walls = [Obstacle(f"wall {k}", Box((0.01, 0.3, 0.25)), wall) for k, wall in enumerate(places(rng, 6))]
        worlds = [mik.CollisionWorld(robot, walls, simplify=way) for way in WAYS]
        truth = Truth.of(worlds[1])
        least = np.array([truth.least(q) for q in track(Q, f"{name}, oracle", transient=True)])
        said = [world.in_collision_batch(Q) for world in worlds]
        invented = ", ".join(str(((least > AWAY) & hit).sum()) for hit in said)
        missed = ", ".join(str(((least < -DEEP) & ~hit).sum()) for hit in said)
        lines.append(f"| {name} | {len(Q)} | {100.0 * (least < 0.0).mean():.0f} % | {invented} | {missed} |")
        print(lines[-1], flush=True)
    return lines


def many_boxes(count: int) -> list[str]:
    """How long checks and changes take among many boxes, and what the boxes weigh."""
    lines = [
        "",
        "## Many boxes",
        "",
        "Boxes of 4 cm, 0.45 to 1.2 m from a Panda's base. Changes with the check that follows, ms, the least of "
        "seven; a check at free configurations and `min_distance`, us, median (95th percentile); memory of the "
        "obstacles and of checking, MB.",
        "",
        "| boxes | build | add | move | allow | remove | attach | detach | check | min_distance | MB |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    robot = mik.load_robot("panda")
    free = np.array([0.0, -0.5, 0.0, -2.3, 0.0, 1.9, 0.8])
    home = np.concatenate([free, pin.neutral(robot.model)[7:]])
    mik.CollisionWorld(robot).in_collision(home)
    for boxes in sorted({min(10, count), min(100, count), count}):
        *changes, check, distance, weight = box_times(robot, home, boxes)
        cells = " | ".join(f"{cell:.1f}" for cell in changes)
        lines.append(f"| {boxes:,} | {cells} | {check} | {distance} | {weight:.1f} |")
        print(lines[-1], flush=True)
    return lines


def box_times(robot: mik.Robot, home: Floats, count: int) -> tuple:
    """Milliseconds of the changes, then the check, the distance and the memory."""
    rng = np.random.default_rng(3)
    box = Box((0.04, 0.04, 0.04))
    spots: list[Floats] = []
    while len(spots) < count:
        spot = rng.uniform(-1.2, 1.2, 3)
        if np.linalg.norm(spot) > 0.45:
            spots.append(spot)
    before = memory()
    began = time.perf_counter()
    world = mik.CollisionWorld(robot, [Obstacle(f"box {k}", box, spot) for k, spot in enumerate(spots)])
    world.in_collision(home)
    build = 1e3 * (time.perf_counter() - began)

    def changed(change: Callable[[int], object], undo: Callable[[int], object]) -> float:
        times = []
        for k in range(7):
            began = time.perf_counter()
            change(k)
            world.in_collision(home)
            times.append(1e3 * (time.perf_counter() - began))
            undo(k)
            world.in_collision(home)
        return min(times)

    def nothing(_: int) -> None:
        pass

    def add(_: int) -> None:
        world.add(Obstacle("new", box, (1.0, 1.0, 1.0)))

    def remove(_: int) -> None:
        world.remove("new")

    def attach(_: int) -> None:
        world.attach("held", Sphere(0.02), "panda_hand_tcp")

    def detach(_: int) -> None:
        world.detach("held", home)

    added = changed(add, remove)
    add(0)
    moved = changed(lambda k: world.move("new", (1.0, 1.0, 0.9 - 0.01 * k)), nothing)
    allowed = changed(lambda _: world.allow("new", "panda_hand"), lambda _: world.check("new", "panda_hand"))
    removed = changed(remove, add)
    attached = changed(attach, lambda _: world.remove("held"))
    attach(0)
    detached = changed(detach, lambda k: (world.remove("held"), attach(k)))
    Q = [q for q in random_configurations(robot.model, rng, 400) if not world.in_collision(q)]
    check = spread([quickest(world.in_collision, q) for q in Q])
    distance = spread([quickest(world.min_distance, q) for q in Q[:50]])
    return build, added, moved, allowed, removed, attached, detached, check, distance, memory() - before


def batches(count: int) -> list[str]:
    """What processes bring to batches."""
    lines = [
        "",
        "## Batches",
        "",
        "`in_collision_batch(Q, workers=...)` at random configurations of a Panda among the shelf's boards, from one "
        "and from two processes, by turns: the least of three times, s by the clock, and how often an answer differs.",
        "",
        "| configurations | 1 process | 2 processes | differ |",
        "|---|---|---|---|",
    ]
    robot = mik.load_robot("panda")
    world = mik.CollisionWorld(robot, load_scene("shelf"))
    Q = random_configurations(robot.model, np.random.default_rng(5), count)
    for part in (count // 100, count // 10, count):
        alone, shared, differ = [], [], 0
        for _ in range(3):
            began = time.perf_counter()
            one = world.in_collision_batch(Q[:part], workers=1)
            alone.append(time.perf_counter() - began)
            began = time.perf_counter()
            two = world.in_collision_batch(Q[:part], workers=2)
            shared.append(time.perf_counter() - began)
            differ += int((one != two).sum())
        lines.append(f"| {part:,} | {min(alone):.3f} | {min(shared):.3f} | {differ} |")
        print(lines[-1], flush=True)
    return lines


def quickest(ask: Callable[[Floats], object], q: Floats) -> float:
    """Least microseconds of five calls: the machine is shared."""
    times = []
    for _ in range(5):
        began = time.perf_counter()
        ask(q)
        times.append(1e6 * (time.perf_counter() - began))
    return min(times)


def spread(us: list[float]) -> str:
    return f"{np.median(us):.0f} ({np.quantile(us, 0.95):.0f})" if us else "-"


def memory() -> float:
    """What this process holds, MB; Linux."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


if __name__ == "__main__":
    main()
