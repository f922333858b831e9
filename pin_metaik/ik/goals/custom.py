"""A goal of your own: a function of the configuration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget
from pin_metaik.ik.goals.bounded import Bounded
from pin_metaik.ik.goals.placed import Placed
from pin_metaik.ik.goals.vectors import check_range


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Custom(Bounded):
    """A function of the configuration that shall be zero, or between two numbers: y = function(q).

    For any other condition write a class with the two methods of ``Goal``.

    Attributes:
        function: Function of a configuration q (nq,) that returns a number, or numbers (m,).
        derivative: Function that returns its derivative (m, n) by the coordinates of the chain; ``None``: central
            differences.
        least: Lower bound of each number.
        most: Upper bound of each number.

    Raises:
        InvalidTarget: If ``function`` cannot be called, or ``least`` is above ``most``. While solving, if the function
            does not return finite numbers, or the derivative has another shape.
    """

    function: Callable[[Array], ArrayLike]
    _: KW_ONLY
    derivative: Callable[[Array], ArrayLike] | None = None
    least: float = 0.0
    most: float = 0.0
    unit: ClassVar[str] = ""

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        check_range("what the function gives", self.least, self.most)

    def _values(self, at: Placed) -> Array:
        given = self.function(at.q.copy())
        numbers = np.atleast_1d(given) if isinstance(given, (int, float, np.ndarray, np.generic)) else given
        return array(f"what {_named(self.function)} gives for a configuration", numbers, "m", error=InvalidTarget)

    def _slopes(self, at: Placed) -> Array:
        if self.derivative is None:
            return self._by_differences(at)
        name, m = f"what {_named(self.derivative)} gives as a derivative", len(self._values(at))
        return array(name, self.derivative(at.q.copy()), m, at.chain.n, error=InvalidTarget)

    def _bounds(self, at: Placed) -> tuple[float, float]:
        return self.least, self.most


def _named(function: Callable[..., object]) -> str:
    return str(getattr(function, "__name__", type(function).__name__))
