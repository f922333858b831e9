"""The goal of joints that keep away from their limits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked, checked_as, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import Bounded
from pin_metaik.ik.goals.placed import KEPT, Placed
from pin_metaik.kinematics import Chain


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class MidRange(Bounded):
    """All joints in the middle part of their ranges: y = (x - middle) / half, between minus and plus ``share``.

    ``MidRange(0.9)`` keeps every joint off its limits by a tenth of half its range; ``MidRange(0)``, as a wish, centres
    the joints. Joints without limits, and those that cannot move, are ignored.

    Attributes:
        share: Share of each range, from 0, its middle, to 1.

    Raises:
        InvalidTarget: If the share is not between 0 and 1.
    """

    share: float
    unit: ClassVar[str] = "of half the range"

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        if not 0.0 <= self.share <= 1.0:
            raise InvalidTarget(f"share is from 0 to 1, got {shown(self.share)}")

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            InvalidTarget: If none of its joints has two limits and a range between them.
        """
        if not len(_ranges(chain)[0]):
            raise InvalidTarget(f"no joint of {chain} has two finite limits, and so a middle")

    def _values(self, at: Placed) -> Array:
        columns, middle, half = _ranges(at.chain)
        places: Array = (at.x[columns] - middle) / half
        return places

    def _slopes(self, at: Placed) -> Array:
        columns, _, half = _ranges(at.chain)
        slopes: Array = np.eye(at.chain.n)[columns] / half[:, None]
        return slopes

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return -self.share, self.share


@lru_cache(KEPT)
def _ranges(chain: Chain) -> tuple[NDArray[np.int64], Array, Array]:
    """Columns (m,) of the coordinates with two limits and a range between them; its middle and half of it (m,)."""
    lower, upper = chain.limits.lower, chain.limits.upper
    columns = np.flatnonzero(np.isfinite(lower) & np.isfinite(upper) & (upper > lower))
    lower, upper = lower[columns], upper[columns]
    return columns, 0.5 * (lower + upper), 0.5 * (upper - lower)
