"""The parameters of a closed form of an arm's inverse kinematics: which axes meet and which are parallel.

Two kinds of arms of six turning joints have the same one (see ``kernel.closed_form``): those with a wrist whose three
axes meet behind two parallel ones, like most industrial arms, and those with three parallel axes and two that meet,
like Universal Robots' arms.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import COLUMN, POSE, ROTATES
from pin_metaik.kinematics.paths import ChainArrays, matrix_of

CLOSE = 1e-6  # m or rad: axes this near to each other meet, or are parallel; a descent removes the error that leaves
NOMINAL = 5e-3  # ... of an arm that was measured: its closed form no longer solves, but still proves

Floats = NDArray[np.float64]


def closed_form(paths: ChainArrays, close: float = CLOSE) -> Floats:
    """The closed form (16, 3), or no rows (0, 3) for an arm of neither kind; ``kernel.layout`` names its rows.

    ``close`` (m or rad) is how near axes meet, or are parallel. The rows, in the configuration where all angles are 0,
    in the world frame unless said otherwise:

    * 0 to 5: the axes.
    * 6: a point O1 on axis 1; 7 to 10: the ways from there to O2, O3, O4 and O5, where the last axes meet; of a wrist
      with three axes O4 is O5.
    * 11: from O5 to the tip, 12: axis 6, both in the tip frame; 13 and 14: a direction across axis 6, in the tip frame
      and in the world frame.
    * 15: how far it is from O1 to O5 along axis 2, and, of three parallel axes, whether axes 2 and 3 point as axis 4
      does (1) or the other way (-1); else 0.
    """
    none = np.zeros((0, 3))
    single = len(paths.ends) == 2 and len(paths.joints) == 6 and len(set(paths.wiring[:, COLUMN].tolist())) == 6
    if not single or not (paths.wiring[:, ROTATES] == 1).all() or not (paths.joints[:, POSE:] == [1.0, 0.0]).all():
        return none
    frames = np.empty((7, 4, 4))
    placement = np.eye(4)
    for i, row in enumerate([*paths.joints, paths.tips[0]]):
        placement = frames[i] = placement @ matrix_of(row)
    axes, points = frames[:6, :3, 2], frames[:6, :3, 3].copy()
    wrist = _meeting(axes[4:], points[4:], close)
    if wrist is None or not _parallel(axes[1], axes[2], close):
        return none
    points[4] = wrist
    sides = np.zeros(2)
    if _parallel(axes[1], axes[3], close):
        sides = np.round(axes[1:3] @ axes[3])
    elif np.linalg.norm(np.cross(wrist - points[3], axes[3])) < close:
        points[3] = wrist
    else:
        return none
    rotation, position = frames[6, :3, :3], frames[6, :3, 3]
    across = np.linalg.svd(axes[5][None])[2][1]
    ways = np.diff(points[:5], axis=0)
    to_tip = [position - wrist, axes[5], across] @ rotation  # seen from the tip
    level = axes[1] @ ways.sum(axis=0)
    return np.array([*axes, points[0], *ways, *to_tip, across, [level, *sides]])


def _parallel(a: Floats, b: Floats, close: float) -> bool:
    return bool(np.linalg.norm(np.cross(a, b)) < close)


def _meeting(axes: Floats, points: Floats, close: float) -> Floats | None:
    """Where two axes (2, 3) through two points (2, 3) meet, if they do."""
    if _parallel(axes[0], axes[1], close):
        return None
    ways = np.stack([axes[0], -axes[1]], axis=1)
    along, *_ = np.linalg.lstsq(ways, points[1] - points[0], rcond=None)
    near = points + along[:, None] * axes
    met: Floats = near.mean(axis=0)
    return met if np.linalg.norm(near[0] - near[1]) < close else None
