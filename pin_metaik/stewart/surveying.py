"""Judging the poses of a grid, slab by slab, so that it can be watched and interrupted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pin_metaik.interrupts import Interrupted
from pin_metaik.optimize.space import Array
from pin_metaik.stewart.cells import Cells, cells_of
from pin_metaik.stewart.conditioning import DEFAULT, Dexterity, best_length, measure
from pin_metaik.stewart.geometry import Geometry
from pin_metaik.stewart.grid import Grid
from pin_metaik.stewart.limits import LegLimits
from pin_metaik.stewart.loading import load_kernels
from pin_metaik.stewart.workspace import EmptyWorkspace, Workspace

Watch: TypeAlias = Callable[[int, int], object]
"""Told of progress: steps done, steps in all."""

CHUNK = 200_000  # poses looked at between two words on progress: a tenth of a second at most


def survey(
    geometry: Geometry,
    limits: LegLimits,
    grid: Grid | Cells | None = None,
    dexterity: Dexterity = DEFAULT,
    *,
    watch: Watch | None = None,
) -> Workspace:
    """Judge every pose of a grid.

    Args:
        geometry: The platform.
        limits: What its legs allow.
        grid: Where to look; default: as far as the legs reach, level, in 40 x 40 x 40 cells.
        dexterity: How to measure nu.
        watch: Called with (cells done, cells in all) as it goes.

    Raises:
        EmptyWorkspace: No pose of the grid is within the limits.
        InvalidGeometry: The home of the limits gives a joint no axis.
        Interrupted: Ctrl-C, once a pose was reached; its ``result`` is the workspace as far as it was seen.
    """
    cells = grid if isinstance(grid, Cells) else cells_of(grid or Grid(), geometry, limits)
    length = dexterity.length if not isinstance(dexterity.length, str) else geometry.platform_radius
    states, nu = np.zeros(cells.shape, dtype=np.int8), np.zeros(cells.shape)
    try:
        judge_cells(geometry, limits, cells, length, dexterity, states, nu, watch)
    except KeyboardInterrupt:
        seen = Workspace(geometry, limits, cells, dexterity, length, states, nu)
        if not seen.reached.any():
            raise
        raise Interrupted(with_best_length(seen)) from None
    found = Workspace(geometry, limits, cells, dexterity, length, states, nu)
    if not found.reached.any():
        raise EmptyWorkspace(found.counts)
    return with_best_length(found)


def with_best_length(workspace: Workspace) -> Workspace:
    """The workspace measured with the best characteristic length for it, if that is what its settings ask for."""
    if workspace.dexterity.length != "best" or not workspace.regular.any():
        return workspace
    poses, norm = workspace.poses(workspace.regular), workspace.dexterity.norm
    length = best_length(workspace.geometry, poses, norm)
    nu = np.zeros_like(workspace.nu)
    nu[workspace.regular], _ = measure(workspace.geometry, poses, length, norm)
    return replace(workspace, nu=nu, length=length)


def judge_cells(
    geometry: Geometry,
    limits: LegLimits,
    cells: Cells,
    length: float,
    dexterity: Dexterity,
    states: NDArray[np.int8],
    nu: Array,
    watch: Watch | None = None,
) -> None:
    """Fill in states and nu (nx, ny, nz, o), slab by slab along x."""
    kernels = load_kernels()
    R = cells.rotations  # (o, 3, 3)
    sockets = limits.sockets(geometry)  # (2, n, 3)
    turned = np.ascontiguousarray(geometry.m @ R.transpose(0, 2, 1))  # (o, n, 3)
    turned_sockets = np.ascontiguousarray(sockets[1] @ R.transpose(0, 2, 1))
    base, _, pairs = geometry.arrays
    nx, *slab = cells.shape
    thickness = max(1, CHUNK // int(np.prod(slab)))
    for first in range(0, nx, thickness):
        part = slice(first, first + thickness)
        kernels.survey(
            base,
            turned,
            sockets,
            turned_sockets,
            limits.array,
            pairs,
            cells.xs[part],
            cells.ys,
            cells.zs,
            length,
            dexterity.code,
            states[part],
            nu[part],
        )
        if watch is not None:
            watch(min(first + thickness, nx) * int(np.prod(slab)), int(np.prod(cells.shape)))
