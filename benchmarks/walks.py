"""How many files a reader enters to follow one call: Python calls, files entered, and changes of file.

    python benchmarks/walks.py                                            # this tree, printed
    python benchmarks/walks.py --before TREE --out benchmarks/walks.md    # beside an earlier checkout, as a page

Counted by ``sys.setprofile`` inside the package, one call each, after the same call has made all caches and compiled
code warm. *calls* are calls of Python functions, comprehensions included; *files* are the files that these are in;
*changes* is how often the next call is in another file than the one before. *without reading arguments* counts all
three again without ``arguments.py``, which reads the arguments of public functions.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import io
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from itertools import groupby
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

import pin_metaik as mik
from pin_metaik import mobile, stewart
from pin_metaik.collision import load_scene
from pin_metaik.compare import Suite, compare, write_report

PACKAGE = str(Path(mik.__file__).parent)
DOORS = str(Path(PACKAGE) / "arguments.py")
X = np.array([0.1, -1.2, 1.1, -1.4, -1.5, 0.3])  # rad; the UR5 above the table, its tool down
WALLS = ((20, 45, 0, 20), (15, 40, 35, 40))  # rows and columns of the map that are occupied

Walk = Callable[[], object]


class Count(NamedTuple):
    """What a walk takes: Python calls, files, changes of file, and the files in the order of their first call.

    ``inside`` are the three numbers without ``arguments.py``.
    """

    calls: int
    rooms: int
    stays: int
    inside: tuple[int, int, int]
    order: list[str]


def walks(folder: Path) -> Iterator[tuple[str, Walk]]:
    """What is walked, by name; each is called twice."""
    robot = mik.load_robot("ur5")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene("table"))
    pose = chain.placements(chain.q(X))[0]
    free = mik.Target(pose, orientation_tolerance=(1e-5, 1e-5, np.inf))
    short = mik.IKSolver("gwo", "dls", budget=mik.Budget(evaluations=300))
    numbers = iter(range(100))

    def fresh(of: Path) -> Path:
        """A copy of a file that nothing has read yet."""
        copy = folder / f"{of.stem}_{next(numbers)}{of.suffix}"
        copy.write_text(of.read_text(encoding="utf-8"), encoding="utf-8")
        return copy

    yield "`solve_ik(chain, SE3)`, arm with a closed form", lambda: mik.solve_ik(chain, pose)
    yield "the same in a world, free at once", lambda: mik.solve_ik(chain, pose, chain.q(X), world=world)
    yield "`solve_ik(chain, Target(..., free axis))`", lambda: mik.solve_ik(chain, free)
    yield "`solve_ik`, `gwo` + `dls`, 300 evaluations", lambda: mik.solve_ik(chain, pose, solver=short)
    yield "`solve_ik_all`", lambda: mik.solve_ik_all(chain, pose)

    table = Path(PACKAGE) / "robots" / "catalog" / "puma560.toml"
    yield "DH TOML to `Robot` (with its URDF)", lambda: mik.load_robot(fresh(table)).urdf

    platform_file = Path(PACKAGE) / "stewart" / "catalog" / "stroke_100.toml"
    yield "Stewart file to workspace", lambda: stewart.read_mechanism(fresh(platform_file)).survey()

    map_file = write_map(folder)
    yield "map.yaml to trajectory", lambda: trajectory(map_file)

    suite = Suite(("ur5",), ("random",), ("dls", "lm"), 2, 1, 200)  # by place: earlier trees had another keyword
    rows = (folder / f"rows_{next(numbers)}" for _ in iter(int, 1))
    yield "`compare` to rows (4 trials)", lambda: compare(suite, next(rows))
    compare(suite, folder / "rows")
    yield "rows to report", lambda: write_report(folder / "rows")


def write_map(folder: Path) -> Path:
    """A ROS map of a room with two walls, 3 m by 3 m, in cells of 5 cm."""
    cells = np.full((60, 60), 254, dtype=np.uint8)
    for top, bottom, left, right in WALLS:
        cells[top:bottom, left:right] = 0
    (folder / "map.pgm").write_bytes(b"P5 60 60 255\n" + cells.tobytes())
    path = folder / "map.yaml"
    path.write_text(
        "image: map.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return path


def trajectory(map_file: Path) -> object:
    """From a map on disk to the speeds along the shortest path."""
    robot = mobile.NOMAD_200
    scene = mobile.load_scene(map_file, (0.4, 0.4), (2.6, 2.6))
    problem = mobile.PathProblem.of(scene, 0.1, margin=0.1)
    return mobile.plan_trajectory(problem.optimum, robot, scene.obstacles)


def counted(walk: Walk) -> Count:
    """What a second call of a walk enters."""
    walk()
    entered: list[str] = []

    def note(frame: FrameType, event: str, _: Any) -> None:
        file = frame.f_code.co_filename
        if event == "call" and file.startswith(PACKAGE):
            entered.append(file)

    sys.setprofile(note)
    try:
        walk()
    finally:
        sys.setprofile(None)
    order = list(dict.fromkeys(str(Path(file).relative_to(PACKAGE)) for file in entered))
    inside = [file for file in entered if file != DOORS]
    return Count(*sizes(entered), sizes(inside), order)


def sizes(entered: list[str]) -> tuple[int, int, int]:
    """Calls, rooms and stays of calls by their files."""
    return len(entered), len(set(entered)), len(list(groupby(entered)))


def counts() -> dict[str, Count]:
    """Every walk counted, in the tree whose package is imported."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        return {name: counted(walk) for name, walk in walks(Path(folder))}


