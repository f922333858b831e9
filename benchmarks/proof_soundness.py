"""Whether a proof is ever wrong: feasible targets, and boxes that hold a known solution, must never be excluded.

    python benchmarks/proof_soundness.py --boxes 10000000 --targets 10000000 --jobs 2

Half of the boxes are of named robots, half of random arms (see feasible.py). Each target's box of all configurations is
halved at random, always towards the known solution, forty times at most, and shown to every test on the way. Closed
forms judge the same families of targets.
"""

from __future__ import annotations

import argparse
import math
import platform
import time
from concurrent.futures import ProcessPoolExecutor
from datetime import date
from functools import cache

import numpy as np
import pinocchio as pin
from feasible import Feasible, feasible, random_chain

import pin_metaik as mik
from pin_metaik.kinematics.proofs.arm import WHOLE, Free, ProofArm, proof_arm
from pin_metaik.kinematics.proofs.box_search import cover
from pin_metaik.kinematics.proofs.closed_forms import ClosedFormProof

CLOSED = ["ur5", "ur10", "rv7fl", "z1", "kinova", "puma560"]
OTHERS = ["talos_arm", "aerial_arm", "panda", "xarm7", "pr2", "tiago", "romeo", "baxter"]
FREE: list[Free] = [WHOLE, (True, False, False), (False, False, True), (True, True, True)]
HALVINGS = 40
SHARE = 100_000  # boxes or targets of one job


@cache
def named(robot: str) -> mik.Chain:
    """The chain of a robot by name."""
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def boxes(seed: int, count: int) -> tuple[int, int, int]:
    """Boxes that hold a solution, how many of them were excluded, and how many arms they were of."""
    rng = np.random.default_rng([seed, 1])
    looked = wrong = arms = 0
    while looked < count:
        chain = named(str(rng.choice(CLOSED + OTHERS))) if rng.random() < 0.5 else random_chain(rng)
        arms += 1
        for _ in range(20):
            target, free = feasible(chain, rng), FREE[rng.choice(len(FREE), p=[0.7, 0.1, 0.1, 0.1])]
            arm = proof_arm(chain.paths, chain.limits, 0, free)
            if arm is not None:
                for excluded in halved(arm, target, free, rng):
                    looked += 1
                    wrong += excluded
    return looked, wrong, arms


def halved(arm: ProofArm, target: Feasible, free: Free, rng: np.random.Generator) -> list[bool]:
    """Whether each box on the way from all configurations towards the solution is excluded."""
    pose, x, near = target.pose.copy(), target.x, math.inf if rng.random() < 0.05 else target.near
    aligned = 0.1 if all(free) else target.aligned
    axes = "zyz" if all(free) else "xyz"[free.index(True)] if any(free) else ""
    for axis in axes:  # the free joints at the tip
        x = np.append(x, rng.uniform(-np.pi, np.pi))
        pose[:3, :3] = pose[:3, :3] @ pin.utils.rotate(axis, float(x[-1]))
    asked = arm.target(pose, near, aligned)
    m = arm.whole.shape[1] // 2
    centre, width = arm.whole[0, :m].copy(), arm.whole[0, m:].copy()
    x = np.clip(x, centre - width, centre + width)
    waiting, leaves, answers = np.empty((2, 2 * m)), np.empty((1, 2 * m)), []
    for _ in range(rng.integers(1, HALVINGS)):
        waiting[0] = np.append(centre, width)
        _, kept, left = cover(*arm.arrays, *asked, waiting, 1, 0.0, 1, leaves)
        answers.append(left == 0 and kept == 0)
        c = rng.integers(m)
        width[c] *= 0.5
        centre[c] += width[c] if x[c] > centre[c] else -width[c]
    return answers


def closed(seed: int, count: int) -> tuple[int, int, int]:
    """Feasible targets judged by closed forms, how many were called out of reach, and of how many arms."""
    rng = np.random.default_rng([seed, 2])
    chains = [named(robot) for robot in CLOSED]
    proofs = [(chain, ClosedFormProof.of(chain.form, chain.paths, chain.limits)) for chain in chains]
    wrong = 0
    for _ in range(count):
        chain, proof = proofs[rng.integers(len(proofs))]
        target = feasible(chain, rng, (1e-7, 1e-2))
        wrong += proof.judge(target.pose, target.near, target.aligned).proved
    return count, wrong, len(proofs)


def main() -> None:
    """Run both in as many processes as asked, and print what came out."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boxes", type=int, default=1_000_000)
    parser.add_argument("--targets", type=int, default=1_000_000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    print(f"{date.today()}, {platform.machine()}, pin_metaik {mik.__version__}")
    for title, work, count in ("boxes that hold a solution", boxes, given.boxes), ("targets", closed, given.targets):
        began = time.perf_counter()
        seeds = range(given.seed, given.seed + -(-count // SHARE))
        with ProcessPoolExecutor(given.jobs) as pool:
            rows = np.array(list(pool.map(work, seeds, [min(SHARE, count)] * len(seeds))))
        looked, wrong, arms = rows.sum(axis=0)
        print(f"{looked:,} {title} of {arms:,} arms: {wrong} called out of reach ({time.perf_counter() - began:.0f} s)")


if __name__ == "__main__":
    main()
