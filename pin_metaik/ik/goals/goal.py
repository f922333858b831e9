"""What a goal is, what it reads of the robot, and several goals as one residual."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import pinocchio as pin

from pin_metaik.arguments import shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.model import frame_id

STEP = 1e-6  # rad or m, of the central differences that stand in for a derivative


class Placed:
    """The robot at one configuration: what a goal looks at.

    Attributes:
        chain: The chain whose coordinates are searched.
        q: (nq,) the configuration.
    """

    def __init__(self, chain: Chain, q: Array) -> None:
        """Place a chain's robot at q (nq,)."""
        self.chain, self.q = chain, q
        self._poses: dict[str, pin.SE3] = {}

    @cached_property
    def x(self) -> Array:
        """(n,) the chain's coordinates."""
        return self.chain.x(self.q)

    def pose(self, frame: str) -> pin.SE3:
        """World pose of a frame of the model, by Pinocchio.

        Raises:
            FrameNotFound: If the model has no such frame.
        """
        if frame not in self._poses:
            model, data = self.chain.model, self.chain.data
            number = frame_id(model, frame)
            pin.forwardKinematics(model, data, self.q)
            self._poses[frame] = pin.SE3(pin.updateFramePlacement(model, data, number))
        return self._poses[frame]


@runtime_checkable
class Goal(Protocol):
    """A set that the robot shall be in, by a residual to descend and a test that counts.

    A goal may have a method ``jacobian(at)`` that gives the derivative (m, n) of its residual by the coordinates of
    ``at.chain``; without one, central differences stand in for it. ``Target`` is the goal that compiled loops evaluate;
    any other takes ten to a hundred times as long, and makes Levenberg-Marquardt steps of those of ``DLS``.
    """

    def residual(self, at: Placed) -> Array:
        """Weighted distance r (m,) to the set, the same m everywhere, in m and rad; zero inside."""
        ...

    def met(self, at: Placed) -> bool:
        """Whether the robot is in the set, to within the goal's tolerance."""
        ...


class Goals(NamedTuple):
    """Several goals as one residual r (m,), the rows of each after those of the one before.

    Attributes:
        each: The goals.
        sizes: How many rows each of them has.
    """

    each: tuple[Goal, ...] = ()
    sizes: tuple[int, ...] = ()

    @staticmethod
    def of(chain: Chain, goals: Sequence[Goal]) -> Goals:
        """Ask each of the goals once, at the chain's reference.

        Raises:
            InvalidTarget: If a residual is not (m,) finite numbers.
        """
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
        """Whether the robot is in all of the sets."""
        return all(goal.met(at) for goal in self.each)

    def residual(self, at: Placed) -> Array:
        """Residual r (m,).

        Raises:
            InvalidTarget: If that of a goal is not (m,) finite numbers, with the m that it had before.
        """
        return np.concatenate([_residual(goal, at, m) for goal, m in zip(self.each, self.sizes, strict=True)])

    def cost(self, at: Placed) -> float:
        """Sum of the norms of the residuals, m and rad alike."""
        parts = zip(self.each, self.sizes, strict=True)
        return float(sum(np.linalg.norm(_residual(goal, at, m)) for goal, m in parts))

    def jacobian(self, at: Placed) -> Array:
        """Derivative (m, n) of the residual by the coordinates of the chain.

        Raises:
            InvalidTarget: If that of a goal is not (m, n) finite numbers.
        """
        n = at.chain.n
        steps = [(Placed(at.chain, _moved(at, h)), Placed(at.chain, _moved(at, -h))) for h in STEP * np.eye(n)]
        J = np.empty((self.rows, n))
        row = 0
        for goal, m in zip(self.each, self.sizes, strict=True):
            own = getattr(goal, "jacobian", None)
            if own is None:
                slopes = [
                    (_residual(goal, there, m) - _residual(goal, back, m)) / (2.0 * STEP) for there, back in steps
                ]
                J[row : row + m] = np.reshape(slopes, (n, m)).T
            else:
                J[row : row + m] = _numbers(f"the jacobian of {goal!r}", own(at), (m, n))
            row += m
        return J


def _moved(at: Placed, h: Array) -> Array:
    return at.chain.q(at.x + h, at.q)


def _residual(goal: Goal, at: Placed, size: int | None) -> Array:
    """The residual (m,) of a goal, of somebody's own perhaps, looked at."""
    return _numbers(f"the residual of {goal!r}", goal.residual(at), None if size is None else (size,))


def _numbers(what: str, given: object, shape: tuple[int, ...] | None) -> Array:
    """What a goal gives, as an array of this shape, or (m,)."""
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError, OverflowError):
        numbers = np.full((1, 1, 1), np.nan)
    fits = numbers.ndim == 1 if shape is None else numbers.shape == shape
    if not fits or not np.isfinite(numbers).all():
        wanted = "(m,)" if shape is None else str(shape)
        raise InvalidTarget(f"{what} must be {wanted} finite numbers, got {shown(given)}")
    return numbers
