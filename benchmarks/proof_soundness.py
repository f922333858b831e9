"""Whether a proof is ever wrong: feasible targets, and boxes that hold a known solution, must never be excluded.

    python benchmarks/proof_soundness.py --boxes 1e7 --closed 1e7 --public 1e6 --workers 2 [--kept FILE]

Half of the arms are robots by name, some of them with joints 1e-3 off their place, half are random (see feasible.py).
Their configurations are random, at limits, in corners, at right angles and singular; their poses exact or moved by the
whole tolerance, in position and orientation at once.

* boxes: each target's box of all configurations is halved at random, always towards the known solution, forty times at
  most, and shown to every test on the way; and what is left of it where boxes are shrunk must hold the solution.
* closed: closed forms judge, those of arms that are off their place as well.
* public: ``solve_ik`` and ``solve_ik_batch`` are asked, and must not answer UNREACHABLE.

With ``--kept`` each part is written to a file when it is done, and not done again while the sources are the same: a run
may be broken off and goes on.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import platform
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from datetime import date
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from feasible import Feasible, feasible, random_chain, random_closed_form

import pin_metaik as mik
from pin_metaik.compare.cases.calibrated import measured
from pin_metaik.kinematics.proofs.arm import WHOLE, Free, ProofArm, proof_arm
from pin_metaik.kinematics.proofs.closed_forms import ClosedFormProof

CLOSED = ["ur5", "ur10", "rv7fl", "z1", "kinova", "puma560"]
OTHERS = ["talos_arm", "aerial_arm", "bravo7_no_ee", "alexander", "panda", "xarm7"]
OTHERS += ["pr2", "tiago", "romeo", "baxter", "centauro"]
OFF = "~"  # before a name: joints 1e-3 off their place
NAMED = [*CLOSED, *(OFF + robot for robot in CLOSED), *OTHERS]
FREE: list[Free] = [WHOLE, (True, False, False), (False, False, True), (True, True, True)]
HALVINGS = 40
ROOM = 16  # for the parts that one box may be taken into
ROUNDING = 1e-9  # rad or m
SHARE = 100_000  # boxes or targets of one part
DEFAULT = 1e-5  # m and rad; tolerances of targets that are arrays
FEW = mik.IKSolver(budget=mik.Budget(evaluations=4_000))  # boxes included: enough for proofs to be tried


class Counts(NamedTuple):
    """What came of many: how many were looked at, how many of them were called out of reach, and of how many arms."""

    looked: int
    wrong: int
    arms: int


@cache
def named(robot: str) -> mik.Chain:
    """The chain of a robot by name."""
    loaded = mik.load_robot(robot.removeprefix(OFF))
    if robot.startswith(OFF):
        return measured(loaded, np.random.default_rng(0))
    return mik.Chain(loaded.model, loaded.frame)


def boxes(seed: int, count: int) -> Counts:
    """Boxes that hold a solution, and how many of them were excluded."""
    rng = np.random.default_rng([seed, 1])
    looked = wrong = arms = 0
    while looked < count:
        chain = named(str(rng.choice(NAMED))) if rng.random() < 0.5 else random_chain(rng)
        arms += 1
        by_aim = {free: proof_arm(chain.paths, chain.limits, 0, free) for free in FREE}
        for _ in range(20):
            target, free = feasible(chain, rng), FREE[rng.choice(len(FREE), p=[0.7, 0.1, 0.1, 0.1])]
            if (arm := by_aim[free]) is not None:
                for excluded in halved(arm, target, free, rng):
                    looked += 1
                    wrong += excluded
    return Counts(looked, wrong, arms)


def halved(arm: ProofArm, target: Feasible, free: Free, rng: np.random.Generator) -> list[bool]:
    """Whether each box on the way from all configurations towards the solution is excluded, or loses it when shrunk."""
    pose, x, near = target.pose.copy(), target.x, math.inf if rng.random() < 0.05 else target.near
    aligned = 0.1 if all(free) else target.aligned
    axes = "zyz" if all(free) else "xyz"[free.index(True)] if any(free) else ""
    for axis in axes:  # the free joints at the tip
        x = np.append(x, rng.uniform(-np.pi, np.pi))
        pose[:3, :3] = pose[:3, :3] @ pin.utils.rotate(axis, float(x[-1]))
    asked, shrinking = arm.target(pose, near, aligned), arm.shrinking
    m = arm.whole.shape[1] // 2
    centre, width = arm.whole[0, :m].copy(), arm.whole[0, m:].copy()
    x = np.clip(x, centre - width, centre + width)
    waiting, leaves, answers = np.empty((ROOM, 2 * m)), np.empty((2, 2 * m)), []
    for _ in range(rng.integers(1, HALVINGS)):
        waiting[0] = np.append(centre, width)
        looked, kept, left = arm.cover(*arm.arrays, *asked, waiting, 1, 0.0, 1, leaves)
        answers.append(looked != 1 or (left == 0 and kept == 0))
        waiting[0] = np.append(centre, width)
        least = 10.0 ** rng.uniform(-4.0, 0.5)
        looked, kept, left = shrinking.cover(*shrinking.arrays, *asked, waiting, 1, least, 1, leaves)
        rest = np.concatenate([waiting[:left], leaves[:kept]])
        answers.append(looked != 1 or not (np.abs(rest[:, :m] - x) <= rest[:, m:] + ROUNDING).all(axis=1).any())
        c = rng.integers(m)
        width[c] *= 0.5
        centre[c] += width[c] if x[c] > centre[c] else -width[c]
    return answers


def closed(seed: int, count: int) -> Counts:
    """Feasible targets judged by closed forms: of robots, of robots off their place, and of random arms."""
    rng = np.random.default_rng([seed, 2])
    robots = [(named(robot), _proof(named(robot), named(robot))) for robot in CLOSED]
    robots += [(named(OFF + robot), _proof(named(robot), named(OFF + robot))) for robot in CLOSED]
    looked = wrong = arms = 0
    while looked < count:
        if rng.random() < 0.5:
            chain, proof = robots[rng.integers(len(robots))]
        else:
            chain = random_closed_form(rng)
            proof = _proof(chain, chain)
        arms += 1
        for _ in range(min(100, count - looked)):
            target = feasible(chain, rng, (1e-7, 1e-2))
            looked += 1
            wrong += proof.judge(target.pose, target.near, target.aligned).proved
    return Counts(looked, wrong, arms)


def _proof(ideal: mik.Chain, chain: mik.Chain) -> ClosedFormProof:
    """The proof for an arm by the closed form of what it was meant to be."""
    return ClosedFormProof.of(ideal.form, chain.paths, chain.limits)


def public(seed: int, count: int) -> Counts:
    """Feasible targets given to ``solve_ik``, with any tolerances, and to ``solve_ik_batch``, with the default ones."""
    rng = np.random.default_rng([seed, 3])
    looked = wrong = arms = 0
    while looked < count:
        kind = rng.random()
        if kind < 0.5:
            chain, each = named(str(rng.choice(NAMED))), 100
        else:
            chain, each = random_chain(rng) if kind < 0.75 else random_closed_form(rng), 25
        arms += 1
        for _ in range(each):
            target = feasible(chain, rng, (1e-7, 1e-2))
            asked = mik.Target(
                pin.SE3(target.pose), position_tolerance=target.near, orientation_tolerance=target.aligned
            )
            wrong += mik.solve_ik(chain, asked, solver=FEW).status is mik.IKStatus.UNREACHABLE
        poses = np.array([feasible(chain, rng, (DEFAULT, DEFAULT)).pose for _ in range(each)])
        positions = poses[:, :3, 3]
        for given in poses, positions:
            batch = mik.solve_ik_batch(chain, given, solver=FEW, workers=1)
            wrong += int((batch.status == mik.IKStatus.UNREACHABLE).sum())
        looked += 3 * each
    return Counts(looked, wrong, arms)


@dataclass(frozen=True)
class Kind:
    """A kind of question: what it is called, and what asks it."""

    title: str
    work: Callable[[int, int], Counts]


KINDS = {
    "boxes": Kind("boxes that hold a solution", boxes),
    "closed": Kind("feasible targets, by closed forms", closed),
    "public": Kind("feasible targets, through solve_ik and solve_ik_batch", public),
}


def part(of: str, kind: str, seed: int, count: int) -> tuple[str, str, int, int, Counts]:
    """One part of many, in a process of its own."""
    return of, kind, seed, count, KINDS[kind].work(seed, count)


def sources(*more: Path) -> str:
    """A digest of the sources, the package's and of what asks it: what was counted holds for these."""
    asking = (Path(__file__), Path(__file__).with_name("feasible.py"), *more)
    files = [*sorted(Path(mik.__file__).parent.rglob("*.py")), *asking]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:16]


