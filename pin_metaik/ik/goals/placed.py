"""The robot at one configuration, as given to goals."""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TypeVar

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.arguments import instance
from pin_metaik.arrays import Array
from pin_metaik.errors import FixedFrame
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.coordinates import consecutive
from pin_metaik.kinematics.model import as_configuration, frame_id

STEP = 1e-6  # rad or m, of the central differences that stand in for a derivative
KEPT = 64  # of the last chains: ids of frames, columns and ranges

Found = TypeVar("Found")


class Placed:
    """The robot at one configuration, as given to goals; computed by Pinocchio on demand.

    Attributes:
        chain: The chain whose coordinates are searched.
        q: (nq,) the configuration.
    """

    def __init__(self, chain: Chain, q: Array) -> None:
        """Place a chain's robot at q (nq,).

        Raises:
            InvalidConfiguration: If q is not a configuration of the chain's model.
        """
        instance(Chain, chain=chain)
        self.chain, self.q = chain, as_configuration(chain.model, q)
        self._poses: dict[tuple[str, str | None], pin.SE3] = {}
        self._jacobians: dict[tuple[str, str | None], Array] = {}

    @cached_property
    def x(self) -> Array:
        """(n,) the chain's coordinates."""
        return self.chain.x(self.q)

    def pose(self, frame: str, reference: str | None = None) -> pin.SE3:
        """Pose of a frame of the model in the world, or in another frame.

        Raises:
            FrameNotFound: If the model has no such frame.
        """
        if (known := _known(self._poses, frame, reference)) is not None:
            return known
        if reference is None:
            model, data, number = self.chain.model, self.chain.data, _frame_id(self.chain, frame)
            pin.forwardKinematics(model, data, self.q)
            pose = pin.SE3(pin.updateFramePlacement(model, data, number))
        else:
            pose = self.pose(reference).actInv(self.pose(frame))
        self._poses[frame, reference] = pose
        return pose

    def jacobian(self, frame: str, reference: str | None = None) -> Array:
        """Jacobian (6, n) of a frame by the chain's coordinates: of its origin (m), then of its orientation (rad).

        In the axes of the world or, with a reference, relative to that frame and in its axes. The column of a
        coordinate includes the motion of its mimic joints.

        Raises:
            FrameNotFound: If the model has no such frame.
        """
        if (known := _known(self._jacobians, frame, reference)) is not None:
            return known
        if reference is None:
            model, data, number = self.chain.model, self.chain.data, _frame_id(self.chain, frame)
            whole: Array = pin.computeFrameJacobian(model, data, self.q, number, pin.LOCAL_WORLD_ALIGNED)
            J = self._by_coordinates(whole)
        else:
            J = self._relative(frame, reference)
        self._jacobians[frame, reference] = J
        return J

    def _relative(self, frame: str, reference: str) -> Array:
        """The same of a frame as another one sees it."""
        return relative(self.pose(frame), self.jacobian(frame), self.pose(reference), self.jacobian(reference))

    def _on_joint(self, joint: int, placement: pin.SE3) -> pin.SE3:
        """World pose of a frame that is fixed to a joint, by its number, at a placement in the joint's frame."""
        return self._joint_poses[joint] * placement

    def _jacobian_on_joint(self, joint: int, placement: pin.SE3) -> Array:
        """Velocity (6, n) of the same by the coordinates of the chain, along the axes of the world."""
        if joint == 0:  # the world
            return np.zeros((6, self.chain.n))
        J = self._by_coordinates(pin.computeJointJacobian(self.chain.model, self.chain.data, self.q, joint))
        R, local = self._on_joint(joint, placement).rotation, placement.toActionMatrixInverse() @ J
        return np.concatenate([R @ local[:3], R @ local[3:]])

    @cached_property
    def _joint_poses(self) -> pin.StdVec_SE3:
        pin.forwardKinematics(self.chain.model, self.chain.data, self.q)
        return pin.StdVec_SE3(self.chain.data.oMi)

    @cached_property
    def centre_of_mass(self) -> Array:
        """(3,) centre of mass of the whole robot in the world, m."""
        return np.array(pin.centerOfMass(self.chain.model, self.chain.data, self.q))

    @cached_property
    def centre_of_mass_jacobian(self) -> Array:
        """(3, n) derivative of the centre of mass by the coordinates of the chain."""
        return self._by_coordinates(pin.jacobianCenterOfMass(self.chain.model, self.chain.data, self.q))

    def _by_coordinates(self, J: Array) -> Array:
        """A Jacobian (..., n) by the coordinates from one (..., nv) by Pinocchio's velocities."""
        columns = _columns(self.chain)
        picked: Array = J @ self._tangent if columns is None else J[:, columns]
        return picked

    @cached_property
    def _tangent(self) -> Array:
        return self.chain.tangent(self.x)

    @cached_property
    def around(self) -> tuple[tuple[Placed, Placed], ...]:
        """The robot one step forwards and one step back in each of the n coordinates, for central differences."""
        steps = STEP * np.eye(self.chain.n)
        return tuple((self._moved(h), self._moved(-h)) for h in steps)

    def _moved(self, h: Array) -> Placed:
        return Placed(self.chain, self.chain.q(self.x + h, self.q))


def relative(pose: pin.SE3, J: Array, base: pin.SE3, Jb: Array) -> Array:
    """Velocity (6, n) of a frame as another one sees it, from those of both along the axes of the world.

    v = R'(v_f - v_b - w_b x (p_f - p_b)) and w = R'(w_f - w_b), with R the rotation of the base.
    """
    arm, turn = pin.skew(pose.translation - base.translation), base.rotation.T
    return np.concatenate([turn @ (J[:3] - Jb[:3] + arm @ Jb[3:]), turn @ (J[3:] - Jb[3:])])


def _known(found: dict[tuple[str, str | None], Found], frame: str, reference: str | None) -> Found | None:
    """What was found for two frames before; None: nothing yet, for names that were looked at."""
    try:
        return found[frame, reference]
    except (KeyError, TypeError):
        instance(str, frame=frame)
        instance((str, type(None)), reference=reference)
        return None


def check_moved(chain: Chain, frame: str, reference: str | None = None) -> None:
    """Raise FixedFrame unless the chain moves a frame, in the world or relative to another frame; see ``Chain``."""
    ways = _movers(chain, frame)
    if not ways:
        raise FixedFrame(f"no joint of {chain} moves frame {frame!r}")
    if reference is not None and ways == _movers(chain, reference):
        raise FixedFrame(f"no joint of {chain} moves frame {frame!r} relative to {reference!r}")


def _movers(chain: Chain, frame: str) -> frozenset[int]:
    """The joints by which a chain moves a frame."""
    model = chain.model
    supports = model.supports[model.frames[_frame_id(chain, frame)].parentJoint]
    return chain.movers.intersection(int(j) for j in supports)


@lru_cache(KEPT)
def _frame_id(chain: Chain, frame: str) -> int:
    """Number of a frame; to look for it takes longer than to place it."""
    return frame_id(chain.model, frame)


@lru_cache(KEPT)
def _columns(chain: Chain) -> slice | NDArray[np.int64] | None:
    """Entries (n,) of Pinocchio's velocities that are those of the coordinates; the followers of a joint are in it.

    None where a joint has several coordinates: there the two differ.
    """
    joints = [chain.model.joints[int(j)] for j in chain.coordinates.joints]
    if any(joint.nv > 1 for joint in joints):
        return None
    return consecutive(np.array([joint.idx_v for joint in joints], dtype=np.int64))
