"""Where a scene is seen from, in a window of any shape."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.gui.tab import Tab

FIELD = math.radians(45.0)  # of view, from top to bottom


def aim(tab: Tab, eye: ArrayLike, centre: ArrayLike) -> None:
    """Look at a place from another, z going up; from farther away in a window that is taller than wide.

    Args:
        tab: The tab.
        eye: (3,) where to look from, m.
        centre: (3,) where to look at, m.
    """
    camera = tab.client.camera
    there = np.asarray(centre, dtype=float)
    away = max(1.0, 1.0 / camera.aspect)
    camera.fov = FIELD
    camera.up_direction = (0.0, 0.0, 1.0)
    camera.position = tuple(there + away * (np.asarray(eye, dtype=float) - there))
    camera.look_at = tuple(there)
