"""Where a path does not go on, and why."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from pin_metaik.collision import Contact, Move
from pin_metaik.ik.proof import Proof
from pin_metaik.plain import fields_of, plain


class BreakReason(StrEnum):
    """Why a pose is not met, or not reached from the pose before it."""

    NO_SOLUTION = "NO_SOLUTION"
    """No solution of the pose was found; where ``PathBreak.proof`` says so, there is none."""
    IN_COLLISION = "IN_COLLISION"
    """The solutions of the pose that were found are in collision."""
    STEP = "STEP"
    """A joint would have to step farther than the bound."""
    MOVE = "MOVE"
    """The move from the pose before is not proved free of collisions."""
    INTERRUPTED = "INTERRUPTED"
    """The pose was not looked at, as a watch ended the path."""


@dataclass(frozen=True)
class Reconfiguration:
    """A change of branch along a path.

    Attributes:
        index: Number of the pose that is met on another branch than the one before it.
        before: The branch of the pose before, as ``IKSolutions.labels`` has it.
        after: The branch from there on.
    """

    index: int
    before: str
    after: str

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return fields_of(self, "index", "before", "after")

    def __str__(self) -> str:
        return f"to pose {self.index}: {self.before} becomes {self.after}"


@dataclass(frozen=True, eq=False)
class PathBreak:
    """A pose of a path that is not met, or not reached from the one before it.

    Attributes:
        index: Number of the pose.
        reason: Why.
        proof: What proves that the pose has no solution; None where nothing does.
        contact: The bodies that collide at the pose, or first on the move to it.
        joint: Name of the joint whose step exceeds its bound the most.
        step: The step of that joint, rad or m; 0 without one.
        move: The move from the pose before it, and where on it something collides.
    """

    index: int
    reason: BreakReason
    proof: Proof | None = None
    contact: Contact | None = None
    joint: str = ""
    step: float = 0.0
    move: Move | None = None

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: lengths in m, angles in rad."""
        names = ("index", "reason", "proof", "contact", "joint", "step")
        return {**fields_of(self, *names), "move": None if self.move is None else plain(self.move.as_dict())}

    def __str__(self) -> str:
        match self.reason:
            case BreakReason.NO_SOLUTION:
                return f"pose {self.index}: no solution{'' if self.proof is None else f', proved ({self.proof})'}"
            case BreakReason.IN_COLLISION:
                return f"pose {self.index}: only in collision, {self.contact}"
            case BreakReason.STEP:
                return f"to pose {self.index}: {self.joint} would step {self.step:.3g} rad or m"
            case BreakReason.MOVE:
                return f"to pose {self.index}: the move {self.move}"
            case BreakReason.INTERRUPTED:
                return f"pose {self.index}: not looked at, the path was interrupted"
