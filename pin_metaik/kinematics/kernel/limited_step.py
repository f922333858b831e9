"""A step of damped least squares with the limits inside it, in NumPy: what ``descent.step`` does, to be read."""

from __future__ import annotations

import numpy as np

from pin_metaik.kinematics.kernel.layout import Floats


def limited_step(x: Floats, r: Floats, J: Floats, lower: Floats, upper: Floats, damping: float) -> Floats:
    """The next x (n,) for a residual r (m,) and its Jacobian J (m, n): least squares over the joints that can move.

    Joints that are at a limit and pushed outward are held. Those that would cross a limit go onto it, and the step is
    solved again for the others.
    """
    H, slope = damping * np.eye(len(r)), J.T @ r
    held = ((x <= lower) & (slope > 0.0)) | ((x >= upper) & (slope < 0.0))  # at a limit and pushed outward
    J = np.where(held, 0.0, J)
    dx = -J.T @ np.linalg.solve(J @ J.T + H, r)
    crossing = ~held & ((x + dx < lower) | (x + dx > upper))
    if crossing.any():  # those go onto their limits, and the others make up for it
        onto = np.where(crossing, np.clip(x + dx, lower, upper) - x, 0.0)
        free = np.where(crossing, 0.0, J)
        dx = onto - free.T @ np.linalg.solve(free @ free.T + H, r + J @ onto)
    limited: Floats = np.minimum(np.maximum(x + dx, lower), upper)
    return limited
