"""A model's joints as the flat arrays that the compiled loops walk along."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import UnsupportedJoint
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


@dataclass(frozen=True)
class Motion:
    """How a joint, or a part of its motion, follows a coordinate: along or about ``axis`` by ``scale x + shift``.

    Attributes:
        driver: Id of the joint whose coordinate is followed: the joint itself, or the one it mimics.
        axis: (3,) unit vector in the joint frame.
        rotates: About the axis, else along it.
    """

    driver: int
    axis: NDArray[np.float64]
    rotates: bool
    scale: float
    shift: float


def leader_of(model: pin.Model, joint: int) -> int:
    """Id of the joint that a joint mimics, or its own."""
    kind = model.joints[joint]
    if kind.nq:
        return joint
    # A mimic joint is a scaled copy of the coordinate at the same index.
    return next(j for j in range(1, model.njoints) if model.joints[j].nv and model.joints[j].idx_v == kind.idx_v)


def motions_of(model: pin.Model, joint: int) -> tuple[Motion, ...]:
    """The turns and slides that a joint with one degree of freedom is made of, read from its motion subspace S.

    A revolute joint is a turn, a prismatic one a slide, a helical one both along one axis.

    Raises:
        UnsupportedJoint: If it has more than one degree of freedom, or its slide is not along the axis of its turn.
    """
    kind = model.joints[joint]
    driver, scale, shift = leader_of(model, joint), 1.0, 0.0
    if driver != joint:
        mimic = kind.extract()
        scale, shift = float(mimic.scaling), float(mimic.offset)
    elif kind.nv != 1:
        raise UnsupportedJoint(
            f"joint {model.names[joint]!r} on the path has {kind.nv} degrees of freedom; chains move joints with one: "
            f"hold it where the reference has it: Chain(..., locked=[{model.names[joint]!r}]) "
            f"or --lock {model.names[joint]}"
        )
    subspace = _constant_subspace(model, joint)
    linear, angular = subspace[:3], subspace[3:]
    slide, turn = float(np.linalg.norm(linear)), float(np.linalg.norm(angular))
    # Pinocchio's S of a mimic joint carries the scale, which is kept apart here.
    unit = (turn or slide) * np.sign(scale)
    axis = (angular if turn else linear) / unit
    if not turn or not slide:
        return (Motion(driver, axis, turn > 0.0, scale, shift),)
    pitch = float(linear @ axis) / unit  # m/rad
    if np.linalg.norm(linear / unit - pitch * axis) > RIGID:
        raise UnsupportedJoint(
            f"joint {model.names[joint]!r} ({kind.shortname()}) slides across the axis that it turns about"
        )
    return Motion(driver, axis, True, scale, shift), Motion(driver, axis, False, pitch * scale, pitch * shift)


def _constant_subspace(model: pin.Model, joint: int) -> NDArray[np.float64]:
    """S of a joint, after checking that the joint really moves by exp(S x) and so can be a chain's."""
    data = model.createData()
    q = pin.neutral(model)
    pin.forwardKinematics(model, data, q)
    subspace: NDArray[np.float64] = np.array(data.joints[joint].S).reshape(6)
    start = data.joints[joint].M.copy()
    step = np.zeros(model.nv)
    step[model.joints[joint].idx_v] = 0.3
    pin.forwardKinematics(model, data, pin.integrate(model, q, step))
    if not data.joints[joint].M.isApprox(start * pin.exp6(pin.Motion(0.3 * subspace)), 1e-9):
        raise UnsupportedJoint(f"joint {model.names[joint]!r} does not move along one fixed axis")
    return subspace


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
                joints.append(np.append(flat(placement * turn), [motion.scale, motion.shift]))
                wiring.append((columns[motion.driver], int(motion.rotates)))
                placement = turn.inverse()
        ends.append(len(joints))
        tips.append(flat(placement * model.frames[frame].placement))
    return ChainArrays(
        np.array(joints), np.array(wiring, dtype=np.int64), np.array(ends, dtype=np.int64), np.array(tips)
    )
