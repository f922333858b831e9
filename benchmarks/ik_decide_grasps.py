"""What ``ik_decide.py`` measures of grasps on a shelf: time, every verdict against a dense scan, and the same twice."""

from __future__ import annotations

import argparse
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context

import numpy as np
from collision_truth import Truth
from grasp_scan import COLLIDES, NONE, SOLVABLE, grasps, shelf_of, verdicts
from numpy.typing import NDArray

import pin_metaik as mik

Floats = NDArray[np.float64]

ROBOTS = {"panda": 3.0, "ur5": 0.4}  # and the processor time wanted for 300 grasps, s
MEANS = {SOLVABLE: {"SOLVED"}, COLLIDES: {"IN_COLLISION"}, NONE: {"UNREACHABLE", "OUT_OF_TOLERANCE"}}
Answers = list[tuple[bytes, str, float, float]]


def shelf(options: argparse.Namespace) -> list[str]:
    """Grasps screened in the world, and each verdict against the scan's."""
    lines = [
        f"{options.grasps} grasps of example 12, `solve_ik_batch(..., world=world, workers=1)`, against the dense scan "
        "of `benchmarks/grasp_scan.py`. *Denied*: the scan has a free solution and we have none. *Only ours*: we have "
        "one and the scan has none. *Other*: of a grasp that neither can do, one says in collision and the other no "
        "solution. *Wrong*: what we call solved collides, by `benchmarks/collision_truth.py`.",
        "",
        "| robot | s, all (wanted for 300) | ms a solved one | ms another | ends | agree | denied | only ours | other "
        "| wrong | scan, s |",
        "|---|---|---:|---:|---|---:|---:|---:|---:|---:|---:|",
    ]
    notes = []
    for robot, wanted in ROBOTS.items():
        chain, world = shelf_of(robot)
        poses = grasps(options.grasps)
        for pose in poses[:3]:
            mik.solve_ik(chain, pose, world=world)
        began = time.process_time()
        batch = mik.solve_ik_batch(chain, poses, world=world, workers=1)
        seconds = time.process_time() - began
        alone = [_alone(robot, pose) for pose in poses]
        scanned = verdicts(robot, poses, options.workers, options.kept_scan)
        ends = ", ".join(f"{many} {status}" for status, many in Counter(map(str, batch.status)).most_common())
        kinds = Counter[str]()
        for number, (scan, result) in enumerate(zip(scanned, batch, strict=True)):
            kind = compared(robot, scan.verdict, result)
            kinds[kind] += 1
            if kind != "agree":
                notes.append(
                    f"* {robot} {number}: {kind}; the scan: {scan.verdict} ({scan.solutions} solutions, the best "
                    f"{1e3 * scan.clearance:.3g} mm clear); ours: {result.status}, {result.why}"
                )
        solved = np.array([ms for ms, status in alone if status == "SOLVED"])
        others = np.array([ms for ms, status in alone if status != "SOLVED"])
        cells = " | ".join(str(kinds[kind]) for kind in ("agree", "denied", "only ours", "other", "wrong"))
        lines.append(
            f"| {robot} | {seconds:.2f} ({wanted:g}) | {_mean(solved)} | {_mean(others)} | {ends} | {cells} "
            f"| {sum(one.seconds for one in scanned):.0f} |"
        )
    return [*lines, "", *notes]


def _alone(robot: str, pose: Floats) -> tuple[float, str]:
    """The time of one grasp, ms, and how it ended."""
    chain, world = shelf_of(robot)
    began = time.process_time()
    result = mik.solve_ik(chain, pose, world=world)
    return 1e3 * (time.process_time() - began), str(result.status)


@cache
def _truth(robot: str) -> Truth:
    return Truth.of(shelf_of(robot)[1])


def compared(robot: str, scanned: str, result: mik.IKResult) -> str:
    """How a result compares with a scan's verdict."""
    if result.success and _truth(robot).least(result.q) <= 0.0:
        return "wrong"
    if str(result.status) in MEANS[scanned]:
        return "agree"
    if scanned == SOLVABLE:
        return "denied"
    return "only ours" if result.success else "other"


def twice(options: argparse.Namespace) -> list[str]:
    """Grasps screened twice in one process, in another one, and in a batch on two workers: identical or not."""
    lines = [
        f"{options.again} grasps, one after the other in one process, and again the other way round; in a process of "
        "their own; and as a batch on two workers. Equal: status, all bits of `q`, and both errors.",
        "",
        "| robot | again, the other way round | in another process | in a batch on two workers |",
        "|---|---:|---:|---:|",
    ]
    for robot in ROBOTS:
        poses = grasps(options.again)
        first = answers(robot, poses)
        again = answers(robot, poses[::-1])[::-1]
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            elsewhere = pool.submit(answers, robot, poses).result()
        chain, world = shelf_of(robot)
        batch = [_bits(result) for result in mik.solve_ik_batch(chain, poses, world=world, workers=2)]
        equal = [sum(a == b for a, b in zip(first, other, strict=True)) for other in (again, elsewhere, batch)]
        lines.append(f"| {robot} | " + " | ".join(f"{many} of {len(poses)}" for many in equal) + " |")
    return lines


def answers(robot: str, poses: Floats) -> Answers:
    """The answers to grasps, one after the other."""
    chain, world = shelf_of(robot)
    return [_bits(mik.solve_ik(chain, pose, world=world)) for pose in poses]


def _bits(result: mik.IKResult) -> tuple[bytes, str, float, float]:
    return result.q.tobytes(), str(result.status), result.position_error, result.orientation_error


def _mean(times: Floats) -> str:
    return f"{times.mean():.3g}" if len(times) else "-"
