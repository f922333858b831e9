"""A grid with its ranges settled: the poses to judge, within the box that a platform's limits leave."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.stewart.kernels.loading import load_bounds
from pin_metaik.stewart.kinematics.judging import arguments_of
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits, lengths
from pin_metaik.stewart.workspace.grid import Grid

COVER = 12
"""Cells along each axis of the covers that find the room which joints and the distance between legs leave."""
SHRINKS = 0.9
"""A box is covered again if it shrank to less than this share along any axis."""


@dataclass(frozen=True, eq=False)
class Cells:
    """Centres of cells, each in some orientations.

    Attributes:
        xs: Centres of the cells along x, m (nx,).
        ys: Along y (ny,).
        zs: Along z (nz,).
        rpy: Orientations, rad (o, 3), roll outermost.
        rotations: Their rotation matrices (o, 3, 3).
        steps: How many of them in roll, pitch and yaw.
        volume: Of one cell, m^3.
    """

    xs: Array
    ys: Array
    zs: Array
    rpy: Array
    rotations: Array
    steps: tuple[int, int, int]
    volume: float

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """(nx, ny, nz, o)."""
        return len(self.xs), len(self.ys), len(self.zs), len(self.rpy)

    @property
    def places(self) -> int:
        """How many positions."""
        return len(self.xs) * len(self.ys) * len(self.zs)

    @property
    def poses(self) -> int:
        """How many poses: positions, each in every orientation."""
        return self.places * len(self.rpy)


def cells_of(grid: Grid, geometry: Geometry, limits: Limits) -> Cells:
    """The cells of a grid; ranges left open become as wide as the limits leave P room.

    Where they leave it none, as wide as the longest legs could sweep: every pose will be found to be forbidden.
    """
    given = (grid.x, grid.y, grid.z)
    if all(ends is not None for ends in given):
        return _laid(grid, np.array(given, dtype=float).T, grid.counts)
    box = room(grid, geometry, limits)
    box = _sweep(grid, geometry, limits) if box is None else box
    for axis, ends in enumerate(given):
        if ends is not None:
            box[:, axis] = ends
    return _laid(grid, box, grid.counts)


def finer_cells(grid: Grid, box: Array, volume: float) -> Cells:
    """Cells of at most this volume (m^3), and no fewer than the grid's, over the part of it within a box (2, 3).

    An axis with a single cell keeps it.
    """
    free = np.array(grid.counts) > 1
    part = box.copy()
    for axis, ends in enumerate((grid.x, grid.y, grid.z)):
        if ends is not None and not free[axis]:
            part[:, axis] = ends
    size = float(np.prod(part[1] - part[0])) / float(np.prod(grid.counts))
    factor = max(1.0, size / volume) ** (1.0 / max(int(free.sum()), 1))
    counts = np.where(free, np.ceil(np.array(grid.counts) * factor), 1).astype(int)
    return _laid(grid, part, (int(counts[0]), int(counts[1]), int(counts[2])))


def room(grid: Grid, geometry: Geometry, limits: Limits) -> Array | None:
    """A box (2, 3) that holds every position within the limits, in any orientation of the grid and within its ranges.

    With the lengths of linear actuators alone it is exact. None: there is no such position, proved but for rounding.
    """
    R = grid.rotations
    turned = np.ascontiguousarray(geometry.m @ R.transpose(0, 2, 1))  # (o, n, 3)
    spheres = geometry.b - turned
    bounds, box = load_bounds(), np.empty((2, 3))
    base, _, joint_axes, most, servos, pairs = arguments_of(geometry, limits)
    bounds.reach(spheres, most, _ends(grid, spheres), box)
    if (box[0] > box[1]).any():
        return None
    if not limits.beyond_lengths:
        return box
    turned_joint_axes = np.ascontiguousarray(joint_axes[1] @ R.transpose(0, 2, 1))
    counts = np.full(3, COVER)
    while True:
        part = np.empty((2, 3))
        if not bounds.cover(base, turned, joint_axes, turned_joint_axes, most, servos, pairs, box, counts, part):
            return None
        if (np.ptp(part, axis=0) >= SHRINKS * np.ptp(box, axis=0)).all():
            return part
        box = part


def _laid(grid: Grid, box: Array, counts: tuple[int, int, int]) -> Cells:
    (xs, dx), (ys, dy), (zs, dz) = (_centres(low, high, n) for low, high, n in zip(*box, counts, strict=True))
    return Cells(xs, ys, zs, grid.rpy, grid.rotations, grid.steps, float(dx * dy * dz))


def _centres(low: float, high: float, count: int) -> tuple[Array, float]:
    """Centres (count,) of the equal parts of a range, and their size."""
    size = (high - low) / count
    centres: Array = low + (np.arange(count, dtype=float) + 0.5) * size
    return centres, size


def _ends(grid: Grid, spheres: Array) -> Array:
    """The ranges (2, 3) of a grid; open ones are infinite, but for the platform's joints being above the base's."""
    ends = np.array([(-np.inf, np.inf) if given is None else given for given in (grid.x, grid.y, grid.z)]).T.copy()
    if grid.z is None:
        ends[0, 2] = spheres[..., 2].max(axis=1).min()
    return ends


def _sweep(grid: Grid, geometry: Geometry, limits: Limits) -> Array:
    """The box (2, 3) of P within ``longest`` of every b_i - R m_i, or of the middle of these where there is none."""
    spheres = geometry.b - geometry.m @ grid.rotations.transpose(0, 2, 1)  # (o, n, 3)
    _, longest = lengths(limits, geometry)
    low = (spheres.max(axis=1) - longest).min(axis=0)
    high = np.maximum((spheres.min(axis=1) + longest).max(axis=0), low)
    low[2] = _ends(grid, spheres)[0, 2]
    return np.array([low, np.maximum(high, low)])
