"""ikpy: bounded least squares of scipy with Jacobians by differences, started again at random."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.methods.method import Answer
from pin_metaik.compare.methods.peers.peer import TOLERANCE, Peer, Solve
from pin_metaik.compare.methods.peers.serial_arm import BASE, SerialArm


class _Spent(Exception):
    """The budget is."""


class _Counted:
    """Forward kinematics that are counted, and end when they are spent."""

    def __init__(self, forward: Any) -> None:
        self.forward, self.calls, self.budget = forward, 0, 0

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        if self.calls >= self.budget:
            raise _Spent
        self.calls += 1
        return self.forward(*arguments, **options)


def load(arm: SerialArm) -> Solve:
    """The arm as an ikpy chain."""
    from ikpy.chain import Chain

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        path.write_text(arm.urdf(), encoding="utf-8")
        mask = [False, *(True for _ in arm.names), False]
        chain = Chain.from_urdf_file(str(path), base_elements=[BASE], active_links_mask=mask)
    counted = _Counted(chain.forward_kinematics)
    chain.forward_kinematics = counted

    def solve(pose: Array, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        counted.calls, counted.budget = 0, budget
        x, start = x0, x0
        try:
            while True:
                found = chain.inverse_kinematics_frame(
                    pose, initial_position=[0.0, *start, 0.0], orientation_mode="all", tol=1e-12
                )
                x = np.asarray(found[1:-1], dtype=float)
                error = counted(found) - pose
                if np.linalg.norm(error[:3, 3]) <= TOLERANCE and np.linalg.norm(error[:3, :3]) <= TOLERANCE:
                    return Answer(x, True, counted.calls)
                start = rng.uniform(arm.lower, arm.upper)
        except _Spent:
            return Answer(x, False, counted.calls)

    return solve


IKPY = Peer("ikpy", "ikpy", "peers", load)
