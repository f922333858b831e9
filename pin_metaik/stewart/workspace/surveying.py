"""Judging the poses of a grid, slab by slab, and of finer grids until enough cells carry the figures of a workspace."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.interrupts import Interrupted
from pin_metaik.stewart.kernels.loading import load_judging
from pin_metaik.stewart.kinematics.conditioning import DEFAULT, Dexterity, best_length, measure
from pin_metaik.stewart.kinematics.judging import arguments_of
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.limits import Limits
from pin_metaik.stewart.workspace.cells import Cells, cells_of, finer_cells, room
from pin_metaik.stewart.workspace.grid import Grid
from pin_metaik.stewart.workspace.workspace import EmptyWorkspace, Workspace
from pin_metaik.watching import Progress, Stopped, Watch, ended, tell, with_result

CHUNK = 200_000  # poses looked at between two words on progress: a tenth of a second at most
LEAST = 1000
"""Cells that must be reached for a survey to be content with an open grid: volumes are good to a percent or two."""
MOST = 4_000_000
"""Poses of the finest grid that is laid for that, unless the grid itself has more."""
FINER = 0.99
"""A grid whose cells are not smaller than this share of the last one's is not looked at."""
SPARE = 1.2
"""How many more cells than needed a finer grid aims at, so that it need not be made finer once more."""


@checked
def survey(
    geometry: Geometry,
    limits: Limits,
    grid: Grid | Cells | None = None,
    dexterity: Dexterity = DEFAULT,
    *,
    watch: Watch | None = None,
) -> Workspace:
    """Judge every pose of a grid.

    A grid with open ranges covers the positions that the limits can allow, and is refined until a thousand of its cells
    are reached, up to four million poses; ``Workspace.cells_reached`` is the number of cells that the figures are based
    on. A grid with all its ranges given is used as it is.

    Args:
        geometry: The platform.
        limits: Limits of its legs.
        grid: The grid; default: as far as the limits allow, level, in 40 x 40 x 40 cells.
        dexterity: How to measure nu.
        watch: Called with the cells done and in all; returning True ends the survey, and ``complete`` is then False.

    Raises:
        EmptyWorkspace: No pose of the grid is within the limits; it says whether that is proved between them, too.
        InvalidGeometry: Limits of the other kind of legs, or a ``home`` at which the axis of a joint is undefined.
        Interrupted: Ctrl-C, once a pose was reached; its ``result`` is the workspace as far as it was surveyed.
    """
    where = grid or Grid()
    try:
        if isinstance(where, Cells):
            found, left = judged(geometry, limits, where, dexterity, watch), None
        else:
            found, left = explored(geometry, limits, where, dexterity, LEAST if where.open else 0, MOST, watch)
    except Interrupted as stop:
        return ended(stop, with_best_length(stop.result))
    if not found.reached.any():
        raise EmptyWorkspace(found.counts, left)
    return with_best_length(found)


def explored(
    geometry: Geometry,
    limits: Limits,
    grid: Grid,
    dexterity: Dexterity,
    least: int,
    most: int,
    watch: Watch | None = None,
) -> tuple[Workspace, Array | None]:
    """A grid judged, or a finer one within it so that at least so many cells are reached, in at most so many poses.

    Returns:
        The workspace, in which no pose may be reached, and then the box (2, 3) of what the limits may still allow
        within the ranges of the grid; None if it is proved that they allow nothing there.
    """
    found = judged(geometry, limits, cells_of(grid, geometry, limits), dexterity, watch)
    if found.cells_reached >= max(least, 1):
        return found, None
    box = room(grid, geometry, limits)
    if box is None or max(grid.counts) == 1:
        return found, box
    while found.cells_reached < least:
        volume = found.volume / (SPARE * least) if found.cells_reached else found.cells.volume / 8.0
        finest = float(np.prod(np.ptp(box, axis=0))) * len(found.cells.rpy) / most
        if not max(volume, finest) > 0.0:
            break  # the limits leave no more than a point
        cells = finer_cells(grid, box, max(volume, finest))
        if cells.volume > FINER * found.cells.volume:
            break
        found = judged(geometry, limits, cells, dexterity, watch)
    return found, box


def judged(
    geometry: Geometry, limits: Limits, cells: Cells, dexterity: Dexterity, watch: Watch | None = None
) -> Workspace:
    """Cells judged.

    Raises:
        Interrupted: Ctrl-C, once a pose was reached, or a watch; its ``result`` has the cells that were looked at.
    """
    length = dexterity.length if not isinstance(dexterity.length, str) else geometry.platform_radius
    states, nu = np.zeros(cells.shape, dtype=np.int8), np.zeros(cells.shape)
    found = Workspace(geometry, limits, cells, dexterity, length, states, nu)
    try:
        judge_cells(geometry, limits, cells, length, dexterity, states, nu, watch)
    except KeyboardInterrupt as stop:
        if not (found.reached.any() or isinstance(stop, Stopped)):
            raise
        raise with_result(stop, found) from None
    return found


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
    limits: Limits,
    cells: Cells,
    length: float,
    dexterity: Dexterity,
    states: NDArray[np.int8],
    nu: Array,
    watch: Watch | None = None,
) -> None:
    """Fill in states and nu (nx, ny, nz, o), slab by slab along x."""
    kernels = load_judging()
    R = cells.rotations  # (o, 3, 3)
    base, _, joint_axes, most, servos, pairs = arguments_of(geometry, limits)
    turned = np.ascontiguousarray(geometry.m @ R.transpose(0, 2, 1))  # (o, n, 3)
    turned_joint_axes = np.ascontiguousarray(joint_axes[1] @ R.transpose(0, 2, 1))
    nx, *slab = cells.shape
    thickness = max(1, CHUNK // int(np.prod(slab)))
    for first in range(0, nx, thickness):
        part = slice(first, first + thickness)
        kernels.survey(
            base,
            turned,
            joint_axes,
            turned_joint_axes,
            most,
            servos,
            pairs,
            cells.xs[part],
            cells.ys,
            cells.zs,
            length,
            dexterity.code,
            states[part],
            nu[part],
        )
        tell(watch, Progress(min(first + thickness, nx) * int(np.prod(slab)), int(np.prod(cells.shape))))
