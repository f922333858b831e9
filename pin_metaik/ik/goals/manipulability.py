"""The goal of a least manipulability."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

import numpy as np

from pin_metaik.arguments import checked_as
from pin_metaik.arrays import Array
from pin_metaik.dexterity import manipulability
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import OfFrame
from pin_metaik.ik.goals.placed import Placed

Rows: TypeAlias = Literal["pose", "position", "orientation"]
ROWS: dict[Rows, slice] = {"pose": slice(0, 6), "position": slice(0, 3), "orientation": slice(3, 6)}


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Manipulability(OfFrame):
    """Yoshikawa's (1985) measure of a frame's Jacobian, y = sqrt(det(J J')), is at least ``least``.

    The derivative is by central differences of the measure.

    Attributes:
        least: Lower bound of the measure, which mixes m and rad.
        of: Rows of the Jacobian: those of the ``"pose"``, the ``"position"`` or the ``"orientation"``.

    Raises:
        InvalidTarget: If ``least`` is not above 0, or ``of`` is none of these.
    """

    least: float
    of: Rows = "pose"
    unit: ClassVar[str] = ""

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        if not 0.0 < self.least < math.inf:
            raise InvalidTarget(f"least is a finite number above 0, got {self.least!r}")
        if self.of not in ROWS:
            raise InvalidTarget(f"of is one of {', '.join(ROWS)}, got {self.of!r}")

    def _values(self, at: Placed) -> Array:
        return np.array([manipulability(at.jacobian(self.frame, self.reference)[ROWS[self.of]])])

    def _slopes(self, at: Placed) -> Array:
        return self._by_differences(at)

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return self.least, math.inf
