"""The workspace of a platform on a grid, and its indices: volume, GDI, LCI."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.plain import fields_of
from pin_metaik.stewart.kinematics.conditioning import Dexterity
from pin_metaik.stewart.platform.geometry import MOST_LEGS, Geometry
from pin_metaik.stewart.platform.limits import Limits
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.workspace.cells import Cells


class EmptyWorkspace(InvalidGeometry):
    """No pose of the grid is within the limits.

    Attributes:
        reasons: How many poses each limit forbids.
        room: A box (2, 3) in m that contains every position that the limits may allow within the ranges of the grid;
            None: it is proved that they allow none.
    """

    def __init__(self, reasons: dict[PoseState, int], room: Array | None = None) -> None:
        self.reasons, self.room = reasons, room
        total = sum(reasons.values())
        why = f"of {total} poses of the grid {', '.join(f'{n} are {state.words}' for state, n in reasons.items())}"
        if room is None:
            super().__init__(f"the workspace is empty: {why}; move the grid or widen the limits")
        else:
            ends = ", ".join(f"{name} {low:.6g} to {high:.6g}" for name, low, high in zip("xyz", *room, strict=True))
            super().__init__(f"no pose of the grid is within the limits: {why}; look with a finer grid at {ends} m")

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.reasons, self.room)


class Verdict(StrEnum):
    """Whether a mechanism holds its platform throughout its workspace."""

    REGULAR = "REGULAR"
    """No pose reached is singular, and det J has one sign."""
    UNDERCONSTRAINED = "UNDERCONSTRAINED"
    """Fewer than six legs: between universal and spherical joints they leave the platform freedoms everywhere."""
    CROSSES_SINGULARITY = "CROSSES_SINGULARITY"
    """Some poses reached are singular, or det J changes sign between them."""
    SINGULAR = "SINGULAR"
    """Every pose reached is singular: the mechanism does not work."""


@dataclass(frozen=True, eq=False)
class Workspace:
    """A grid of poses, each with its state and dexterity.

    Attributes:
        geometry: The platform.
        limits: Limits of its legs.
        cells: The grid.
        dexterity: How nu was measured.
        length: Characteristic length of nu, m.
        states: A ``PoseState`` for every pose (nx, ny, nz, o).
        nu: Local conditioning index (nx, ny, nz, o), 0 where not reached or singular.
    """

    geometry: Geometry
    limits: Limits
    cells: Cells
    dexterity: Dexterity
    length: float
    states: NDArray[np.int8]
    nu: Array

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: the indices in m and rad; ``gdi`` is None for a singular mechanism."""
        return {
            **fields_of(self, "verdict", "complete", "volume"),
            "volume_in_every_orientation": self.volume_of_all,
            "cells_reached": self.cells_reached,
            "share_reached": float(self.reached.mean()),
            "gdi": self.gdi,
            "norm": self.dexterity.norm,
            "characteristic_length": self.length,
            "poses": {state.name.lower(): count for state, count in self.counts.items()},
        }

    @property
    def complete(self) -> bool:
        """Whether every pose was looked at; if not, the survey was interrupted."""
        return not (self.states == PoseState.UNSEEN).any()

    @cached_property
    def reached(self) -> NDArray[np.bool_]:
        """Which poses are within the limits (nx, ny, nz, o)."""
        reached: NDArray[np.bool_] = (self.states >= PoseState.POSITIVE) & (self.states <= PoseState.SINGULAR)
        return reached

    @cached_property
    def regular(self) -> NDArray[np.bool_]:
        """Which poses are reached and not singular (nx, ny, nz, o)."""
        regular: NDArray[np.bool_] = self.reached & (self.states != PoseState.SINGULAR)
        return regular

    @cached_property
    def cells_reached(self) -> int:
        """Number of cells that the figures are based on: those reached in at least one of the orientations."""
        return int(self.reached.any(axis=-1).sum())

    @property
    def counts(self) -> dict[PoseState, int]:
        """How many poses have each state; states that do not occur are left out."""
        counts = np.bincount(self.states.ravel(), minlength=len(PoseState))
        return {state: int(counts[state]) for state in PoseState if counts[state]}

    @property
    def verdict(self) -> Verdict:
        """Whether the mechanism holds its platform throughout."""
        counts = self.counts
        sides = (PoseState.POSITIVE in counts) + (PoseState.NEGATIVE in counts)
        if sides == 0:
            return Verdict.SINGULAR
        if self.geometry.n < MOST_LEGS:
            return Verdict.UNDERCONSTRAINED
        return Verdict.CROSSES_SINGULARITY if sides == 2 or PoseState.SINGULAR in counts else Verdict.REGULAR

    @property
    def volume(self) -> float:
        """Volume of the positions reached in at least one of the orientations, m^3."""
        return self.cells_reached * self.cells.volume

    @property
    def volume_of_all(self) -> float:
        """Volume of the positions reached in every one of the orientations, m^3."""
        return float(self.reached.all(axis=-1).sum() * self.cells.volume)

    @property
    def at_one_position(self) -> bool:
        """Whether the grid has a single position, and therefore orientations but no volume."""
        return self.states.shape[:3] == (1, 1, 1) and self.states.shape[3] > 1

    @property
    def orientations(self) -> Array:
        """Share of the orientations reached at each position (nx, ny, nz)."""
        share: Array = self.reached.mean(axis=-1)
        return share

    @property
    def gdi(self) -> float | None:
        """Global dexterity index, Eq. 10: mean nu over the poses reached that are not singular.

        None if all are singular. See ``verdict`` and ``counts`` for how many were left out.
        """
        return float(self.nu[self.regular].mean()) if self.regular.any() else None

    @checked
    def dexterous(self, threshold: float) -> NDArray[np.bool_]:
        """Which poses have an LCI of at least the threshold (nx, ny, nz, o)."""
        dexterous: NDArray[np.bool_] = self.regular & (self.nu >= threshold)
        return dexterous

    @checked
    def dexterous_volume(self, threshold: float) -> float:
        """Volume of the positions with an LCI of at least the threshold in every orientation, m^3."""
        return float(self.dexterous(threshold).all(axis=-1).sum() * self.cells.volume)

    @cached_property
    def positions(self) -> Array:
        """Positions reached in at least one orientation, m (r, 3)."""
        return self.position_of(np.argwhere(self.reached.any(axis=-1)))

    @checked
    def position_of(self, index: NDArray[np.int64]) -> Array:
        """Positions (r, 3) in m of cells (r, 3 or more) given by their indices."""
        cells = self.cells
        _indices(index, cells.shape)
        return np.column_stack((cells.xs[index[:, 0]], cells.ys[index[:, 1]], cells.zs[index[:, 2]]))

    @checked
    def poses_of(self, index: NDArray[np.int64]) -> Array:
        """Poses (r, 4, 4) of the grid given by their indices (r, 4)."""
        _indices(index, self.cells.shape, 4)
        T = np.tile(np.eye(4), (len(index), 1, 1))
        T[:, :3, 3] = self.position_of(index)
        T[:, :3, :3] = self.cells.rotations[index[:, 3]]
        return T

    @checked
    def poses(self, which: NDArray[np.bool_]) -> Array:
        """Poses (r, 4, 4) of the grid where `which` (nx, ny, nz, o) is true."""
        if which.shape != self.states.shape:
            raise InvalidSetting(f"which is a boolean array of shape {self.states.shape}, got {which.shape}")
        return self.poses_of(np.argwhere(which))

    @property
    def worst(self) -> Array:
        """The pose (4, 4) reached with the lowest nu."""
        place = np.where(self.reached, self.nu, np.inf).argmin()
        worst: Array = self.poses_of(np.array([np.unravel_index(place, self.nu.shape)]))[0]
        return worst

    def __str__(self) -> str:
        gdi = "no GDI" if self.gdi is None else f"GDI {self.gdi:.4f}"
        share = f"{self.reached.sum()} of {self.reached.size} poses reached"
        size = "at one position" if self.at_one_position else f"{1e6 * self.volume:.4g} cm3"
        return f"{self.verdict}: {gdi}, {size}, {share}"


def _indices(index: NDArray[np.int64], shape: tuple[int, ...], columns: int = 3) -> None:
    """Raise InvalidSetting for what are no indices (r, columns) of cells in an array of this shape."""
    if index.ndim != 2 or not columns <= index.shape[1] <= len(shape):
        raise InvalidSetting(f"indices of cells have shape (r, {columns}), got {index.shape}")
    if ((index < 0) | (index >= shape[: index.shape[1]])).any():
        raise InvalidSetting(f"indices of cells lie inside the grid of shape {shape}")
