"""A wish: a goal that is improved as far as the others leave freedom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pin_metaik.arguments import checked_as, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.goal import Goal, Goals
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.kinematics import Chain


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Wish:
    """A goal that need not be met: it is improved as far as the other goals leave freedom.

    ``mik.solve_ik(chain, [pose, Wish(MidRange(0))])``: the pose, and of its solutions one whose joints are near the
    middle of their ranges. ``result.wishes`` has its outcome.

    Attributes:
        goal: Any goal.
        weight: Weight of its residual relative to other wishes.

    Raises:
        InvalidTarget: If ``goal`` is not a goal, or the weight is not a finite number above 0.
    """

    goal: Goal
    weight: float = 1.0

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        if not number("weight", self.weight, InvalidTarget) > 0.0:
            raise InvalidTarget(f"weight is a finite number above 0, got {self.weight!r}")


class Wishes(NamedTuple):
    """Several wishes as one residual r (m,), to be made as small as the goals allow.

    Attributes:
        each: The wishes.
        goals: What they wish for.
    """

    each: tuple[Wish, ...] = ()
    goals: Goals = Goals()

    @staticmethod
    def of(chain: Chain, wishes: tuple[Wish, ...]) -> Wishes:
        """Ask each of the wishes once, as ``Goals.of`` does."""
        return Wishes(wishes, Goals.of(chain, [wish.goal for wish in wishes]))

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self.each)

    @property
    def _weights(self) -> Array:
        """What a unit counts (m,) in each row."""
        return np.repeat([wish.weight for wish in self.each], self.goals.sizes)

    def residual(self, at: Placed) -> Array:
        """Residual r (m,), weighted."""
        weighted: Array = self._weights * self.goals.residual(at)
        return weighted

    def jacobian(self, at: Placed) -> Array:
        """Derivative (m, n) of the residual by the coordinates of the chain."""
        weighted: Array = self._weights[:, None] * self.goals.jacobian(at)
        return weighted
