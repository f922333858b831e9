"""The tip of the RV-7FL paper's arm: a real problem small enough for tests. Lengths in mm, angles in rad."""

from __future__ import annotations

import numpy as np

from pin_metaik.compare.papers.rv7fl_setup import TARGETS
from pin_metaik.optimize import Box

TABLE = [
    (400, 0, 90),
    (435, -50, 0),
    (470, 0, 90),
    (85, 0, 90),
    (0, 0, 90),
    (0, 0, 0),
]  # standard DH: d, a, alpha in deg
LIMITS = np.deg2rad([(-240, 240), (-110, 130), (0, 162), (-200, 200), (-120, 120), (-360, 360)])
BOX = Box(*LIMITS.T)


def tip(Q):
    """Tip positions (k, 3) by the DH product, the last joint first: p <- Rz(theta) (Tz(d) Tx(a) Rx(alpha) p)."""
    p = np.zeros((len(Q), 3))
    for theta, (d, a, alpha) in zip(Q.T[::-1], TABLE[::-1], strict=True):
        ca, sa, c, s = np.cos(np.deg2rad(alpha)), np.sin(np.deg2rad(alpha)), np.cos(theta), np.sin(theta)
        x, y, z = a + p[:, 0], ca * p[:, 1] - sa * p[:, 2], d + sa * p[:, 1] + ca * p[:, 2]
        p = np.stack((c * x - s * y, s * x + c * y, z), axis=1)
    return p


def miss(case: int):
    """The paper's F (Eq. 27) for one of its cases: distance of the tip to the target, in mm."""
    target = np.array(TARGETS[f"Case {case}"])
    return lambda Q: np.linalg.norm(tip(Q) - target, axis=1)
