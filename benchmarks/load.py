"""Hours of work in minutes: whether memory stays flat, and whether the last calls are as quick as the first.

    python benchmarks/load.py [--solves 1e7] [--checks 1e6] [--worlds 1e5] [--paths 1e4] [--only NAME] [--out PAGE]

Each kind of work is done in ten parts, in a process of its own. Memory is what is resident after each part, once what
can be collected is; the first part, in which things are made that are kept, does not count.
"""

from __future__ import annotations

import argparse
import gc
import os
import resource
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path
from random import Random
from time import process_time

import numpy as np
from random_models import random_model
from sections import conditions

import pin_metaik as mik
from pin_metaik.collision import Obstacle, Sphere, load_scene

PARTS = 10
BATCH = 10_000  # targets of one call
ROBOT = "ur5"


@dataclass(frozen=True)
class Load:
    """What some work took.

    Attributes:
        count: How often it was done.
        seconds: Processor time of each part, s.
        memory: Resident after each part, bytes.
    """

    count: int
    seconds: tuple[float, ...]
    memory: tuple[int, ...]

    @property
    def growth(self) -> float:
        """By how much memory grew after the first part, MiB."""
        return (max(self.memory[1:]) - self.memory[0]) / 2**20

    @property
    def slower(self) -> float:
        """Time of the last third of the parts to that of the first third, the very first apart."""
        third = max(1, (len(self.seconds) - 1) // 3)
        return float(np.median(self.seconds[-third:]) / np.median(self.seconds[1 : 1 + third]))


Work = Callable[[int], None]


def chain() -> mik.Chain:
    robot = mik.load_robot(ROBOT)
    return mik.Chain(robot, robot.frame)


def solves() -> Work:
    """Targets in batches, and one in a hundred alone."""
    arm, rng = chain(), np.random.default_rng(0)
    poses = arm.poses(arm.box.sample(rng, BATCH))[:, 0]

    def work(count: int) -> None:
        for start in range(0, count, BATCH):
            asked = poses[: min(BATCH, count - start)]
            mik.solve_ik_batch(arm, asked, workers=1)
            for pose in asked[::100]:
                mik.solve_ik(arm, pose)

    return work


def checks() -> Work:
    """Configurations in a world, one by one."""
    robot = mik.load_robot(ROBOT)
    world = mik.CollisionWorld(robot, load_scene("shelf"), margin=0.01)
    Q = chain().q(chain().box.sample(np.random.default_rng(0), 1_000))

    def work(count: int) -> None:
        for i in range(count):
            world.in_collision(Q[i % len(Q)])

    return work


def worlds() -> Work:
    """Worlds that are made, asked, and dropped."""
    robot = next(one for one in (random_model(Random(i), 4) for i in range(99)) if one.collision_model.ngeoms > 2)
    q = robot.chain().reference
    ball = Obstacle("ball", Sphere(0.1), (1.0, 0.0, 0.0))

    def work(count: int) -> None:
        for _ in range(count):
            mik.CollisionWorld(robot, [ball]).in_collision(q)

    return work


def paths() -> Work:
    """Paths of twenty poses."""
    arm, rng = chain(), np.random.default_rng(0)
    a, b = arm.box.sample(rng, 2) * 0.3
    along = arm.poses(a + np.linspace(0.0, 1.0, 20)[:, None] * (b - a))[:, 0]

    def work(count: int) -> None:
        for _ in range(count):
            mik.solve_ik_path(arm, along, arm.q(a))

    return work


KINDS: dict[str, Callable[[], Work]] = {"solves": solves, "checks": checks, "worlds": worlds, "paths": paths}


def loaded(kind: str, count: int) -> Load:
    """What a kind of work took."""
    work = KINDS[kind]()
    work(min(count, 100))
    bounds = np.linspace(0, count, PARTS + 1).astype(int).tolist()
    seconds, memory = list[float](), list[int]()
    for begin, end in pairwise(bounds):
        began = process_time()
        work(end - begin)
        seconds.append(process_time() - began)
        gc.collect()
        memory.append(resident())
    return Load(count, tuple(seconds), tuple(memory))


def resident() -> int:
    """Bytes of this process that are in memory."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize()


def page(loads: dict[str, Load]) -> Iterator[str]:
    """The page, paragraph by paragraph."""
    yield "# Load"
    yield conditions()
    table = ["| work | times | processor time, s | each, us | memory grew by, MiB | last parts to first, time |"]
    table.append("|---|---:|---:|---:|---:|---:|")
    for kind, load in loads.items():
        total = sum(load.seconds)
        cells = f"{load.count:,} | {total:.0f} | {1e6 * total / load.count:.1f} | {load.growth:.1f} | {load.slower:.2f}"
        table.append(f"| {kind} | {cells} |")
    yield "\n".join(table)


def main() -> None:
    """Do it all, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for kind, count in {"solves": 1e7, "checks": 1e6, "worlds": 1e5, "paths": 1e4}.items():
        parser.add_argument(f"--{kind}", type=float, default=count)
    parser.add_argument("--only", default="", help="works whose name holds this")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    given = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    found = {}
    for kind in KINDS:
        if given.only in kind:
            with get_context("spawn").Pool(1) as pool:
                found[kind] = pool.apply(loaded, (kind, int(getattr(given, kind))))
            print(kind, found[kind], flush=True)
    given.out.write_text("\n\n".join(page(found)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
