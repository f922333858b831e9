"""The grid of a workspace: positions, at one orientation or at several."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TypeAlias

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidBounds, InvalidSetting
from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.optimize.settings import few

Range: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Grid:
    """A grid of poses: cells of positions of P in the base frame, and orientations Rz(yaw) Ry(pitch) Rx(roll).

    Positions are the centres of equal cells, so that their number is a volume. Orientations include both ends of their
    range; a single step is the middle of it.

    An open range (None) is as wide as the limits of the legs allow, however narrow that is. With open ranges the grid
    has more cells than ``counts`` says, if otherwise too few of them would be reached.

    Attributes:
        counts: Number of cells along x, y and z.
        x: First and last x in m; None: as far as the limits allow.
        y: The same for y.
        z: The same for z; None: as far as the limits allow with the platform's joints above those of the base.
        steps: Number of orientations in roll, pitch and yaw.
        roll: First and last roll in rad.
        pitch: The same for pitch.
        yaw: The same for yaw.

    Raises:
        InvalidBounds: A range that is not two finite numbers, the lower first.
        InvalidSetting: Counts or steps that are not three whole numbers above zero.
    """

    counts: tuple[int, int, int] = (40, 40, 40)
    x: Range | None = None
    y: Range | None = None
    z: Range | None = None
    steps: tuple[int, int, int] = (1, 1, 1)
    roll: Range = (0.0, 0.0)
    pitch: Range = (0.0, 0.0)
    yaw: Range = (0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("counts", "steps"):
            counts = getattr(self, name)
            listed = counts.tolist() if isinstance(counts, np.ndarray) else counts
            if not isinstance(listed, (tuple, list)) or len(listed) != 3:
                raise InvalidBounds(f"{name} of a grid are three whole numbers, got {counts!r}")
            for count in counts:
                few(f"{name} of a grid", count)
            object.__setattr__(self, name, tuple(int(count) for count in counts))
        for name in ("x", "y", "z", "roll", "pitch", "yaw"):
            if (ends := getattr(self, name)) is not None:
                object.__setattr__(self, name, as_range(name, ends))

    @property
    def open(self) -> bool:
        """Whether a range of positions is left open."""
        return None in (self.x, self.y, self.z)

    @cached_property
    def rpy(self) -> Array:
        """Its orientations (o, 3) in rad, roll outermost."""
        turns = zip((self.roll, self.pitch, self.yaw), self.steps, strict=True)
        return np.array(list(product(*(_angles(ends, steps) for ends, steps in turns))))

    @cached_property
    def rotations(self) -> Array:
        """Their rotation matrices (o, 3, 3)."""
        return np.array([rpy_matrix(*angles) for angles in self.rpy])

    @classmethod
    @checked
    def at(cls, xyz: tuple[float, float, float], **orientations: object) -> Grid:
        """A grid of orientations at one position (m): ``Grid.at((0, 0, 0.4), steps=(9, 9, 1), roll=(-0.3, 0.3))``."""
        x, y, z = xyz
        if unknown := orientations.keys() - {"steps", "roll", "pitch", "yaw"}:
            raise InvalidSetting(f"a grid of orientations takes steps, roll, pitch and yaw, got {min(unknown)!r}")
        return cls((1, 1, 1), (x, x), (y, y), (z, z), **orientations)  # type: ignore[arg-type]  # checked as fields


def as_range(name: str, ends: object) -> Range:
    """First and last of a range.

    Raises:
        InvalidBounds: Not two finite numbers, or crossed.
    """
    try:
        low, high = (float(end) for end in ends)  # type: ignore[attr-defined]  # what has no two ends is told
    except (TypeError, ValueError, OverflowError):
        raise InvalidBounds(f"the range of {name} is two numbers, got {ends!r}") from None
    if not (np.isfinite(low) and np.isfinite(high)) or low > high:
        raise InvalidBounds(f"the range of {name} is two finite numbers, the lower first, got {low:g} and {high:g}")
    return low, high


def _angles(ends: Range, steps: int) -> list[float]:
    """Angles from end to end; a single one is the middle."""
    return np.linspace(*ends, steps).tolist() if steps > 1 else [0.5 * (ends[0] + ends[1])]
