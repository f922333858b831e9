"""Goals alone and in combinations: how many feasible problems are solved, how quickly, and whether the answers hold.

    python benchmarks/goals.py [solved legs tolerances wishes] [--count 1000] [--robots panda ur5 tiago talos]

Every problem is met by a random configuration, at the worst place that its goal has: at the edge of a box, a cone, a
range. An answer is verified by ``goal_cases.py``, in Pinocchio and NumPy without the package's goals. Writes the
sections named, default all, into ``goals.md``. Times are processor times of one call, one thread.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from time import thread_time

import numpy as np
import pinocchio as pin
from goal_cases import ALONE, TOGETHER, Make, Robot, Truth
from sections import conditions, page_with

import pin_metaik as mik
from pin_metaik import goals

PAGE = Path(__file__).with_suffix(".md")
TITLE = "# Goals that compose"
QUADRUPEDS = "solo12", "anymal"
TOLERANCES = (1e-5, 1e-3, 0.02)  # m and rad


def robot_of(name: str) -> Robot:
    """A robot, its tip, and a frame halfway to it."""
    robot = mik.load_robot(name)
    chain = mik.Chain(robot, robot.frame)
    model, last = chain.model, chain.model.frames[chain.frame_ids[0]].parentJoint
    way = [int(j) for j in model.supports[last] if int(j) in chain.movers]
    half = way[len(way) // 2 - 1]
    other = next(f.name for f in model.frames if f.type == pin.FrameType.BODY and f.parentJoint == half)
    return Robot(chain, chain.frames[0], other)


def counted(robot: Robot, makes: tuple[Make, ...], count: int) -> tuple[int, int, list[float], list[int]]:
    """Solved, verified, times (s) and evaluations of so many feasible problems."""
    rng, times, spent, solved, right = np.random.default_rng(0), [], [], 0, 0
    chain = robot.chain
    for _ in range(count):
        there = Truth(chain.model, chain.q(chain.box.sample(rng, 1)[0]))
        cases = [make(robot, there, rng) for make in makes]
        assert all(case.holds(there) for case in cases)
        asked = [case.goal for case in cases]
        began = thread_time()
        result = mik.solve_ik(chain, asked)
        times.append(thread_time() - began)
        spent.append(result.evaluations)
        at = Truth(chain.model, result.q)
        inside = chain.limits.contains(chain.x(result.q))
        solved += result.success
        right += result.success and inside and all(case.holds(at) for case in cases)
    return solved, right, times, spent


def solved(options: argparse.Namespace) -> list[str]:
    """Each goal alone, and the combinations, on arms."""
    return _solved(options.robots, options.count)


def legs(options: argparse.Namespace) -> list[str]:
    """The same on a leg of each quadruped, three joints from trunk to foot."""
    return _solved(QUADRUPEDS, options.count)


def _solved(robots: Sequence[str], count: int) -> list[str]:
    lines = [
        f"{count:,} feasible problems a row and robot. *Verified*: of all, those whose answer holds by the "
        "independent test. Median and 99 % of the time of a call, ms; of the evaluations, one a configuration, the "
        "median. `pose` and `position` of a chain's frame are evaluated by compiled loops, all others in Python.",
        "",
    ]
    for name in robots:
        robot = robot_of(name)
        lines += [
            f"### {name}",
            "",
            f"{robot.chain.n} joints, tip `{robot.tip}`, other frame `{robot.other}`.",
            "",
            "| goals | solved | verified | median, ms | 99 %, ms | evaluations |",
            "|---|---:|---:|---:|---:|---:|",
        ]
        sums = np.zeros(3, dtype=int)
        for kind, makes in {**ALONE, **TOGETHER}.items():
            met, right, times, spent = counted(robot, makes, count)
            sums += met, right, count
            half, late = 1e3 * np.quantile(times, [0.5, 0.99])
            rates = f"{_percent(met, count)} | {_percent(right, count)}"
            lines.append(f"| {kind} | {rates} | {half:.2f} | {late:.1f} | {np.median(spent):.0f} |")
            print(name, lines[-1], flush=True)
        lines += [f"| **all** | {_percent(sums[0], sums[2])} | {_percent(sums[1], sums[2])} | | | |", ""]
    return lines


def tolerances(options: argparse.Namespace) -> list[str]:
    """Targets that a configuration meets at 0.95 of a radius."""
    lines = [
        f"{options.count:,} targets a cell: the pose of a random configuration, moved by 0.95 of the tolerance in a "
        "random direction, position and orientation both. Solved, and verified by Pinocchio.",
        "",
        "| arm | " + " | ".join(f"{tolerance:g} m and rad" for tolerance in TOLERANCES) + " |",
        "|---|" + "---:|" * len(TOLERANCES),
    ]
    for name in ("so101", "ur5", "panda"):
        chain = robot_of(name).chain
        cells = [_percent(_moved(chain, tolerance, options.count), options.count) for tolerance in TOLERANCES]
        lines.append(f"| {name} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    return lines


def _moved(chain: mik.Chain, tolerance: float, count: int) -> int:
    """How many targets at 0.95 of the tolerance are met, by a placement of Pinocchio's of its own."""
    rng, met = np.random.default_rng(0), 0
    for _ in range(count):
        truth = Truth(chain.model, chain.q(chain.box.sample(rng, 1)[0]))
        here = truth.pose(chain.frames[0])
        shift, turn = (0.95 * tolerance * v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
        pose = pin.SE3(here.rotation @ pin.exp3(turn), here.translation + shift)
        target = mik.Target(pose, position_tolerance=tolerance, orientation_tolerance=tolerance)
        result = mik.solve_ik(chain, target)
        error = pose.actInv(Truth(chain.model, result.q).pose(chain.frames[0]))
        near = np.linalg.norm(error.translation) <= tolerance * 1.001
        met += bool(result.success and near and np.linalg.norm(pin.log3(error.rotation)) <= tolerance * 1.001)
    return met


def wishes(options: argparse.Namespace) -> list[str]:
    """Wishes beside a pose."""
    count = max(1, options.count // 10)
    lines = [
        f"{count:,} feasible poses a row. Mean distance from the wish, without it and with it. *Poses "
        "met*: in how many of them the pose is met as well.",
        "",
        "| robot | wish | unit | without | with | poses met | median, ms |",
        "|---|---|---|---:|---:|---:|---:|",
    ]
    for name in options.robots:
        robot = robot_of(name)
        chain = robot.chain
        for goal in (goals.MidRange(0), goals.Posture(chain.reference), goals.Manipulability(robot.tip, 10.0)):
            rng, times, offs, met = np.random.default_rng(0), [], [], 0
            for _ in range(count):
                pose = Truth(chain.model, chain.q(chain.box.sample(rng, 1)[0])).pose(robot.tip).copy()
                plain = mik.solve_ik(chain, pose)
                began = thread_time()
                result = mik.solve_ik(chain, [pose, goals.Wish(goal)])
                times.append(thread_time() - began)
                met += result.success
                offs.append([sum(goal.off(goals.Placed(chain, one.q)).values()) for one in (plain, result)])
            without, with_it = np.mean(offs, axis=0)
            took = 1e3 * np.median(times)
            cells = (
                f"{type(goal).__name__} | {goal.unit or '-'} | {without:.3g} | {with_it:.3g} | {_percent(met, count)}"
            )
            lines.append(f"| {name} | {cells} | {took:.1f} |")
            print(lines[-1], flush=True)
    return lines


def _percent(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.2f} %" if part < whole else "100 %"


SECTIONS: dict[str, tuple[str, Callable[[argparse.Namespace], list[str]]]] = {
    "solved": ("Alone and together", solved),
    "legs": ("Alone and together, on legs", legs),
    "tolerances": ("Targets at the edge of a radius", tolerances),
    "wishes": ("Wishes", wishes),
}


def main() -> None:
    """Measure the sections named and write them into the page, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", choices=[[], *SECTIONS], metavar="SECTION", help=", ".join(SECTIONS))
    parser.add_argument("--count", type=int, default=1000, help="problems a row")
    parser.add_argument("--out", type=Path, default=PAGE, help="the page to write")
    parser.add_argument("--robots", nargs="+", default=["panda", "ur5", "tiago", "talos"])
    options = parser.parse_args()
    for name in options.sections or SECTIONS:
        title, measure = SECTIONS[name]
        lines = [conditions(), "", *measure(options)]
        page = options.out.read_text(encoding="utf-8") if options.out.exists() else TITLE
        titles = [title for title, _ in SECTIONS.values()]
        options.out.write_text(page_with(page, TITLE, titles, title, lines), encoding="utf-8")


if __name__ == "__main__":
    main()
