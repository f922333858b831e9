"""A workspace as a body of cells: those of its positions, or of its orientations where there is a single position."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.stewart.workspace.workspace import Workspace

MOST_CELLS = 60  # along each axis; more make no visible difference
LIGHT = {(0, 1): 0.88, (0, -1): 0.8, (1, 1): 0.72, (1, -1): 0.94, (2, 1): 1.0, (2, -1): 0.62}
"""How bright the faces of cells are, by their axis and side: lit from above and in front."""
THIN = 0.02  # half the thickness of a layer one cell thick, as a share of the largest extent


@dataclass(frozen=True, eq=False)
class Body:
    """Cells in three coordinates.

    Attributes:
        inside: Which cells are reached (a, b, c).
        nu: Of each cell, the mean over the poses reached in it (a, b, c).
        centres: Of the cells along each axis, as they are shown.
        labels: Of the axes.
        title: Title of the picture.
    """

    inside: NDArray[np.bool_]
    nu: Array
    centres: list[Array]
    labels: tuple[str, ...]
    title: str


def body_of(workspace: Workspace, scale: float, unit: str) -> Body:
    """The body of a workspace; ``scale`` turns m into the unit that is shown."""
    cells, reached = workspace.cells, workspace.reached
    if workspace.at_one_position:
        rpy = np.degrees(cells.rpy.reshape(*cells.steps, 3))
        angles = [rpy[:, 0, 0, 0], rpy[0, :, 0, 1], rpy[0, 0, :, 2]]
        share = f"{100 * reached.mean():.0f} % of the orientations at one position"
        inside, nu = reached.reshape(cells.steps), workspace.nu.reshape(cells.steps)
        return Body(inside, nu, angles, ("roll (deg)", "pitch (deg)", "yaw (deg)"), share)
    step = [-(-count // MOST_CELLS) for count in reached.shape[:3]]  # of a fine grid, every so many cells
    part = tuple(slice(s // 2, None, s) for s in step)
    some = reached[part]
    centres = [scale * axis[p] for axis, p in zip((cells.xs, cells.ys, cells.zs), part, strict=True)]
    nu = workspace.nu[part].sum(axis=-1) / np.maximum(some.sum(axis=-1), 1)
    labels = tuple(f"{name} ({unit})" for name in "xyz")
    return Body(np.asarray(some.any(axis=-1)), nu, centres, labels, f"workspace: {1e6 * workspace.volume:.4g} cm³")


def draw_body(figure: Any, axes: Any, body: Body, opacity: float = 1.0) -> None:
    """Draw a body's outer faces into 3D axes, coloured by nu, with a colour bar beside them."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    faces, light, nu = _faces(body)
    if not len(faces):
        return  # the workspace lies between the cells that are shown
    colour = ScalarMappable(Normalize(nu.min(), nu.max()), "viridis")
    rgba = colour.to_rgba(nu)
    rgba[:, :3] *= light[:, None]
    rgba[:, 3] = opacity
    axes.add_collection3d(polygons(faces, facecolors=rgba, edgecolors=rgba, linewidths=0.2 * opacity))
    corners = faces.reshape(-1, 3)
    for name, low, high in zip("xyz", corners.min(axis=0), corners.max(axis=0), strict=True):
        getattr(axes, f"set_{name}lim")(low, high)
    figure.colorbar(colour, ax=axes, shrink=0.62, pad=0.12).set_label("local dexterity nu (1: isotropic, 0: singular)")


def polygons(corners: Any, **style: Any) -> Any:
    """Polygons in space for ``add_collection3d``."""
    return import_module("mpl_toolkits.mplot3d.art3d").Poly3DCollection(corners, **style)


def _faces(body: Body) -> tuple[Array, Array, Array]:
    """Outer faces (f, 4, 3) of the cells, how bright each is (f,), and the cell's nu (f,)."""
    inside = np.pad(body.inside, 1)
    extent = max(float(np.ptp(axis)) for axis in body.centres) or 1.0
    half = np.array([0.5 * (axis[1] - axis[0]) if np.ptp(axis) > 0.0 else THIN * extent for axis in body.centres])
    faces, light, values = [], [], []
    for (axis, side), bright in LIGHT.items():
        index = np.argwhere(inside & ~np.roll(inside, -side, axis)) - 1
        middle = np.column_stack([centre[i] for centre, i in zip(body.centres, index.T, strict=True)])
        corners = np.zeros((4, 3))
        corners[:, axis] = side
        corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = (-1, 1, 1, -1), (-1, -1, 1, 1)
        faces.append(middle[:, None] + half * corners)
        light.append(np.full(len(index), bright))
        values.append(body.nu[tuple(index.T)])
    return np.concatenate(faces), np.concatenate(light), np.concatenate(values)
