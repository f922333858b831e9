"""Robotics Toolbox: Levenberg-Marquardt in C++ with Chan's damping and restarts of its own."""

from __future__ import annotations

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.methods.cost import evaluations_of, steps_within
from pin_metaik.compare.methods.method import Answer
from pin_metaik.compare.methods.peers.peer import TOLERANCE, Peer, Solve
from pin_metaik.compare.methods.peers.serial_arm import SerialArm

DAMPING = 0.1  # of 10, 1, 0.1, 0.01 and 0.001 the one that took fewest steps over four arms
STEPS = 30  # a start, its default


def load(arm: SerialArm) -> Solve:
    """The arm as elementary transforms."""
    from roboticstoolbox import ET, ETS

    parts = []
    for i, kind in enumerate(arm.kinds):
        move = ET.tz if kind == "prismatic" else ET.Rz
        parts += [ET.SE3(arm.origins[i]), move(jindex=i, qlim=[arm.lower[i], arm.upper[i]])]
    ets = ETS([*parts, ET.SE3(arm.tip)]).compile()

    def solve(pose: Array, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        """One start a call, so that restarts are drawn from ``rng`` and the budget is kept."""
        left, x, spent = steps_within(budget), x0, 0
        while left > spent:
            found = ets.ik_LM(
                pose,
                q0=x,
                ilimit=min(STEPS, left - spent),
                slimit=1,
                tol=0.5 * TOLERANCE**2,
                k=DAMPING,
                method="chan",
            )
            spent += max(1, int(found.iterations))
            if found.success:
                return Answer(np.asarray(found.q, dtype=float), True, evaluations_of(spent))
            x = rng.uniform(arm.lower, arm.upper)
        return Answer(x0, False, evaluations_of(spent))

    return solve


TOOLBOX = Peer("toolbox", "roboticstoolbox", "roboticstoolbox", load)
