"""Boxes of an arm's configurations, excluded in turns: what is left of them, and what may hold a solution."""

from __future__ import annotations

from copy import copy

import numpy as np

from pin_metaik.kinematics.proofs.arm import Floats, ProofArm

TINY = 1e-7  # rad or m, half width below which a box is a place to descend from
DEPTH = 1024  # boxes for which there is room at first; a box of 8 coordinates that is halved to TINY leaves some 250


class Boxes:
    """What is still to be looked at of all configurations of an arm, for one target.

    Attributes:
        arm: The arm.
        looked: Boxes looked at so far.
        clean: Whether none was kept so far.
    """

    def __init__(
        self,
        arm: ProofArm,
        pose: Floats,
        near: float,
        aligned: float,
        least: float = TINY,
        begin: Floats | None = None,
    ) -> None:
        """Begin with all configurations inside the limits, or with some boxes of them.

        Args:
            arm: The arm.
            pose: (4, 4) world pose of its tip.
            near: How far (m) from it the tip may be.
            aligned: By how much (rad) it may be turned.
            least: Half width (rad or m) below which a box is kept instead of split.
            begin: (b, 2 m) the boxes; outside of them there must be no solution.
        """
        self.arm = arm
        self.looked = 0
        self.clean = True
        self._target = arm.target(pose, near, aligned)
        self._least = least
        self._waiting = np.empty((DEPTH, arm.whole.shape[1]))
        first = arm.whole if begin is None or len(begin) > DEPTH // 2 else begin
        self._count = len(first)
        self._waiting[: self._count] = first

    def within(self, box: Floats, least: float) -> Boxes:
        """The same for the configurations of one box (2 m,) that was kept, down to smaller ones."""
        return self.among(box[None], least)

    def among(self, boxes: Floats, least: float) -> Boxes:
        """The same for the configurations of some boxes (b, 2 m) that were kept, down to smaller ones."""
        part = copy(self)
        part.looked, part.clean, part._least = 0, True, least
        part._waiting = np.empty((len(boxes) + DEPTH, boxes.shape[1]))
        part._waiting[: len(boxes)], part._count = boxes, len(boxes)
        return part

    @property
    def least(self) -> float:
        """Half width (rad or m) below which a box is kept."""
        return self._least

    @property
    def done(self) -> bool:
        """Whether no box is left to look at: what was not kept is proved to hold no solution."""
        return self._count == 0

    @property
    def excluded(self) -> bool:
        """Whether it is proved that no configuration inside the limits reaches the target."""
        return self.done and self.clean

    def look(self, boxes: int, leaves: int = 1) -> Floats:
        """Look at so many boxes at most; returns the centres and half widths of those kept (k, 2 m).

        It ends with ``leaves`` of them, or one more.

        The last coordinates, beyond the chain's own, are those of the free joints at the tip.
        """
        kept = np.empty((leaves + 1, self._waiting.shape[1]))
        looked = found = 0
        while True:
            some, more, self._count = self.arm.cover(
                *self.arm.arrays, *self._target, self._waiting, self._count, self._least, boxes - looked, kept[found:]
            )
            looked, found = looked + some, found + more
            if self.done or looked >= boxes or found >= leaves:
                break
            self._waiting = np.concatenate([self._waiting, np.empty_like(self._waiting)])  # there was no room left
        self.looked += looked
        self.clean = self.clean and found == 0
        return kept[:found]
