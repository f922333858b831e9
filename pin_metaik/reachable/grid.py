"""Grids of positions and orientations for maps."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidBounds, InvalidSetting
from pin_metaik.kinematics import Chain
from pin_metaik.optimize.settings import few, positive

PSI = 1.533751168755204288118041  # of the spirals: psi^4 = psi + 4
MOST = 10_000_000  # positions of a grid


@checked
@dataclass(frozen=True)
class Grid:
    """A regular grid of positions in a box, including its upper end where the width is a multiple of the spacing.

    Attributes:
        lower: Least x, y and z, m, in the world.
        upper: Greatest x, y and z, m.
        spacing: Distance between neighbours, m.

    Raises:
        InvalidBounds: If a lower bound is above its upper one, or not finite.
        InvalidSetting: If the spacing is not above 0, or there are more than ten million positions.
    """

    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    spacing: float

    def __post_init__(self) -> None:
        lower, upper = (array("a corner of a grid", end, 3, error=InvalidBounds) for end in (self.lower, self.upper))
        positive("spacing", self.spacing)
        if not (lower <= upper).all():
            raise InvalidBounds(
                f"a grid has finite corners, the lower corner not above the upper one, got {self.lower}, {self.upper}"
            )
        if np.prod((upper - lower) / self.spacing + 1.0) > MOST:
            raise InvalidSetting(f"a grid has at most {MOST:,} positions: take a larger spacing than {self.spacing}")

    @staticmethod
    @checked
    def around(chain: Chain, spacing: float) -> Grid:
        """A grid around all positions that a chain can possibly reach, at whole multiples of a spacing (m).

        Args:
            chain: The chain whose first frame is placed.
            spacing: Distance between neighbours, m.

        Raises:
            InvalidSetting: If the spacing is not above 0, there are more than ten million positions, or nothing bounds
                how far the chain reaches.
        """
        positive("spacing", spacing)
        reach = chain.reach(0, False)
        if not math.isfinite(reach.most):
            raise InvalidSetting("the reach of this chain is not bounded: make a Grid of two corners")
        low, high = (np.floor(side * (reach.anchor + side * reach.most) / spacing) * side for side in (-1.0, 1.0))
        a, b, c = (spacing * low).tolist()
        d, e, f = (spacing * high).tolist()
        return Grid((a, b, c), (d, e, f), spacing)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Positions along x, y and z."""
        ends = zip(self.lower, self.upper, strict=True)
        a, b, c = (math.floor((high - low) / self.spacing + 1e-9) + 1 for low, high in ends)
        return a, b, c

    @property
    def axes(self) -> tuple[NDArray[np.float64], ...]:
        """The coordinates along x, y and z, m."""
        counts = zip(self.lower, self.shape, strict=True)
        return tuple(low + self.spacing * np.arange(n, dtype=float) for low, n in counts)

    @property
    def positions(self) -> NDArray[np.float64]:
        """(k, 3) all positions, z first, then y, then x."""
        return np.stack(np.meshgrid(*self.axes, indexing="ij"), axis=-1).reshape(-1, 3)


def spread_rotations(count: int) -> NDArray[np.float64]:
    """Rotations (count, 3, 3) that are spread evenly: super-Fibonacci spirals (Alexa 2022).

    Raises:
        InvalidSetting: If there is not at least one.
    """
    few("count", count)
    s = np.arange(count) + 0.5
    alpha, beta = 2.0 * np.pi * s / math.sqrt(2.0), 2.0 * np.pi * s / PSI
    r, R = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    x, y, z, w = r * np.sin(alpha), r * np.cos(alpha), R * np.sin(beta), R * np.cos(beta)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
    rotations: NDArray[np.float64] = np.moveaxis(np.array(rows), 2, 0)
    return rotations
