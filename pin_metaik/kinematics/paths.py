"""A model's joints as the flat arrays that the compiled loops walk along."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.kinematics.joints import Motion
from pin_metaik.kinematics.kernel.layout import Arm

UP = np.array([0.0, 0.0, 1.0])
HALF_ABOUT_X = np.array([1.0, -1.0, -1.0])  # multiplied into the columns
RIGID = 1e-12  # of R'R, by how much a rotation of double precision may miss the identity


@dataclass(frozen=True, eq=False)
class ChainArrays:
    """The way from the world to each of T tips, over S joints, in n coordinates; see ``kernel.layout``."""

    joints: NDArray[np.float64]  # (S, 14)
    wiring: NDArray[np.int64]  # (S, 2)
    ends: NDArray[np.int64]  # (T + 1,)
    tips: NDArray[np.float64]  # (T, 12)

    @property
    def arrays(self) -> Arm:
        """The four arrays as the compiled loops take them."""
        return Arm(self.joints, self.wiring, self.ends, self.tips)


def turned_to_z(axis: NDArray[np.float64]) -> pin.SE3:
    """A rotation whose z axis is ``axis`` (3,), exact but for rounding.

    It is the shortest turn from z, or, for an axis that points down, from -z after half a turn about x: a turn by more
    than a right angle, made from the two vectors, would lose digits, near -z half of them.
    """
    down = bool(axis[2] < 0.0)
    turn = pin.Quaternion.FromTwoVectors(UP, -axis if down else axis).matrix()
    return pin.SE3(turn * HALF_ABOUT_X if down else turn, np.zeros(3))


def flat(placement: pin.SE3) -> NDArray[np.float64]:
    """A placement as (12,): rotation row by row, then translation."""
    return np.concatenate([placement.rotation.ravel(), placement.translation])


def matrix_of(flat: NDArray[np.float64]) -> NDArray[np.float64]:
    """The (4, 4) matrix of a placement (12,)."""
    matrix = np.eye(4)
    matrix[:3, :3] = flat[:9].reshape(3, 3)
    matrix[:3, 3] = flat[9:12]
    return matrix


def base_moves(before: ChainArrays, after: ChainArrays) -> NDArray[np.float64] | None:
    """How each tip's path is moved as a whole, (T, 4, 4), if the two differ in nothing but where the paths begin.

    None if they differ in more, or if a move is not quite a rotation.
    """
    first = before.ends[:-1]
    rest = np.delete(before.joints, first, axis=0), np.delete(after.joints, first, axis=0)
    if not (np.array_equal(*rest) and np.array_equal(before.tips, after.tips)):
        return None
    ways = zip(before.joints[first], after.joints[first], strict=True)
    moves = np.array([matrix_of(there) @ np.linalg.inv(matrix_of(here)) for here, there in ways])
    turns = moves[:, :3, :3]
    return moves if np.abs(turns.transpose(0, 2, 1) @ turns - np.eye(3)).max() < RIGID else None


def chain_arrays(
    model: pin.Model,
    data: pin.Data,
    frames: Sequence[int],
    columns: dict[int, int],
    motions: dict[int, tuple[Motion, ...]],
    reference: NDArray[np.float64],
) -> ChainArrays:
    """Walk from the world to each frame; joints without a column are folded in where ``reference`` (nq,) has them."""
    pin.forwardKinematics(model, data, reference)
    joints, wiring, ends, tips = [], [], [0], []
    for frame in frames:
        placement = pin.SE3.Identity()
        for joint in list(model.supports[model.frames[frame].parentJoint])[1:]:
            if joint not in motions:
                placement = placement * data.liMi[joint]
                continue
            placement = placement * model.jointPlacements[joint]
            for motion in motions[joint]:
                turn = turned_to_z(motion.axis)
                joints.append(np.append(flat(placement * motion.before * turn), [motion.scale, motion.shift]))
                wiring.append((columns[motion.driver] + motion.part, int(motion.rotates)))
                placement = turn.inverse()
        ends.append(len(joints))
        tips.append(flat(placement * model.frames[frame].placement))
    return ChainArrays(
        np.array(joints), np.array(wiring, dtype=np.int64), np.array(ends, dtype=np.int64), np.array(tips)
    )
