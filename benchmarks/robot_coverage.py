"""Every robot that loads by name: its joints and tip, how it is solved, how fast, what is decided, and its worlds.

python benchmarks/robot_coverage.py --out benchmarks/robot_coverage.md
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ik_decide_arms import any_orientations
from sections import conditions

import pin_metaik as mik
from pin_metaik.robots import RobotName

SEED = 23
WARM = 20  # targets of another seed before anything is timed
CHECKS = 200  # configurations whose collisions are timed


@dataclass(frozen=True)
class Coverage:
    """What was found of one robot.

    Attributes:
        robot: Its name, source, degrees of freedom and tip.
        joints: Coordinates that place the tip.
        closed_form: Whether they have a closed form.
        solved: Share of poses of random configurations that are solved.
        us: Median time of a solve, us of processor time.
        decided: Share of random orientations at reachable positions that are solved or proved unreachable.
        pairs: Pairs of links that a world checks; 0: there is no geometry to check.
        check: Median time of a check, us.
    """

    robot: RobotName
    joints: int
    closed_form: bool
    solved: float
    us: float
    decided: float
    pairs: int
    check: float

    def row(self) -> str:
        """A row of the table."""
        world = f"{self.pairs} | {self.check:.0f}" if self.pairs else "no geometry | "
        form = "yes" if self.closed_form else ""
        return (
            f"| {self.robot.name} | {self.robot.source} | {self.robot.dof} | {self.joints} | `{self.robot.frame}` "
            f"| {form} "
            f"| {self.solved:.1%} | {self.us:.1f} | {self.decided:.1%} | {world} |"
        )


def coverage(name: RobotName, poses: int, orientations: int) -> Coverage:
    """Measure one robot."""
    robot = mik.load_robot(name)
    chain = mik.Chain(robot, robot.frame)
    for pose in any_orientations(chain, WARM, np.random.default_rng([SEED, 1])):
        mik.solve_ik(chain, pose, solver=mik.IKSolver(budget=mik.Budget(evaluations=1_000)))
    rng = np.random.default_rng([SEED, 0])
    results, times = [], []
    for pose in chain.poses(chain.box.sample(rng, poses))[:, 0]:
        began = time.process_time_ns()
        results.append(mik.solve_ik(chain, pose))
        times.append(1e-3 * (time.process_time_ns() - began))
    ends = [mik.solve_ik(chain, pose).status for pose in any_orientations(chain, orientations, rng)]
    decided = [end in (mik.IKStatus.SOLVED, mik.IKStatus.UNREACHABLE) for end in ends]
    pairs, check = worlds(robot, chain, rng)
    return Coverage(
        name,
        chain.n,
        len(chain.form) > 0,
        float(np.mean([bool(result) for result in results])),
        float(np.median(times)),
        float(np.mean(decided)),
        pairs,
        check,
    )


def worlds(robot: mik.Robot, chain: mik.Chain, rng: np.random.Generator) -> tuple[int, float]:
    """Pairs of links that are checked, and the median time of a check, us."""
    try:
        world = mik.CollisionWorld(robot)
    except mik.MetaIKError:
        return 0, 0.0
    checked = sum(not reason for reason in world.pairs.values())
    times = []
    for x in chain.box.sample(rng, CHECKS):
        q = chain.q(x)
        began = time.process_time_ns()
        world.in_collision(q)
        times.append(1e-3 * (time.process_time_ns() - began))
    return checked, float(np.median(times))


def page(rows: Iterable[Coverage], poses: int, orientations: int) -> str:
    """The page, in Markdown."""
    rows = list(rows)
    lines = [
        "# Is my robot there?",
        "",
        f"{len(rows)} robots load by name; any other URDF, MJCF or DH table loads as a file.",
        "",
        conditions(),
        "",
        f"Solved: of {poses} poses of random configurations, to 1e-5 m and 1e-5 rad, and the median time of a call. "
        f"Decided: of {orientations} random orientations at reachable positions, the share that is solved or proved "
        "unreachable. "
        f"Pairs: of links that a world checks, and the median time of a check of {CHECKS} random configurations. "
        "Joints: degrees of freedom of the model, and those that place the tip.",
        "",
        "| robot | from | joints | to the tip | tip | closed form | solved | us | decided | pairs | us a check |",
        "|---|---|---:|---:|---|---|---:|---:|---:|---:|---:|",
        *(row.row() for row in rows),
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=500)
    parser.add_argument("--orientations", type=int, default=50)
    parser.add_argument("--robots", nargs="+", help="only these")
    parser.add_argument("--out", type=Path, help="the page to write; without it, print it")
    options = parser.parse_args()
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", UserWarning
        )  # robots whose files contradict themselves, told when they are loaded
        for name in mik.robot_names():
            if options.robots is None or name in options.robots:
                rows.append(coverage(name, options.poses, options.orientations))
                print(rows[-1].row(), flush=True)
    text = page(rows, options.poses, options.orientations)
    if options.out is None:
        print(text)
    else:
        options.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