def counts_of(tree: Path) -> dict[str, Count]:
    """The same in another tree, by a process of its own."""
    command = [sys.executable, "-W", "ignore", __file__, "--json"]
    ran = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(tree)}, capture_output=True, text=True)
    if ran.returncode:
        sys.exit(ran.stderr)
    return {name: Count(*values) for name, values in json.loads(ran.stdout).items()}


def table(before: dict[str, Count] | None, after: dict[str, Count]) -> Iterator[str]:
    """The counts as rows of Markdown."""
    yield "| call | calls | files | changes | without reading arguments: calls | files | changes |"
    yield "|---|---|---|---|---|---|---|"
    for name, now in after.items():
        was = now if before is None else before[name]
        numbers = zip((*was[:3], *was.inside), (*now[:3], *now.inside), strict=True)
        cells = [f"{new:,}" if before is None else f"{old:,} → {new:,}" for old, new in numbers]
        yield f"| {name} | {' | '.join(cells)} |"


def page(before: dict[str, Count], after: dict[str, Count], command: str) -> str:
    """The counts of two trees with what they are and where they were taken."""
    machine = f"{os.cpu_count()}-core {platform.machine()}, Python {platform.python_version()}"
    first = next(iter(after))
    return "\n".join(
        [
            "# Calls followed through the code",
            "",
            f"`{command}`, {datetime.datetime.now(datetime.UTC):%Y-%m-%d}, {machine}.",
            "",
            "Python calls inside the package in one call, the files that they are in, and how often the next",
            "call is in another file than the one before (changes); caches and compiled code are warm. Before → after.",
            "The later tree does more in some calls: public functions read their arguments (the last three columns",
            "leave that out), answers come with proofs, files are searched for keys that mean nothing.",
            "",
            *table(before, after),
            "",
            f"{first}: {' > '.join(after[first].order)}.",
            "",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", type=Path, help="checkout of an earlier tree to count beside this one")
    parser.add_argument("--out", type=Path, help="page to write; needs --before")
    parser.add_argument("--json", action="store_true", help="print the counts as JSON")
    arguments = parser.parse_args()
    after = counts()
    if arguments.json:
        print(json.dumps(after))
        return
    before = None if arguments.before is None else counts_of(arguments.before)
    print("\n".join(table(before, after)))
    if arguments.out is not None and before is not None:
        command = f"python benchmarks/walks.py --before TREE --out {arguments.out}"
        arguments.out.write_text(page(before, after, command), encoding="utf-8")


if __name__ == "__main__":
    main()
