"""How much a search may spend, counted in function evaluations."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pin_metaik.arguments import shown
from pin_metaik.errors import InvalidBudget


@dataclass(frozen=True)
class Budget:
    """When to stop: whichever of the limits is met first.

    Attributes:
        evaluations: Function evaluations (one per point, not per generation). Spent exactly, never overspent.
        seconds: Wall-clock time in s, checked between generations. How far a search gets depends on the machine and its
            load, so results are not reproducible.
        target: A sufficient cost: the search ends with the first generation that reaches it.

    Raises:
        InvalidBudget: A limit that is not a positive number, or a target that is not a number.
    """

    evaluations: int | None = None
    seconds: float | None = None
    target: float | None = None

    def __post_init__(self) -> None:
        whole = hasattr(self.evaluations, "__index__") and not isinstance(self.evaluations, (bool, np.ndarray))
        if self.evaluations is not None and not (whole and self.evaluations > 0):
            raise InvalidBudget(f"evaluations must be a whole number above 0, not {self.evaluations!r}")
        if self.seconds is not None and not (_is_number(self.seconds) and self.seconds > 0):
            raise InvalidBudget(f"seconds must be a number above 0, not {self.seconds!r}")
        if self.target is not None and not _is_number(self.target):
            raise InvalidBudget(f"target must be a cost, not {shown(self.target)}")

    @property
    def ends(self) -> bool:
        """Whether it ends every search. A target alone does not, as it may never be reached."""
        return self.evaluations is not None or self.seconds is not None


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= math.inf
