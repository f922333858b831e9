"""Where a workspace is looked for: a grid of positions, at one orientation or at several."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidBounds, InvalidSetting
from pin_metaik.optimize.settings import few

Range: TypeAlias = tuple[float, float]

COLUMNS = 48  # along x and y, when looking for how far the legs reach


@dataclass(frozen=True)
class Grid:
    """Positions of P in the base frame, by cells; orientations Rz(yaw) Ry(pitch) Rx(roll), by steps.

    Positions are the centres of equal cells, so that a count of them is a volume. Orientations include both ends of
    their range, so that "all of them" means what it says; one step is the middle.

    Attributes:
        counts: Cells along x, y and z.
        x: First and last x in m; None: as far as the legs reach.
        y: The same for y.
        z: The same for z; None: as far as they reach with the platform's joints above the base's.
        steps: Orientations in roll, pitch and yaw.
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
            if not isinstance(counts, (tuple, list, np.ndarray)) or np.shape(counts) != (3,):
                raise InvalidBounds(f"{name} of a grid are three whole numbers, got {counts!r}")
            for count in counts:
                few(f"{name} of a grid", count)
            object.__setattr__(self, name, tuple(int(count) for count in counts))
        for name in ("x", "y", "z", "roll", "pitch", "yaw"):
            if (ends := getattr(self, name)) is not None:
                object.__setattr__(self, name, as_range(name, ends))

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
