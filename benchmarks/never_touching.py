"""Whether links that a world leaves out, as they never touch, can be made to touch inside the limits.

    python benchmarks/never_touching.py [--descents 20000] [--robots talos panda ...] [--out PAGE]

For every such pair, random configurations inside the limits are led downhill in the distance of the two hulls, with
another seed than the world's own search, until they touch or come no nearer.
"""

from __future__ import annotations

import argparse
import datetime
import platform
import tempfile
import time
from pathlib import Path

import numpy as np
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision.approach import Approach
from pin_metaik.collision.body import robot_bodies
from pin_metaik.collision.solids import Solids
from pin_metaik.collision.srdf import pair_of
from pin_metaik.collision.touch import random_configurations

ROBOTS = ("talos", "panda", "ur5", "kinova", "xarm7")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--descents", type=int, default=20_000, help="of each robot")
    parser.add_argument("--robots", nargs="*", default=ROBOTS)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    page = [
        "# Links that never touch",
        "",
        f"`python benchmarks/never_touching.py --descents {options.descents}`, {datetime.date.today()}, "
        f"{platform.machine()}, shared. Without an SRDF. *world*: processor time of the first world, nothing kept.",
        "",
        "| robot | pairs left out | descents | pairs made to touch | nearest, mm | world, s |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    for name in options.robots:
        page.append(search(name, options.descents))
        print(page[-1], flush=True)
    options.out.write_text("\n".join(page) + "\n", encoding="utf-8")


def search(name: str, count: int) -> str:
    """A row of the table."""
    robot, rng = mik.load_robot(name), np.random.default_rng(5)
    began = time.process_time()
    disabled = mik.CollisionWorld(robot, srdf=False).disabled
    seconds = time.process_time() - began
    never = {pair for pair, reason in disabled.items() if reason == "Never"}
    solids = Solids(robot.model, robot_bodies(robot, "convex"))
    approaches = [
        Approach(solids, i, j)
        for j, b in enumerate(solids.moving)
        for i, a in enumerate(solids.moving[:j])
        if a.joint != b.joint and pair_of(a.link, b.link) in never
    ]
    each, least = max(1, count // len(approaches)), dict.fromkeys(never, np.inf)
    for approach in track(approaches, name, transient=True):
        pair = pair_of(*approach.links)
        for q in random_configurations(robot.model, rng, each):
            least[pair] = min(least[pair], approach.descend(q)[0])
    distances = np.array(list(least.values()))
    counts = f"{len(never)} | {each * len(approaches):,} | {(distances <= 0.0).sum()}"
    return f"| {name} | {counts} | {1e3 * distances.min():.1f} | {seconds:.1f} |"


if __name__ == "__main__":
    import os

    with tempfile.TemporaryDirectory() as folder:
        os.environ["PIN_METAIK_CACHE"] = folder
        main()
