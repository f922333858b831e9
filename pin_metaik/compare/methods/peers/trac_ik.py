"""TRAC-IK: Newton with joint limits and SQP race in two threads. It counts nothing: its budget is in seconds."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from pin_metaik.arrays import Array
from pin_metaik.compare.methods.method import Answer
from pin_metaik.compare.methods.peers.peer import TOLERANCE, Peer, Solve
from pin_metaik.compare.methods.peers.serial_arm import BASE, TIP, SerialArm

SECONDS = 0.05  # a target: its rows are not reproducible, and not at equal evaluations


def load(arm: SerialArm) -> Solve:
    """The arm as TRAC-IK reads it; its tolerance is for each axis."""
    import pytracik

    tolerance = 0.99 * TOLERANCE / np.sqrt(3.0)
    handle = pytracik.TRAC_IK(BASE, TIP, arm.urdf(), SECONDS, tolerance, pytracik.SolveType.Speed)

    def solve(pose: Array, x0: Array, budget: int, rng: np.random.Generator) -> Answer:
        xyzw = pin.Quaternion(pose[:3, :3]).coeffs()
        found = pytracik.ik(handle, x0, *pose[:3, 3].tolist(), *xyzw.tolist())
        claimed = bool(found[0] >= 0)
        x = np.clip(found[1:], arm.lower, arm.upper) if claimed else x0  # it keeps limits in single precision
        return Answer(np.asarray(x, dtype=float), claimed, None)

    return solve


TRAC_IK = Peer("trac_ik", "pytracik", "tracik", load)
