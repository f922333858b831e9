"""The goal of a placement, of a frame or of one end of a loop, with tolerances of position and orientation."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import pinocchio as pin

from pin_metaik.arrays import Array
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.pose import Target


@dataclass(frozen=True, eq=False)
class Posed(ABC):
    """A placement that a function of the configuration shall have, judged and descended to as a ``Target`` is."""

    _target: Target = field(init=False, repr=False)

    @abstractmethod
    def _placement(self, at: Placed) -> pin.SE3:
        """The placement."""

    @abstractmethod
    def _speeds(self, at: Placed) -> Array:
        """Its velocity (6, n) by the coordinates, along the axes that it is given in."""

    def residual(self, at: Placed) -> Array:
        """(6,) weighted errors of position (m) and orientation (rad) beyond the tolerances."""
        return self._target._beyond(self._placement(at))

    def jacobian(self, at: Placed) -> Array:
        """(6, n) derivative of the residual by the coordinates of the chain."""
        return self._target._slopes(self._placement(at), self._speeds(at))

    def met(self, at: Placed) -> bool:
        """Whether the placement is within the tolerances."""
        return self._target.judge(self._placement(at)).met

    def off(self, at: Placed) -> dict[str, float]:
        """Distance (m) and angle (rad) from it, over the axes that count."""
        return self._target._off(self._placement(at))
