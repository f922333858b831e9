"""Whether an answer is one: judged by Pinocchio alone, from the model as it was given, in formulas of its own."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ROUNDING = 1e-12  # m and rad: of forward kinematics computed twice
UNIT = 1e-9  # by how much the length of a quaternion, or of a cosine and sine, may differ from 1


class Judge:
    """Forward kinematics and limits of a model, apart from all that solvers keep."""

    def __init__(self, model: pin.Model, frames: Sequence[int]) -> None:
        """Take the frames by their ids, and find which entries have limits."""
        self.model, self.data = model, model.createData()
        self.frames = list(frames)
        single = [joint for joint in list(model.joints)[1:] if joint.nq]
        entries = [np.arange(joint.idx_q, joint.idx_q + joint.nq) for joint in single]
        units, plain = list[NDArray[np.int64]](), list[int]()
        for joint, own in zip(single, entries, strict=True):
            for unit, numbers in _parts(joint, own):
                units += unit
                plain += numbers
        self.units = units
        self.plain = np.array(plain, dtype=np.int64)
        self.lower, self.upper = model.lowerPositionLimit[self.plain], model.upperPositionLimit[self.plain]

    def errors(self, q: Floats, poses: Floats) -> list[tuple[float, float]]:
        """Distance (m) and angle (rad) of each frame at q (nq,) from its pose (T, 4, 4)."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return [error(self.data.oMf[f].homogeneous, pose) for f, pose in zip(self.frames, poses, strict=True)]

    def outside(self, q: Floats) -> bool:
        """Whether q (nq,) is no configuration, or breaks a limit of any joint of the model, by however little."""
        x = q[self.plain]
        if not (np.isfinite(q).all() and (self.lower <= x).all() and (x <= self.upper).all()):
            return True
        return any(abs(np.linalg.norm(q[unit]) - 1.0) > UNIT for unit in self.units)


def error(reached: Floats, asked: Floats) -> tuple[float, float]:
    """Distance (m) and angle (rad) between two poses (4, 4): |R - S| = 2 sqrt(2) sin(angle / 2), for matrices."""
    d = reached - asked
    chord = float(np.linalg.norm(d[:3, :3])) / math.sqrt(8.0)
    return float(np.linalg.norm(d[:3, 3])), 2.0 * math.asin(min(1.0, chord))


def _parts(joint: pin.JointModel, entries: NDArray[np.int64]) -> Iterator[tuple[list[NDArray[np.int64]], list[int]]]:
    """Which of a joint's entries have length 1 together, and which are angles and lengths with limits."""
    kind = joint.shortname().removeprefix("JointModel")
    if kind == "Composite":
        for part in joint.extract().joints:
            yield from _parts(part, entries[: part.nq])
            entries = entries[part.nq :]
    elif kind in ("Spherical", "FreeFlyer"):
        yield [entries[-4:]], entries[:-4].tolist()
    elif kind == "Planar" or (joint.nq == 2 and joint.nv == 1):
        yield [entries[-2:]], entries[:-2].tolist()
    else:
        yield [], entries.tolist()
