"""What a check costs against an earlier checkout of this package: both in processes of their own, asked by turns.

    git worktree add --detach ../before 1e6fd9e
    python benchmarks/collision_before.py ../before [--configurations 300] [--rounds 7] [--out PAGE]

Both are given the same random configurations in the same minutes; of each the least time of all rounds counts, as the
machine is shared. The checks before 2026-11-27 were wrong where aligned bodies overlap, which is what a higher price
buys.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

Simplify = Literal["none", "convex", "capsule"]
ROBOTS = ("ur5", "panda", "kinova", "xarm7", "rv7fl", "ur10", "talos", "tiago_no_hand")
SCENES = ("shelf", "table", "narrow_box")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path, help="folder of the earlier checkout")
    parser.add_argument("--configurations", type=int, default=300)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--robots", nargs="*", default=ROBOTS)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    git = ["git", "-C", str(options.before), "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, capture_output=True, text=True, check=True).stdout.strip()
    counts = f"--configurations {options.configurations} --rounds {options.rounds}"
    page = [
        f"# Checks now and at {commit}",
        "",
        f"`python benchmarks/collision_before.py BEFORE {counts}`, {datetime.date.today()}, {os.cpu_count()}-core "
        f"{platform.machine()}, shared, Python {platform.python_version()}. `world.in_collision(q)` on the same random "
        f"configurations, by turns: median, us, before -> now (now / before), under each `simplify`.",
        "",
        f"| robot | scene | {' | '.join(get_args(Simplify))} |",
        "|---|---|---|---|---|",
    ]
    ratios = []
    here = Path(__file__).resolve().parents[1]
    for robot in options.robots:
        with checkout(options.before) as before, checkout(here) as now:
            for scene in SCENES:
                cells = []
                for simplify in get_args(Simplify):
                    world = {"robot": robot, "scene": scene, "simplify": simplify, "count": options.configurations}
                    old, new = medians([before, now], world, options.rounds)
                    ratios.append(new / old)
                    cells.append(f"{old:.1f} -> {new:.1f} ({new / old:.2f})")
                page.append(f"| {robot} | {scene} | {' | '.join(cells)} |")
                print(page[-1], flush=True)
    summary = f"Of {len(ratios)} ratios the median is {np.median(ratios):.2f}, the largest {max(ratios):.2f}."
    options.out.write_text("\n".join([*page, "", summary]) + "\n", encoding="utf-8")


def medians(checkouts: list[subprocess.Popen[str]], world: dict[str, Any], rounds: int) -> list[float]:
    """The median time (us) of a check in each checkout, of the least time of every configuration in all rounds."""
    for one in checkouts:
        ask(one, {"build": world})
    times: list[list[list[float]]] = [[] for _ in checkouts]
    for _ in range(rounds):
        for one, found in zip(checkouts, times, strict=True):
            found.append(ask(one, {"time": True}))
    return [float(np.median(np.min(found, axis=0))) for found in times]


@contextmanager
def checkout(folder: Path) -> Iterator[subprocess.Popen[str]]:
    """A process that has the package of a folder."""
    environment = {**os.environ, "PYTHONPATH": str(folder.resolve())}
    command = [sys.executable, __file__, "--serve"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe, text=True) as process:
        yield process
        assert process.stdin
        process.stdin.close()


def ask(process: subprocess.Popen[str], request: dict[str, Any]) -> Any:
    assert process.stdin and process.stdout
    process.stdin.write(json.dumps(request) + "\n")
    process.stdin.flush()
    return json.loads(process.stdout.readline())


def serve() -> None:
    """Answer requests on stdin, a JSON object a line; only names that both checkouts have."""
    import pin_metaik as mik
    from pin_metaik.collision import load_scene
    from pin_metaik.collision.touch import random_configurations

    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        request = json.loads(line)
        if wanted := request.get("build"):
            robot = mik.load_robot(wanted["robot"])
            Q = random_configurations(robot.model, np.random.default_rng(1), wanted["count"])
            world = mik.CollisionWorld(robot, load_scene(wanted["scene"]), simplify=wanted["simplify"])
            for q in Q:
                world.in_collision(q)
        answers.write(json.dumps([] if wanted else [timed(world.in_collision, q) for q in Q]) + "\n")
        answers.flush()


def timed(call: Any, q: Any) -> float:
    """Microseconds of a call."""
    began = time.perf_counter()
    call(q)
    return 1e6 * (time.perf_counter() - began)


if __name__ == "__main__":
    serve() if sys.argv[1:] == ["--serve"] else main()
