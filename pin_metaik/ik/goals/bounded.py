"""A smooth function of the configuration that shall be inside bounds: the base of most goals."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from pin_metaik.arguments import checked, instance, number, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.placed import STEP, Placed, check_moved
from pin_metaik.ik.goals.pose import DEFAULT_TOLERANCE, WHOLE
from pin_metaik.ik.goals.sets import Grown
from pin_metaik.kinematics import Chain


@dataclass(frozen=True, eq=False)
class Bounded(ABC):
    """A function y (m,) of the configuration that shall be inside bounds, to within a tolerance.

    The way out of the bounds is e = y - clip(y, least, most), and the goal is met where |e| is at most the tolerance.
    A tolerance up to the default one is aimed at in its middle, e = 0; a larger one as a set.

    Attributes:
        tolerance: In the unit of y.
        weight: What a unit of error counts while searching.
    """

    _: KW_ONLY
    tolerance: float = DEFAULT_TOLERANCE
    weight: float = 1.0
    unit: ClassVar[str] = "m"

    def __post_init__(self) -> None:
        """Raises InvalidTarget for a tolerance or a weight that is not a finite number above 0."""
        for name in ("tolerance", "weight"):
            given = getattr(self, name)
            if not number(name, given, InvalidTarget) > 0.0:
                raise InvalidTarget(f"{name} is a finite number above 0, got {shown(given)}")

    @abstractmethod
    def _values(self, at: Placed) -> Array:
        """The function y (m,)."""

    @abstractmethod
    def _slopes(self, at: Placed) -> Array:
        """Its derivative (m, n) by the coordinates of the chain."""

    def _by_differences(self, at: Placed) -> Array:
        """The same by central differences, for a function whose derivative is not known."""
        slopes: Array = np.transpose([self._values(there) - self._values(back) for there, back in at.around])
        return slopes / (2.0 * STEP)

    @abstractmethod
    def _bounds(self, at: Placed) -> tuple[Array | float, Array | float]:
        """The bounds of y: (m,) each, or one number for all rows."""

    @cached_property
    def _radius(self) -> float:
        """The tolerance as a length of e."""
        return self.tolerance

    def _set(self, at: Placed) -> Grown:
        instance(Placed, at=at)
        return Grown(*self._bounds(at), WHOLE * self._radius if self.tolerance > DEFAULT_TOLERANCE else 0.0)

    def residual(self, at: Placed) -> Array:
        """Weighted distance (m,) to the set; see ``Bounded``."""
        return self.weight * self._set(at).residual(self._values(at))

    def jacobian(self, at: Placed) -> Array:
        """Derivative (m, n) of the residual by the coordinates of the chain."""
        return self.weight * self._set(at).slopes(self._values(at), self._slopes(at))

    def met(self, at: Placed) -> bool:
        """Whether the function is inside its bounds, to within the tolerance."""
        return self._excess(at) <= self._radius

    def off(self, at: Placed) -> dict[str, float]:
        """How far the function is outside its bounds, by unit."""
        return {self.unit: self._excess(at)}

    def _excess(self, at: Placed) -> float:
        e = self._set(at).excess(self._values(at))
        return math.sqrt(e.dot(e))


@dataclass(frozen=True, eq=False)
class OfFrame(Bounded):
    """The same of one frame of the robot, in the world or as another frame of the robot sees it.

    Attributes:
        frame: A frame that the chain moves; it need not be one that the chain is made for.
        reference: Another frame of the robot, in whose coordinates everything is given; ``None``: the world.
    """

    frame: str
    _: KW_ONLY
    reference: str | None = None

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            FrameNotFound: If the model has no such frame.
            FixedFrame: If the chain does not move the frame, in the world or as the reference sees it.
        """
        check_moved(chain, self.frame, self.reference)

    def _point(self, at: Placed) -> Array:
        """(3,) where the frame is, m."""
        point: Array = at.pose(self.frame, self.reference).translation
        return point

    def _speeds(self, at: Placed) -> Array:
        """(3, n) the derivative of that."""
        return at.jacobian(self.frame, self.reference)[:3]
