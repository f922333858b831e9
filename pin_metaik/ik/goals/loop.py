"""The goal of a closed kinematic loop: two points or frames of the robot coincide."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, field
from typing import TypeAlias

import numpy as np
import pinocchio as pin

from pin_metaik.arguments import checked, checked_as, instance, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import FixedFrame, InvalidTarget
from pin_metaik.ik.goals.placed import Placed, relative
from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, Target
from pin_metaik.ik.goals.posed import Posed
from pin_metaik.kinematics import Chain

Closure: TypeAlias = (
    pin.RigidConstraintModel | pin.PointAnchorConstraintModel | pin.FrameAnchorConstraintModel | pin.ConstraintModel
)


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Loop(Posed):
    """A kinematic loop is closed: two points, or two frames, of the robot coincide.

    Pinocchio's models are trees: a loop of a mechanism is cut, and its two ends are kept together by a constraint. As a
    goal, both ends of the constraint are at the same point (``CONTACT_3D``, ``PointAnchorConstraintModel``, apart from
    its desired offset) or in the same pose (``CONTACT_6D``, ``FrameAnchorConstraintModel``). The chain must move the
    joints on both sides: make it for the frames that ``ends`` returns.

    Attributes:
        closure: Pinocchio's constraint, e.g. one of ``robot.loops``.
        position_tolerance: m.
        orientation_tolerance: rad; not used for points.

    Raises:
        InvalidTarget: If the constraint closes no loop (for instance the friction of a joint), if it has a desired
            offset that is not of a point (Pinocchio ignores it), or if a tolerance is not above zero.
    """

    closure: Closure
    _: KW_ONLY
    position_tolerance: float = DEFAULT_TOLERANCE
    orientation_tolerance: float = DEFAULT_TOLERANCE
    _ends: tuple[tuple[int, pin.SE3], tuple[int, pin.SE3]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        closure = self.closure.extract() if isinstance(self.closure, pin.ConstraintModel) else self.closure
        desired, oriented = _desired(closure)
        turn = self.orientation_tolerance if oriented else math.inf
        ends = (
            (int(closure.joint1_id), closure.joint1_placement.copy()),
            (int(closure.joint2_id), closure.joint2_placement.copy()),
        )
        target = Target(desired, position_tolerance=self.position_tolerance, orientation_tolerance=turn)
        for name, value in (("closure", closure), ("_ends", ends), ("_target", target)):
            object.__setattr__(self, name, value)

    @property
    def about(self) -> str:
        """The two joints whose links are to be joined, for messages."""
        (first, _), (second, _) = self._ends
        return self.closure.name or f"joints {first} and {second}"

    @checked
    def ends(self, model: pin.Model) -> tuple[str, ...]:
        """Frames of the links to be joined, as far as joints move them: a chain for these frames moves the whole loop.

        Raises:
            InvalidTarget: If the constraint is of another model.
        """
        joints = [joint for joint, _ in self._ends if joint]
        self._check_joints(model)
        links = [_link_of(model, joint) for joint in joints]
        return tuple(dict.fromkeys(links))

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            InvalidTarget: If the constraint is of another model.
            FixedFrame: If the chain moves neither end relative to the other.
        """
        self._check_joints(chain.model)
        first, second = (
            chain.movers.intersection(int(j) for j in chain.model.supports[joint]) for joint, _ in self._ends
        )
        if first == second:
            wanted = ", ".join(map(repr, self.ends(chain.model)))
            raise FixedFrame(f"no joint of {chain} moves the ends of this loop: make it for the frames {wanted}, too")

    def _check_joints(self, model: pin.Model) -> None:
        """Raise InvalidTarget unless the model has the joints of both ends."""
        last = max(joint for joint, _ in self._ends)
        if last >= model.njoints:
            raise InvalidTarget(
                f"this loop is of another model: it ends at joint {last}, and {model.name!r} has {model.njoints}"
            )

    def _placement(self, at: Placed) -> pin.SE3:
        instance(Placed, at=at)
        first, second = (at._on_joint(*end) for end in self._ends)
        return first.actInv(second)

    def _speeds(self, at: Placed) -> Array:
        first, second = ((at._on_joint(*end), at._jacobian_on_joint(*end)) for end in self._ends)
        return relative(*second, *first)


def _desired(closure: Closure) -> tuple[pin.SE3, bool]:
    """The pose that the second end shall have in the first one, and whether its orientation counts."""
    match closure:
        case pin.PointAnchorConstraintModel():
            return pin.SE3(np.eye(3), closure.desired_constraint_offset), False
        case pin.RigidConstraintModel():
            heeded = closure.desired_contact_placement.isIdentity()
            desired, oriented = "desired_contact_placement", closure.type == pin.ContactType.CONTACT_6D
        case pin.FrameAnchorConstraintModel():
            heeded = not closure.desired_constraint_offset.any()
            desired, oriented = "desired_constraint_offset", True
        case _:
            raise InvalidTarget(
                "a loop is closed by a RigidConstraintModel, a PointAnchorConstraintModel or a "
                f"FrameAnchorConstraintModel, got {shown(closure)}"
            )
    if not heeded:
        raise InvalidTarget(f"Pinocchio ignores {desired} of this constraint: make it part of joint2_placement")
    return pin.SE3.Identity(), oriented


def _link_of(model: pin.Model, joint: int) -> str:
    """The name of a link that a joint carries, or of any other frame on it."""
    frames = [frame for frame in model.frames if frame.parentJoint == joint]
    links = [frame.name for frame in frames if frame.type == pin.FrameType.BODY]
    names = links or [frame.name for frame in frames]
    if not names:
        raise InvalidTarget(f"joint {model.names[joint]!r} of {model.name!r} carries no frame that a chain could place")
    return str(names[0])
