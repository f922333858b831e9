"""How far an arm may be from the one its closed form describes: what a proof adds to the tolerances."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import H1, H2, H3, H4, H6, O1, O1_O2, O4_O5, SIDE_2
from pin_metaik.kinematics.paths import ChainArrays, matrix_of

Floats = NDArray[np.float64]


def ideal(form: Floats) -> Floats:
    """A closed form (16, 3) with axes 3 and, of three parallel ones, 4 parallel to axis 2 to the last digit."""
    exact = form.copy()
    exact[H3] = np.copysign(1.0, form[H2] @ form[H3]) * form[H2]
    if form[SIDE_2] != 0.0:
        exact[H4] = form[SIDE_2] * form[H2]
    return exact


def deviation(paths: ChainArrays, form: Floats) -> tuple[float, float]:
    """By how much (m, rad) the tip of an arm of six joints may differ from its closed form's, in any configuration.

    The two agree where all angles are 0. Turning about an axis that is off by a (rad), through a point that is off by e
    (m), errs by 2 a in orientation and by 2 e + 2 a times the lever in place, at most; the six add up.
    """
    axes, points = np.empty((6, 3)), np.empty((6, 3))
    placement = np.eye(4)
    for i, row in enumerate(paths.joints):
        placement = placement @ matrix_of(row)
        axes[i], points[i] = placement[:3, 2], placement[:3, 3]
    tip = (placement @ matrix_of(paths.tips[0]))[:3, 3]
    ways = np.concatenate([np.zeros((1, 3)), np.cumsum(form[O1_O2 : O4_O5 + 1], axis=0)])
    meant = form[O1] + ways[[0, 1, 2, 3, 4, 4]]
    off = np.linalg.norm(np.cross(axes, points - meant), axis=1)
    tilt = np.linalg.norm(axes - form[H1 : H6 + 1], axis=1)
    reach = np.linalg.norm(np.diff([*meant[:5], tip], axis=0), axis=1).sum() + off.sum()
    return float((2.0 * off + 2.0 * tilt * reach).sum()), float(2.0 * tilt.sum())
