"""A grid with its ranges settled: the poses to look at, for a platform whose legs reach so far."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.pose import rpy_matrix
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.geometry import Geometry
from pin_metaik.stewart.grid import Grid, Range
from pin_metaik.stewart.limits import LegLimits
from pin_metaik.stewart.loading import load_kernels

COLUMNS = np.linspace(0.0, 1.0, 48)
"""Where columns stand along x and y, when looking for how far the legs reach, as shares of the range."""


@dataclass(frozen=True, eq=False)
class Cells:
    """Centres of cells, each in some orientations.

    Attributes:
        xs: Centres of the cells along x, m (nx,).
        ys: Along y (ny,).
        zs: Along z (nz,).
        rpy: Orientations, rad (o, 3), roll outermost.
        steps: How many of them in roll, pitch and yaw.
        volume: Of one cell, m^3.
    """

    xs: Array
    ys: Array
    zs: Array
    rpy: Array
    steps: tuple[int, int, int]
    volume: float

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """(nx, ny, nz, o)."""
        return len(self.xs), len(self.ys), len(self.zs), len(self.rpy)

    @property
    def rotations(self) -> Array:
        """Rotation matrices (o, 3, 3)."""
        return np.array([rpy_matrix(*rpy) for rpy in self.rpy])


def cells_of(grid: Grid, geometry: Geometry, limits: LegLimits) -> Cells:
    """The cells of a grid; ranges left open become as wide as these legs reach."""
    turns = zip((grid.roll, grid.pitch, grid.yaw), grid.steps, strict=True)
    rpy = np.array(list(product(*(_steps(ends, steps) for ends, steps in turns))))
    x, y, z = grid.x, grid.y, grid.z
    if x is None or y is None or z is None:
        R = np.array([rpy_matrix(*angles) for angles in rpy])
        x, y, z = _reach(grid, geometry, limits, np.ascontiguousarray(geometry.m @ R.transpose(0, 2, 1)))
    (xs, dx), (ys, dy), (zs, dz) = (_centres(*axis) for axis in zip((x, y, z), grid.counts, strict=True))
    return Cells(xs, ys, zs, rpy, grid.steps, dx * dy * dz)


def _steps(ends: Range, steps: int) -> list[float]:
    """Angles from end to end; a single one is the middle."""
    return np.linspace(*ends, steps).tolist() if steps > 1 else [0.5 * (ends[0] + ends[1])]


def _centres(ends: Range, count: int) -> tuple[Array, float]:
    """Centres (count,) of the equal parts of a range, and their size."""
    size = (ends[1] - ends[0]) / count
    centres: Array = ends[0] + (np.arange(count, dtype=float) + 0.5) * size
    return centres, size


def _reach(grid: Grid, geometry: Geometry, limits: LegLimits, turned: Array) -> tuple[Range, Range, Range]:
    """How far the lengths of the legs let P go, in any of the orientations with R m_i ``turned`` (o, n, 3).

    P stays within ``longest`` of every b_i - R m_i. Inside that box the legs leave an interval of height above every
    point of the base; the box is drawn round these, with one column to spare. Ranges given stay as they are.
    """
    spheres = geometry.b - turned  # (o, n, 3)
    low = (spheres.max(axis=1) - limits.longest).min(axis=0)
    high = np.maximum((spheres.min(axis=1) + limits.longest).max(axis=0), low)
    floor = float(spheres[..., 2].max(axis=1).min())  # platform joints above base joints
    x, y = grid.x or (float(low[0]), float(high[0])), grid.y or (float(low[1]), float(high[1]))
    xs, ys = (ends[0] + (ends[1] - ends[0]) * COLUMNS for ends in (x, y))
    bottoms, tops = np.empty((len(xs), len(ys))), np.empty((len(xs), len(ys)))
    load_kernels().heights(geometry.arrays[0], turned, xs, ys, limits.shortest, limits.longest, bottoms, tops)
    open_: NDArray[np.bool_] = bottoms <= tops
    if not open_.any():
        return x, y, grid.z or (floor, max(floor, float(high[2])))
    step = max(float(xs[1] - xs[0]), float(ys[1] - ys[0]))
    return (
        grid.x or _trim(xs, np.asarray(open_.any(axis=1))),
        grid.y or _trim(ys, np.asarray(open_.any(axis=0))),
        grid.z or (max(float(bottoms.min()) - step, floor), float(tops.max()) + step),
    )


def _trim(axis: Array, open_: NDArray[np.bool_]) -> Range:
    """The part of an axis that is open, and one step to either side."""
    inside = np.flatnonzero(open_)
    return float(axis[max(inside[0] - 1, 0)]), float(axis[min(inside[-1] + 1, len(axis) - 1)])
