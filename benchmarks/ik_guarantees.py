"""What ``pin_metaik`` promises beyond speed, counted: all solutions, the nearest one, paths, repeatability, limits.

    pip install eaik                                     # in an environment of its own
    python benchmarks/ik_guarantees.py --eaik PYTHON --out benchmarks/ik_guarantees.md

``--eaik`` names the interpreter of an environment that has EAIK, whose closed forms say which solutions exist; without
it that row is left out.
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import numpy as np
import pinocchio as pin
from ik_serial import SerialArm
from ik_speed import LOADING, ROBOTS, SLACK, Worker, judged
from ik_targets import targets
from numpy.typing import NDArray
from rich.progress import track

import pin_metaik as mik

TURN = 2.0 * np.pi
APART = 1e-2  # rad between distinct solutions
DOWN = pin.rpy.rpyToMatrix(np.pi, 0.0, 0.2)
LINE = [pin.SE3(DOWN, np.array([0.35, y, 0.35])) for y in np.linspace(-0.3, 0.3, 200)]
CIRCLE = [pin.SE3(DOWN, np.array([0.45 + 0.12 * np.cos(a), 0.12 * np.sin(a), 0.4])) for a in np.linspace(0, TURN, 200)]
HANDS = ["gripper_left_base_link", "gripper_right_base_link"]

Floats = NDArray[np.float64]
Row = tuple[str, str]


def chain_of(robot: str) -> mik.Chain:
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def all_solutions(robot: str, python: str, count: int) -> Row:
    """Of the solutions that closed forms have inside the limits, how many ``solve_ik_all`` finds."""
    chain = chain_of(robot)
    some = targets(robot, chain, "random", count, 7)
    poses = some.poses
    worker = Worker("eaik", python)
    arm = SerialArm.of_chain(robot, chain).to_json()
    worker.ask(LOADING, do="load", arm=arm, poses=poses[:1].tolist(), starts=some.starts[:1].tolist())
    theirs = worker.ask(LOADING, do="every", poses=poses.tolist())["every"]
    worker.close()
    known = found = ours = 0
    took = []
    mik.solve_ik_all(chain, poses[0])
    for pose, solutions in zip(track(poses, f"all of {robot}", transient=True), theirs, strict=True):
        began = perf_counter()
        every = mik.solve_ik_all(chain, pose)
        took.append(1e3 * (perf_counter() - began))
        ours += len(every)
        for x in solutions:
            if judged(chain, pose[None], [x])[0]:
                away = chain.limits.separation(every.x, np.array(x))
                known, found = known + 1, found + bool((away.max(axis=1) <= APART).any())
    share = f"{found:,} of {known:,} that EAIK finds ({100.0 * found / known:.2f} %), {ours:,} in all"
    return f"`solve_ik_all`, {robot}, {count} poses", f"{share}; median {np.median(took):.1f} ms"


def nearest(robot: str, count: int) -> Row:
    """How often the nearest of all solutions is nearer to the start than what ``select="nearest"`` gives."""
    chain = chain_of(robot)
    some = targets(robot, chain, "random", count, 8)
    solver = mik.IKSolver(select="nearest")
    worse = 0
    took = []
    for pose, start in zip(track(some.poses, f"nearest of {robot}", transient=True), some.starts, strict=True):
        q0 = chain.q(start)
        began = perf_counter()
        chosen = mik.solve_ik(chain, pose, q0, solver=solver)
        took.append(1e3 * (perf_counter() - began))
        least = np.linalg.norm(mik.solve_ik_all(chain, pose, q0).x - start, axis=1).min()
        worse += not chosen.success or np.linalg.norm(chosen.x - start) > least + 1e-6  # both are met to 1e-9 or so
    return (
        f'`select="nearest"`, {robot}, {count} poses',
        f"farther than the nearest of all: {worse}; median {np.median(took):.1f} ms",
    )


def paths() -> Iterator[Row]:
    """A line and a circle of 200 poses, and a line through a wrist singularity."""
    for robot in ("panda", "ur5"):
        chain = chain_of(robot)
        for name, poses in {"line": LINE, "circle": CIRCLE}.items():
            path = mik.solve_ik_path(chain, poses, max_step=0.1)
            met = judged(chain, np.array([pose.homogeneous for pose in poses]), chain.x(path.q).tolist())
            longest = np.abs(np.diff(path.x, axis=0)).max()
            yield (
                f"`solve_ik_path`, {robot}, {name} of 200 poses, steps up to 0.1 rad",
                f"{sum(met)} met, longest step {longest:.3f} rad, {path.seconds:.2f} s",
            )
    chain = chain_of("puma560")
    goal = chain.placements(chain.q([0.0, 0.5, -2.0, 0.0, 0.0, 0.0]))[0]
    poses = [pin.SE3(goal.rotation, goal.translation + np.array([0.0, y, 0.0])) for y in np.linspace(-0.1, 0.1, 60)]
    path = mik.solve_ik_path(chain, poses, max_step=0.15)
    steps = np.abs(np.diff(path.x, axis=0)).max(axis=1)
    silent = set((np.flatnonzero(steps > 0.15) + 1).tolist()) - set(path.breaks)
    yield (
        "`solve_ik_path`, puma560, through a wrist singularity, steps up to 0.15 rad",
        f"{path.success.sum()} of 60 met, {len(path.breaks)} breaks reported, {len(silent)} jumps not reported",
    )


def every_robot(count: int) -> Row:
    """Random reachable poses and positions of every robot that can be loaded by name."""
    names = mik.robot_names()
    missed: list[str] = []
    for name in track(names, "every robot", transient=True):
        chain = chain_of(name.name)
        poses = chain.poses(chain.box.sample(np.random.default_rng(12), count))[:, 0]
        for asked in (poses, poses[:, :3, 3]):
            missed += [name.name for result in mik.solve_ik_batch(chain, asked) if not result.verify()]
    asked_for = f"{len(names)} robots x {count} poses and as many positions"
    return f"every robot by name: {asked_for}", f"missed: {len(missed)}" + f" ({', '.join(missed)})" * bool(missed)


def never_unreachable(count: int) -> Row:
    """Of targets that a configuration meets, at tolerances from 1e-9 on, how many are proved to be out of reach."""
    rng = np.random.default_rng(13)
    wrong = asked = 0
    for robot in track(ROBOTS, "feasible targets", transient=True):
        chain = chain_of(robot)
        X = chain.box.sample(rng, count)
        ends = np.where(rng.random(X.shape) < 0.5, chain.box.lower, chain.box.upper)
        X = np.where(rng.random(X.shape) < rng.choice([0.0, 0.5, 1.0], (count, 1)), ends, X)
        for q in chain.q(X):
            pose = chain.placements(q)[0]
            near, aligned = 10.0 ** rng.uniform(-9, -1), 10.0 ** rng.uniform(-9, 0)
            offset, turn = (v / np.linalg.norm(v) for v in rng.standard_normal((2, 3)))
            error = pin.SE3(pin.exp3(0.95 * aligned * turn), 0.95 * near * offset)
            problem = mik.IKProblem.of(chain, mik.Target(pose * error.inverse(), None, near, aligned))
            asked, wrong = asked + 1, wrong + (problem.accepts(q) and problem.gap > 0.0)
    return f"{asked:,} targets that a configuration meets by 5 % of the tolerance", f"proved unreachable: {wrong}"


def fingerprint(count: int) -> str:
    """Of the answers of all robots, alone and in batches with one worker and with two, which must be the same bits."""
    digest = hashlib.sha256()
    for robot in ROBOTS:
        chain = chain_of(robot)
        some = targets(robot, chain, "random", count, 9)
        starts = chain.q(some.starts)
        alone = np.array([mik.solve_ik(chain, pose, q0).q for pose, q0 in zip(some.poses, starts, strict=True)])
        for workers in (1, 2):
            batch = mik.solve_ik_batch(chain, some.poses, starts, workers=workers).q
            if not np.array_equal(batch, alone):
                return f"{robot}: {workers} workers differ"
        digest.update(alone.tobytes())
    return digest.hexdigest()


def repeatable(count: int) -> Row:
    """The same answers in this process, in another, and with one worker or two."""
    fresh = [sys.executable, __file__, "--fingerprint", str(count)]
    here, there = fingerprint(count), subprocess.run(fresh, capture_output=True, text=True, check=True).stdout.strip()
    verdict = "the same bits" if here == there and ":" not in here else f"differ: {here}, {there}"
    return f"{len(ROBOTS)} robots x {count} poses: alone, 1 worker, 2 workers, another process", verdict


def two_hands(count: int) -> Row:
    """Pairs of poses for both grippers of a humanoid."""
    chain = mik.Chain(mik.load_robot("talos").model, HANDS)
    X = chain.box.sample(np.random.default_rng(10), count)
    solved = 0
    took = []
    for pair in track(chain.poses(X), "two hands", transient=True):
        began = perf_counter()
        result = mik.solve_ik(chain, [pin.SE3(pose) for pose in pair])
        took.append(1e3 * (perf_counter() - began))
        solved += result.success and result.verify()
    return (
        f"both grippers of talos, {chain.n} joints, {count} pairs",
        f"{solved} solved; median {np.median(took):.2f} ms",
    )


def quadratic_programs(count: int) -> Row:
    """Answers of the QP refiner with OSQP that are past a limit."""
    solver = mik.IKSolver(seeder=None, refiner="qp", budget=mik.Budget(evaluations=300))
    violations = solved = 0
    for robot in track(ROBOTS, "OSQP", transient=True):
        chain = chain_of(robot)
        some = targets(robot, chain, "near-limit", count, 11)
        for pose, start in zip(some.poses, some.starts, strict=True):
            result = mik.solve_ik(chain, pose, chain.q(start), solver=solver)
            violations += not chain.limits.contains(result.x)
            solved += result.success
    asked = count * len(ROBOTS)
    return (
        f"QP with OSQP, {asked:,} near-limit poses, at most 300 evaluations each",
        f"{violations} answers past a limit; {100.0 * solved / asked:.1f} % solved",
    )


def rows(options: argparse.Namespace) -> Iterator[Row]:
    for robot in ("ur5", "puma560"):
        if options.eaik:
            yield all_solutions(robot, options.eaik, options.poses)
    yield nearest("ur5", options.poses)
    yield from paths()
    yield every_robot(options.poses)
    yield never_unreachable(20 * options.poses)
    yield repeatable(options.poses)
    yield two_hands(2 * options.poses)
    yield quadratic_programs(2 * options.poses)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--eaik", metavar="PYTHON", help="interpreter of an environment that has EAIK")
    parser.add_argument("--poses", type=int, default=500, help="of most rows (%(default)s)")
    parser.add_argument("--out", type=Path, help="Markdown file; default: standard output")
    parser.add_argument("--fingerprint", type=int, metavar="COUNT", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.fingerprint:
        print(fingerprint(options.fingerprint))
        return
    command = f"python benchmarks/ik_guarantees.py --poses {options.poses}" + " --eaik PYTHON" * bool(options.eaik)
    lines = [
        "# Further counts",
        "",
        f"`{command}`, {datetime.date.today()}, {os.cpu_count()}-core x86-64, shared. Met: 1e-5 m, 1e-5 rad and inside "
        f"the limits (to {SLACK:g}), by Pinocchio.",
        "",
        "| what | measured |",
        "|---|---|",
    ]
    for what, measured in rows(options):
        print(f"{what}: {measured}", flush=True)
        lines.append(f"| {what} | {measured} |")
    if options.out:
        options.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
