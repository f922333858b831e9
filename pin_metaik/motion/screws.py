"""What the joints of a robot do, at most, while the coordinates of a chain change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.screws import Screws
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.joints import Motion, leader_of, parts_of

FAR = 1e6  # m; as far slides what has no limits


class ChainScrews:
    """Turns and slides of all joints of a model, by how much each coordinate of a chain changes, whichever way.

    A joint with one axis turns about that and slides along it. One with several is taken to turn about its frame by the
    sum of its turns, and to slide by the sum of its slides; where others of its own motions come after a turn, the
    frame is carried round by that turn as well.
    """

    def __init__(self, chain: Chain, screws: Screws) -> None:
        model, columns = chain.model, chain.coordinates.columns
        self._rows = np.zeros((model.njoints, 8))
        self._rows[:, :6] = np.nan_to_num(screws.axes, nan=0.0)
        one_axis = [bool(np.isfinite(axis).all()) for axis in screws.axes]
        self._turns, self._slides = np.zeros((2, model.njoints, chain.n))
        for joint in range(1, model.njoints):
            if (leader := leader_of(model, joint)) not in columns:
                continue
            beyond = 0.0  # m from a motion's axis to the joint's frame, at most
            for motion in reversed(parts_of(model, joint).motions):
                column, scale = columns[leader] + motion.part, abs(motion.scale)
                if not motion.rotates:
                    self._slides[joint, column] += scale
                else:
                    self._turns[joint, column] += scale
                    self._slides[joint, column] += 0.0 if one_axis[joint] else scale * beyond
                beyond += _farthest(motion, chain.limits.lower[column], chain.limits.upper[column])
                beyond += float(np.linalg.norm(motion.before.translation))

    def along(self, way: NDArray[np.float64]) -> NDArray[np.float64]:
        """(J, 8) what each joint does while coordinates change by way (n,), as ``Screws.along`` has it."""
        rows = self._rows.copy()
        rows[:, 6] = self._turns @ way
        rows[:, 7] = self._slides @ way
        return rows


def _farthest(motion: Motion, lower: float, upper: float) -> float:
    """The farthest that a motion slides while what it follows is inside limits, m; 0 of one that turns."""
    return 0.0 if motion.rotates else min(max(abs(motion.scale * end + motion.shift) for end in (lower, upper)), FAR)