def counted(kind: str, count: int, workers: int, seed: int = 0, kept: Path | None = None) -> Counts:
    """Ask a kind of question ``count`` times in parts, less those that a file has the answers of already."""
    of = sources()
    parts = [(of, kind, seed + i, min(SHARE, count - i * SHARE)) for i in range(-(-count // SHARE))]
    lines = kept.read_text(encoding="utf-8").splitlines() if kept is not None and kept.exists() else []
    known = {tuple(line[:4]): Counts(*line[4]) for line in map(json.loads, lines)}
    with ProcessPoolExecutor(workers) as pool:
        for future in as_completed([pool.submit(part, *one) for one in parts if one not in known]):
            *name, counts = future.result()
            known[tuple(name)] = counts
            if kept is not None:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps([*name, counts]) + "\n")
    return Counts(*np.sum([known[one] for one in parts], axis=0).tolist()) if parts else Counts(0, 0, 0)


def main() -> None:
    """Ask all three in as many processes as wanted, and print what came out."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for kind in KINDS:
        parser.add_argument(f"--{kind}", type=float, default=1e6 if kind != "public" else 1e5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kept", type=Path, help="file that finished parts are kept in")
    given = parser.parse_args()
    print(f"{date.today()}, {platform.machine()}, pin_metaik {mik.__version__}, seed {given.seed}")
    for kind, asked in KINDS.items():
        began = time.perf_counter()
        looked, wrong, arms = counted(kind, int(getattr(given, kind)), given.workers, given.seed, given.kept)
        seconds = time.perf_counter() - began
        print(f"{looked:,} {asked.title}, of {arms:,} arms: {wrong} called out of reach ({seconds:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
