"""The goal of a pose for any frame of the robot, in the world or relative to another frame."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass

import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arguments import checked, checked_as, instance
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.placed import Placed, check_moved
from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, Target, Tolerance
from pin_metaik.ik.goals.posed import Posed
from pin_metaik.kinematics import Chain


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class FramePose(Posed):
    """A pose, position or orientation for any frame that the chain moves, with tolerances as those of ``Target``.

    With a ``reference`` it is the pose relative to that frame: two hands on one tray, a camera over the gripper. For a
    frame of the chain and a pose in the world use ``Target``, which is evaluated by compiled code.

    Attributes:
        frame: Any frame that the chain moves, not only one of ``chain.frames``.
        pose: The pose it shall have: ``pin.SE3`` or (4, 4).
        reference: Another frame of the robot, relative to which the pose is given; ``None``: the world.
        position_tolerance: m; see ``Target``; ``inf`` frees the position.
        orientation_tolerance: rad; ``inf`` frees the orientation.
        position_weight: Weight of a metre of error in the cost of the search.
        orientation_weight: Weight of a radian of error in the cost of the search.

    Raises:
        InvalidTarget: As ``Target`` does.
    """

    frame: str
    pose: pin.SE3 | ArrayLike
    _: KW_ONLY
    reference: str | None = None
    position_tolerance: Tolerance = DEFAULT_TOLERANCE
    orientation_tolerance: Tolerance = DEFAULT_TOLERANCE
    position_weight: float = 1.0
    orientation_weight: float = 1.0

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        given = self.position_tolerance, self.orientation_tolerance, self.position_weight, self.orientation_weight
        object.__setattr__(self, "_target", Target(self.pose, self.frame, *given))
        object.__setattr__(self, "pose", self._target.pose)

    @staticmethod
    def at(
        frame: str, xyz: ArrayLike, *, reference: str | None = None, tolerance: Tolerance = DEFAULT_TOLERANCE
    ) -> FramePose:
        """A position (3,) in m, at any orientation."""
        pose = Target.at(xyz).pose
        return FramePose(frame, pose, reference=reference, position_tolerance=tolerance, orientation_tolerance=math.inf)

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            FrameNotFound: If the model has no such frame.
            FixedFrame: If the chain does not move the frame, in the world or relative to the reference.
        """
        check_moved(chain, self.frame, self.reference)

    def _placement(self, at: Placed) -> pin.SE3:
        instance(Placed, at=at)
        return at.pose(self.frame, self.reference)

    def _speeds(self, at: Placed) -> Array:
        return at.jacobian(self.frame, self.reference)
