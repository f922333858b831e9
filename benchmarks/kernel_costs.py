"""What forward kinematics with a Jacobian costs in units of forward kinematics alone, in the compiled loops.

    python benchmarks/kernel_costs.py

The figure is `FK_WITH_JACOBIAN` of `pin_metaik/compare/methods/cost.py`: comparisons charge it for every step of a
Jacobian method. It is a constant there, so that budgets, and with them the rows of a comparison, do not depend on the
day.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from statistics import geometric_mean

import numba
import numpy as np

import pin_metaik as mik
from pin_metaik.compiled import Floats, Ints
from pin_metaik.kinematics.kernel.forward import forward
from pin_metaik.kinematics.kernel.goals import jacobian, pose_error, residual
from pin_metaik.kinematics.kernel.layout import POSE

ROBOTS = ("panda", "ur5", "rv7fl", "baxter", "kinova", "pr2", "talos", "tiago", "ur10", "xarm7", "z1")
COUNT, ROUNDS = 4096, 200


def loop(with_jacobian: bool) -> Callable[..., None]:
    """A compiled loop over X (k, n) that computes costs out (k,), and with it the Jacobian J (n, 6) of a descent.

    Both loops are the same but for that. Their scratch arrays are the caller's, so that no compiler finds out that
    nobody reads the Jacobian.
    """

    @numba.njit(fastmath={"contract", "reassoc", "nsz", "arcp"}, error_model="numpy")
    def run(
        joints: Floats, wiring: Ints, ends: Ints, tips: Floats, goals: Floats, X: Floats, out: Floats, J: Floats,
        axes: Floats, origins: Floats, pose: Floats, error: Floats, r: Floats,
    ) -> None:  # fmt: skip
        S, goal = joints.shape[0], goals[0]
        for k in range(X.shape[0]):
            forward(joints, wiring, 0, S, tips[0], goal[:POSE], X[k], axes, origins, pose)
            pose_error(pose, error)
            residual(goal, error, r)
            if with_jacobian:
                J[:, :] = 0.0
                jacobian(joints, wiring, 0, S, goal, pose, axes, origins, error, False, J)
            out[k] = np.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2) + np.sqrt(r[3] ** 2 + r[4] ** 2 + r[5] ** 2)

    return run


def measured(robot: str, loops: Sequence[Callable[..., None]]) -> list[float]:
    """Least time in ns that an evaluation takes in each of the loops."""
    loaded = mik.load_robot(robot)
    chain = mik.Chain(loaded.model, loaded.frame)
    X = chain.box.sample(np.random.default_rng(0), COUNT)
    problem = mik.IKProblem.of(chain, chain.placements(chain.q(X[0]))[0])
    S = len(chain.paths.joints)
    scratch = [np.empty(shape) for shape in ((chain.n, 6), (S, 3), (S, 3), 12, 6, 6)]
    best = [np.inf] * len(loops)
    for _ in range(ROUNDS):  # in turn: a busy moment hits both
        for which, run in enumerate(loops):
            began = time.perf_counter_ns()
            run(*chain.paths.arrays, problem.records, X, np.empty(COUNT), *scratch)
            best[which] = min(best[which], (time.perf_counter_ns() - began) / COUNT)
    return best


def main() -> None:
    ratios, loops = [], (loop(False), loop(True))
    print(f"{'robot':8} {'FK, ns':>8} {'FK + J, ns':>11} {'ratio':>6}")
    for robot in ROBOTS:
        alone, both = measured(robot, loops)
        ratios.append(both / alone)
        print(f"{robot:8} {alone:8.0f} {both:11.0f} {both / alone:6.2f}")
    print(f"geometric mean of the ratios: {geometric_mean(ratios):.2f}")


if __name__ == "__main__":
    main()
