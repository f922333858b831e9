"""The protocol of a goal, and several goals as one residual."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np

from pin_metaik.arguments import shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.placed import STEP, Placed
from pin_metaik.kinematics import Chain


@runtime_checkable
class Goal(Protocol):
    """A condition on the robot: a residual that searches minimise, and the test whether it is met.

    A goal may have further methods: ``jacobian(at)``, the derivative (m, n) of its residual by the coordinates of
    ``at.chain`` (default: central differences); ``off(at)``, by how much the goal is missed, by unit, for messages
    (default: the norm of the residual); and ``check(chain)``, which raises an error if the goal makes no sense for the
    chain. Only ``Target`` is evaluated by compiled code; any other goal takes ten to a hundred times as long.
    """

    def residual(self, at: Placed) -> Array:
        """Weighted residual r (m,), in m and rad, zero where the goal is met exactly; m is the same everywhere."""
        ...

    def met(self, at: Placed) -> bool:
        """Whether the goal is met to within its tolerance."""
        ...


class Outcome(NamedTuple):
    """The outcome of a goal at a configuration.

    Attributes:
        goal: The goal.
        met: Whether it is met to within its tolerance.
        off: By how much it is missed, by unit: ``{"m": 0.02, "rad": 0.1}``; the tolerance is not subtracted.
    """

    goal: Goal
    met: bool
    off: dict[str, float]

    @staticmethod
    def of(goal: Goal, at: Placed) -> Outcome:
        """Evaluate a goal at a configuration of the robot."""
        own = getattr(goal, "off", None)
        off = {"": float(np.linalg.norm(_residual(goal, at, None)))} if own is None else own(at)
        return Outcome(goal, goal.met(at), off)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return {"goal": named(self.goal), "met": self.met, "off": self.off}

    def __str__(self) -> str:
        away = " and ".join(f"{size:.3g} {unit}".strip() for unit, size in self.off.items())
        return f"{named(self.goal)} by {away}"


def named(goal: Goal) -> str:
    """A goal for a message: its kind, and the frame, or whatever else, that it is about."""
    about = getattr(goal, "frame", None) or getattr(goal, "about", None)
    return type(goal).__name__ + (f" of {about}" if isinstance(about, str) else "")


class Goals(NamedTuple):
    """Several goals as one residual r (m,), which stacks theirs.

    Attributes:
        each: The goals.
        sizes: How many rows each of them has.
    """

    each: tuple[Goal, ...] = ()
    sizes: tuple[int, ...] = ()

    @staticmethod
    def of(chain: Chain, goals: Sequence[Goal]) -> Goals:
        """Stack goals, after evaluating each once at the chain's reference.

        Raises:
            InvalidTarget: If a residual is not (m,) finite numbers.
            FrameNotFound: If a goal names a frame that the model does not have.
            FixedFrame: If a goal is about a frame that the chain does not move.
            UnknownName: If a goal names a joint that is not the chain's.
        """
        for goal in goals:
            check = getattr(goal, "check", None)
            if check is not None:
                check(chain)
        at = Placed(chain, chain.reference)
        return Goals(tuple(goals), tuple(len(_residual(goal, at, None)) for goal in goals))

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self.each)

    @property
    def rows(self) -> int:
        """Rows m of the residual."""
        return sum(self.sizes)

    def met(self, at: Placed) -> bool:
        """Whether all goals are met."""
        return all(goal.met(at) for goal in self.each)

    def residual(self, at: Placed) -> Array:
        """Residual r (m,).

        Raises:
            InvalidTarget: If the residual of a goal is not (m,) finite numbers, with the same m as before.
        """
        return np.concatenate([_residual(goal, at, m) for goal, m in zip(self.each, self.sizes, strict=True)])

    def cost(self, at: Placed) -> float:
        """Sum of the norms of the residuals, m and rad weighted alike."""
        parts = zip(self.each, self.sizes, strict=True)
        return float(sum(np.linalg.norm(_residual(goal, at, m)) for goal, m in parts))

    def jacobian(self, at: Placed) -> Array:
        """Derivative (m, n) of the residual by the coordinates of the chain.

        Raises:
            InvalidTarget: If the derivative of a goal is not (m, n) finite numbers.
        """
        return np.concatenate([_slopes(goal, at, m) for goal, m in zip(self.each, self.sizes, strict=True)])


def differences(goal: Goal, at: Placed, size: int) -> Array:
    """Derivative (m, n) of a goal's residual (m,) by central differences."""
    slopes = [_residual(goal, there, size) - _residual(goal, back, size) for there, back in at.around]
    return np.reshape(slopes, (len(slopes), size)).T / (2.0 * STEP)


def _slopes(goal: Goal, at: Placed, size: int) -> Array:
    """The derivative (m, n) of a goal's residual: its own, looked at, or by differences."""
    own = getattr(goal, "jacobian", None)
    if own is None:
        return differences(goal, at, size)
    return _numbers("the jacobian", goal, own(at), (size, at.chain.n))


def _residual(goal: Goal, at: Placed, size: int | None) -> Array:
    """The residual (m,) of a goal, of somebody's own perhaps, looked at."""
    return _numbers("the residual", goal, goal.residual(at), None if size is None else (size,))


def _numbers(what: str, goal: Goal, given: object, shape: tuple[int, ...] | None) -> Array:
    """What a goal gives, as an array of this shape, or (m,)."""
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError, OverflowError):
        numbers = np.full((1, 1, 1), np.nan)
    fits = numbers.ndim == 1 if shape is None else numbers.shape == shape
    if not fits or not np.isfinite(numbers).all():
        wanted = "(m,)" if shape is None else str(shape)
        raise InvalidTarget(f"{what} of {shown(goal)} must be {wanted} finite numbers, got {shown(given)}")
    return numbers
