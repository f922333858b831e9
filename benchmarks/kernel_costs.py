"""What forward kinematics with a Jacobian costs in units of forward kinematics alone, in the compiled loops.

    python benchmarks/kernel_costs.py

The figure is `FK_WITH_JACOBIAN` of `pin_metaik/compare/cost.py`: comparisons charge it for every step of a Jacobian
method. It is a constant there, so that budgets, and with them the rows of a comparison, do not depend on the day.
"""

from __future__ import annotations

import time
from statistics import geometric_mean

import numba
import numpy as np

import pin_metaik as mik
from pin_metaik.compiled import Floats, Ints
from pin_metaik.kinematics.descent import Arm, evaluate_pose, workspace

ROBOTS = ("panda", "ur5", "rv7fl", "baxter", "kinova", "pr2", "talos", "tiago", "ur10", "xarm7", "z1")
COUNT, ROUNDS = 4096, 200


@numba.njit(fastmath={"contract", "reassoc", "nsz", "arcp"}, error_model="numpy")
def linearized(joints: Floats, wiring: Ints, ends: Ints, tips: Floats, tasks: Floats, X: Floats, out: Floats) -> None:
    """Squared residual (k,) at every row of X (k, n), with the Jacobian a descent needs there."""
    arm: Arm = (joints, wiring, ends, tips)
    work = workspace(X.shape[1], 6, joints.shape[0])
    for i in range(X.shape[0]):
        out[i] = evaluate_pose(arm, tasks[0], X[i], work)[0] + work[5][0, 0]


def measured(robot: str) -> tuple[float, float]:
    """Least time in ns of an evaluation: forward kinematics with its cost, and with residual and Jacobian."""
    loaded = mik.load_robot(robot)
    chain = mik.Chain(loaded.model, loaded.frame)
    X = chain.box.sample(np.random.default_rng(0), COUNT)
    problem = mik.IKProblem.of(chain, chain.placements(chain.q(X[0]))[0])
    costs, out, arm = chain.kernels.costs.compiled(), np.empty(COUNT), chain.paths.arrays
    best = [np.inf, np.inf]
    for _ in range(ROUNDS):  # in turn: a busy moment hits both
        for which, loop in enumerate((costs, linearized)):
            began = time.perf_counter_ns()
            loop(*arm, problem.tasks, X, out)
            best[which] = min(best[which], (time.perf_counter_ns() - began) / COUNT)
    return best[0], best[1]


def main() -> None:
    ratios = []
    print(f"{'robot':8} {'FK, ns':>8} {'FK + J, ns':>11} {'ratio':>6}")
    for robot in ROBOTS:
        alone, both = measured(robot)
        ratios.append(both / alone)
        print(f"{robot:8} {alone:8.0f} {both:11.0f} {both / alone:6.2f}")
    print(f"geometric mean of the ratios: {geometric_mean(ratios):.2f}")


if __name__ == "__main__":
    main()
