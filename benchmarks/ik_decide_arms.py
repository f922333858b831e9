"""What ``ik_decide.py`` measures of arms: targets decided, by class, by arm and by margin, and what a seed costs."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from grasp_scan import PlainArm
from numpy.typing import NDArray
from proof_soundness import CLOSED, OFF, named

import pin_metaik as mik

Floats = NDArray[np.float64]

SEED = 16
WARM = 20  # targets of another seed before anything is timed
MARGINS = (0.1, 0.03, 0.01, 1e-3, 1e-4, 3e-5)  # m or rad
BY_MARGIN = ("ur5", "puma560", "talos_arm", "aerial_arm", "panda", "xarm7", "pr2", "tiago", "baxter")
EACH = 25  # targets of an arm at a margin
ALL_OF = ("ur5", "puma560", "talos_arm")
DESCENTS, APART = 2_000, 1e-2
SEEDED = ("ur5", "rv7fl", "panda", "talos_arm", "tiago")
ROUNDS = 15  # of the three ways to give random numbers, by turns


@dataclass(frozen=True)
class Class:
    """Arms that are decided in the same way, and what is wanted of them.

    Attributes:
        name: What they are.
        robots: Their names; those with a sign before them have their joints 1e-3 off their place.
        proved: Share of the targets that are not solved which is to be proved unreachable.
        median: Time of a proof, ms.
        far: The time that 99 % of the proofs stay below, ms.
    """

    name: str
    robots: tuple[str, ...]
    proved: float
    median: float
    far: float


CLASSES = (
    Class("closed form", tuple(CLOSED), 0.999, 0.05, 0.5),
    Class("closed form, placements 1e-3 off", tuple(OFF + robot for robot in CLOSED), 0.99, 0.5, 30.0),
    Class("6 joints with a wrist", ("talos_arm",), 0.999, 0.4, 2.0),
    Class("other 6 joints", ("aerial_arm", "bravo7_no_ee", "alexander"), 0.99, 10.0, 60.0),
    Class("7 with a wrist at one end", ("panda", "xarm7"), 0.995, 1.0, 80.0),
    Class("other 7, and 8", ("pr2", "tiago", "romeo", "baxter"), 0.95, 5.0, 500.0),
)


@dataclass(frozen=True, eq=False)
class Decided:
    """What became of targets.

    Attributes:
        solved: (s,) times of those that were solved, ms.
        proved: (p,) of those that were proved unreachable.
        left: (o,) of those left open.
        seen: How many of the proved were out of the reach of the links alone.
    """

    solved: Floats
    proved: Floats
    left: Floats
    seen: int

    @property
    def share(self) -> str:
        """Of the targets that are not solved, the share that is proved unreachable."""
        missed = len(self.proved) + len(self.left)
        return f"{len(self.proved) / missed:.1%}" if missed else "-"

    @staticmethod
    def together(parts: Sequence[Decided]) -> Decided:
        """Of several arms."""
        times = (np.concatenate([getattr(part, name) for part in parts]) for name in ("solved", "proved", "left"))
        return Decided(*times, sum(part.seen for part in parts))


def any_orientations(chain: mik.Chain, count: int, rng: np.random.Generator) -> Floats:
    """Poses (count, 4, 4) at positions of random configurations, in random orientations."""
    poses: Floats = chain.poses(chain.box.sample(rng, count))[:, 0].copy()
    for pose in poses:
        pose[:3, :3] = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
    return poses


def timed(chain: mik.Chain, pose: Floats) -> tuple[mik.IKResult, float]:
    """The result for a target, and its time, ms. Asked once: what is remembered would cost less."""
    began = time.process_time()
    result = mik.solve_ik(chain, pose)
    return result, 1e3 * (time.process_time() - began)


def decided(robot: str, poses: Floats) -> Decided:
    """What becomes of targets (k, 4, 4) of a robot, one after the other."""
    chain = named(robot)
    for pose in any_orientations(chain, WARM, _rng(robot, 1)):
        mik.solve_ik(chain, pose)
    by_end: dict[str, list[float]] = {"solved": [], "proved": [], "left": []}
    seen = 0
    for pose in poses:
        result, ms = timed(chain, pose)
        proved = result.status is mik.IKStatus.UNREACHABLE
        by_end["solved" if result.success else "proved" if proved else "left"].append(ms)
        seen += proved and chain.reach(0, oriented=True).gap(pin.SE3(pose)) > 0.0
    return Decided(*(np.array(times) for times in by_end.values()), seen)


def arms(options: argparse.Namespace) -> list[str]:
    """Solved, proved and open, by class and by arm."""
    lines = [
        f"{options.targets} targets an arm: the position of a random configuration, and an orientation drawn from all. "
        "*By span*: of the proved those that are farther, or nearer, than the links can span. Times of one call, ms.",
        "",
        "| class | proved of the not solved (wanted) | median, ms (wanted) | 99 %, ms (wanted) |",
        "|---|---|---|---|",
    ]
    rows = []
    for one in CLASSES:
        robots = [robot for robot in one.robots if options.robots is None or robot in options.robots]
        parts = []
        for robot in robots:
            poses = any_orientations(named(robot), options.targets, _rng(robot, 0))
            parts.append(decided(robot, poses))
            rows.append(_row(robot, parts[-1]))
        if parts:
            whole = Decided.together(parts)
            lines.append(
                f"| {one.name} | {whole.share} ({one.proved:.1%}) | {_quantile(whole.proved, 0.5)} ({one.median:g}) "
                f"| {_quantile(whole.proved, 0.99)} ({one.far:g}) |"
            )
    lines += [
        "",
        "| arm | solved | proved | by span | open | proved of the not solved | proved: median | 99 % | solved: median "
        "| 99 % | median proved / solved | open: median |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        *rows,
        "",
        f"{OFF}: with its joints 1e-3 m and rad off their place, so that no two axes meet or are parallel.",
    ]
    return lines


def _row(robot: str, part: Decided) -> str:
    ratio = f"{np.median(part.proved) / np.median(part.solved):.3g}" if len(part.proved) and len(part.solved) else "-"
    counts = f"{len(part.solved)} | {len(part.proved)} | {part.seen} | {len(part.left)} | {part.share}"
    times = " | ".join(_quantile(part_times, q) for part_times in (part.proved, part.solved) for q in (0.5, 0.99))
    return f"| {robot} | {counts} | {times} | {ratio} | {_quantile(part.left, 0.5)} |"


def margins(options: argparse.Namespace) -> list[str]:
    """Targets that are out of reach by a margin: proved of how many, and in what time."""
    lines = [
        f"{EACH} targets an arm that are not solved, drawn as above, moved back to the nearest pose that was found and "
        "from there towards the target again, by the margin in m or rad, whichever comes first. Of those that are not "
        "solved: how many are proved, and the median time of a proof, ms. The nearest that is found need not be the "
        "nearest there is.",
        "",
        "| arm | " + " | ".join(f"{margin:g}" for margin in MARGINS) + " |",
        "|---|" + "---|" * len(MARGINS),
    ]
    for robot in BY_MARGIN:
        if options.robots is None or robot in options.robots:
            ways = out_of_reach(robot)
            cells = []
            for margin in MARGINS:
                part = decided(robot, np.array([beyond(*way, margin) for way in ways]))
                missed = len(part.proved) + len(part.left)
                cells.append(f"{len(part.proved)}/{missed}, {_quantile(part.proved, 0.5)}")
            lines.append(f"| {robot} | {' | '.join(cells)} |")
    return lines


def out_of_reach(robot: str) -> list[tuple[pin.SE3, pin.SE3]]:
    """Targets that are not solved, each after the nearest pose that was found."""
    chain, rng, found = named(robot), _rng(robot, 2), list[tuple[pin.SE3, pin.SE3]]()
    while len(found) < EACH:
        (pose,) = any_orientations(chain, 1, rng)
        result = mik.solve_ik(chain, pose)
        if not result.success and max(result.position_error, result.orientation_error) > MARGINS[0]:
            found.append((chain.placements(result.q)[0], pin.SE3(pose)))
    return found


def beyond(near: pin.SE3, far: pin.SE3, margin: float) -> Floats:
    """The pose (4, 4) on the way from a near to a far one that is the margin away, in m or rad."""
    step, turn = far.translation - near.translation, pin.log3(near.rotation.T @ far.rotation)
    share = margin / max(np.linalg.norm(step), np.linalg.norm(turn))
    return np.array(pin.SE3(near.rotation @ pin.exp3(share * turn), near.translation + share * step).homogeneous)


def complete(options: argparse.Namespace) -> list[str]:
    """How often ``solve_ik_all`` says that it has them all, and whether plain descents find others."""
    lines = [
        f"{options.targets} random poses an arm, `solve_ik_all`, and from {DESCENTS:,} random configurations each the "
        "plain descents of `benchmarks/grasp_scan.py`, to 1e-9. *Outside*: solutions of these that differ by more than "
        f"{APART:g} rad in some joint, whole turns aside, from all of a set that is called complete.",
        "",
        "| arm | called complete | solutions | found by descents | outside | median, ms | 99 % |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    for robot in ALL_OF:
        chain, arm, rng = named(robot), PlainArm.of(named(robot).model, named(robot).frames[0]), _rng(robot, 4)
        times, certain, have, others, outside = [], 0, 0, 0, 0
        for x in chain.box.sample(rng, options.targets):
            pose = chain.poses(x)[0, 0]
            began = time.process_time()
            found = mik.solve_ik_all(chain, pose)
            times.append(1e3 * (time.process_time() - began))
            X = arm.descend(rng.uniform(arm.lower, arm.upper, (DESCENTS, chain.n)), pose, np.ones(chain.n, bool), 1e-9)
            new = _apart(X, found.x)
            others, have, certain = others + len(X), have + len(found), certain + (found.complete is not None)
            outside += int(new.sum()) if found.complete else 0
        ms = np.array(times)
        lines.append(
            f"| {robot} | {certain / options.targets:.1%} | {have:,} | {others:,} | {outside} "
            f"| {_quantile(ms, 0.5)} | {_quantile(ms, 0.99)} |"
        )
    return lines


def _apart(X: Floats, known: Floats) -> NDArray[np.bool_]:
    """Which of X (k, n) differ from all that are known (s, n)."""
    away = (X[:, None] - known[None] + np.pi) % (2.0 * np.pi) - np.pi
    return np.asarray((np.abs(away).max(axis=2) > APART).all(axis=1))


def starts(options: argparse.Namespace) -> list[str]:
    """What it costs to give a seed or a generator."""
    lines = [
        "Random poses; a new seed for every call, or one generator for all. Mean times, us, the least of "
        f"{ROUNDS} rounds by turns, and ratios to the call without `rng`.",
        "",
        "| arm | without | seed | generator |",
        "|---|---:|---:|---:|",
    ]
    for robot in SEEDED:
        chain = named(robot)
        poses = list(chain.poses(chain.box.sample(_rng(robot, 3), options.targets))[:, 0].copy())
        best = np.full(3, np.inf)
        for number in range(ROUNDS):
            mine = np.random.default_rng(number)
            ways = [[None] * len(poses), range(number * len(poses), (number + 1) * len(poses)), [mine] * len(poses)]
            for way, given in enumerate(ways):
                began = time.process_time()
                for pose, rng in zip(poses, given, strict=True):
                    mik.solve_ik(chain, pose, rng=rng)
                best[way] = min(best[way], 1e6 * (time.process_time() - began) / len(poses))
        seed, generator = best[1:] / best[0]
        lines.append(f"| {robot} | {best[0]:.2f} | {best[1]:.2f} ({seed:.2f}) | {best[2]:.2f} ({generator:.2f}) |")
    return lines


def _quantile(times: Floats, q: float) -> str:
    return f"{np.quantile(times, q):.3g}" if len(times) else "-"


def _rng(robot: str, stream: int) -> np.random.Generator:
    return np.random.default_rng([SEED, stream, *robot.encode()])
