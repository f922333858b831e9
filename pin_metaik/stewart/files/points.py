"""A workspace as points for other programs: CSV with a row a position, or PLY coloured by dexterity."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pin_metaik.arguments import checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.output import writable
from pin_metaik.stewart.workspace.workspace import Workspace

FORMATS = (".csv", ".ply")
LOW, HIGH = np.array([68.0, 1.0, 84.0]), np.array([253.0, 231.0, 37.0])  # colours of the least and the greatest nu


@checked
def save_points(workspace: Workspace, path: str | Path, metres: float = 1.0) -> Path:
    """Write the positions reached, each with its dexterity, to a ``.csv`` or ``.ply`` file.

    CSV has the columns x, y, z, nu (the mean over the orientations reached there) and share (of the orientations).
    PLY is text, with nu and a colour for each vertex: dark where nu is least, yellow where it is greatest.

    Args:
        workspace: The workspace.
        path: The file; its ending says which of the two.
        metres: The unit of length to write in, m: 0.001 for mm.

    Raises:
        InvalidSetting: Another ending, or an unknown unit.
        CannotWrite: The file cannot be written.
    """
    if not 0.0 < metres < np.inf:
        raise InvalidSetting(f"the unit of length is above zero m, got {metres:g}")
    path = points_file(path)
    there = np.argwhere(workspace.reached.any(axis=-1))
    states = workspace.reached[tuple(there.T)]  # (r, o)
    nu = workspace.nu[tuple(there.T)].sum(axis=-1) / states.sum(axis=-1)
    rows = np.column_stack((workspace.position_of(there) / metres, nu, states.mean(axis=-1)))
    if path.suffix.lower() == ".csv":
        np.savetxt(path, rows, "%.9g", ",", header="x,y,z,nu,share", comments="")
    else:
        path.write_text(_ply(rows), encoding="ascii", newline="\n")
    return path


@checked
def points_file(path: str | Path) -> Path:
    """The path of a file of points that can be written.

    Raises:
        InvalidSetting: Its ending is none of these.
        CannotWrite: It cannot be written.
    """
    if Path(path).suffix.lower() not in FORMATS:
        raise InvalidSetting(f"points of a workspace are written as {' or '.join(FORMATS)}, got {str(path)!r}")
    return writable(path)


def _ply(rows: Array) -> str:
    nu = rows[:, 3]
    share = (nu - nu.min()) / max(float(np.ptp(nu)), 1e-12)
    colours = np.rint(LOW + share[:, None] * (HIGH - LOW)).astype(int)
    head = ["ply", "format ascii 1.0", f"element vertex {len(rows)}"]
    head += [f"property float {name}" for name in ("x", "y", "z", "nu")]
    head += [f"property uchar {name}" for name in ("red", "green", "blue")]
    points = [
        f"{x:.9g} {y:.9g} {z:.9g} {value:.9g} {r} {g} {b}"
        for (x, y, z, value), (r, g, b) in zip(rows[:, :4].tolist(), colours.tolist(), strict=True)
    ]
    return "\n".join([*head, "end_header", *points, ""])
