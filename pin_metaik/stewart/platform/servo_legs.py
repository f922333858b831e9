"""Legs moved by servos: a horn on a shaft, and a rod of fixed length between its tip and the platform joint.

The shaft of leg i stands in the base joint b_i along a unit axis a_i, and its horn of length h points along u_i at
angle 0, along u_i cos(q) + w_i sin(q) at angle q, with w_i = a_i x u_i. A rod of length l reaches a platform joint at
v_i from b_i if h^2 + |v_i|^2 - 2 h (u_i'v_i cos q + w_i'v_i sin q) = l^2: with r and phi the polar coordinates of v_i
in the plane of the horn,

    q = phi -+ arccos(c / r),   c = (|v_i|^2 + h^2 - l^2) / (2 h),

one angle for each branch. Where |c| > r the rod is too short or too long (Eisele 2019 for axes in the base plane).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.stewart.platform.actuation import Links, Words
from pin_metaik.stewart.platform.servos import Servos, each


@dataclass(frozen=True)
class ServoLegs:
    """Legs that end in the rods of servos.

    Attributes:
        servos: What moves them.
    """

    servos: Servos

    words = Words("servos", "angle", "servo angles", "lowest, highest", "horn joints", ("a", "w"))

    @property
    def upright(self) -> Array:
        """Square to the horn: the way it moves on branch +1, and the other way on -1, where rods are pulled."""
        return np.column_stack([np.zeros(self.servos.legs), each(self.servos, "branches"), np.zeros(self.servos.legs)])

    def span(self) -> tuple[float, float]:
        """Least and greatest distance between a shaft and a platform joint, m."""
        horn, rod = each(self.servos, "horn"), each(self.servos, "rod")
        return float(np.abs(rod - horn).min()), float((rod + horn).max())

    def links(self, b: Array, v: Array) -> Links:
        """The servos' angles on their branches, the tips of their horns and the rods."""
        horn, rod, branch = (each(self.servos, name) for name in ("horn", "rod", "branches"))
        x, y, along = (np.einsum("nc,knc->kn", self.servos.frames[:, row], v) for row in range(3))
        r = np.hypot(x, y)
        phi = np.arctan2(y, x)
        c = (r**2 + along**2 + horn**2 - rod**2) / (2.0 * horn)  # r cos(phi - q)
        missing = np.where(c > r, np.hypot(along, r - horn) - rod, np.where(c < -r, np.hypot(along, r + horn) - rod, 0))
        sine = np.sqrt(np.maximum((r - c) * (r + c), 0.0))  # r sin(phi - q), but for its sign
        q = phi - branch * np.arctan2(sine, c)
        closed = missing == 0.0
        q = np.where(closed, (q + np.pi) % (2.0 * np.pi) - np.pi, np.nan)
        cos, sin = (np.where(closed, value, 0.0) for value in (np.cos(q), np.sin(q)))
        nearest = np.where(missing < 0.0, -1.0, 1.0)  # towards the joint, or away from it
        cos, sin = np.where(closed, cos, nearest * np.cos(phi)), np.where(closed, sin, nearest * np.sin(phi))
        tips = horn[:, None] * (cos[..., None] * self.servos.frames[:, 0] + sin[..., None] * self.servos.frames[:, 1])
        transmission = np.where(closed, sine / rod, np.nan)
        return Links(q, b + tips, v - tips, branch * horn * transmission, transmission, missing)

    def can_be(self, q: Array) -> NDArray[np.bool_]:
        """Angles are any finite numbers."""
        return np.isfinite(q)

    def held(self, b: Array, q: Array) -> tuple[Array, Array]:
        """From the tips of the horns, as long as the rods."""
        horn = each(self.servos, "horn")[:, None]
        tips = horn * (
            np.cos(q)[..., None] * self.servos.frames[:, 0] + np.sin(q)[..., None] * self.servos.frames[:, 1]
        )
        return b + tips, np.broadcast_to(each(self.servos, "rod"), q.shape)

    def in_first_joint(self, links: Links) -> Array:
        """Rods along the horn, the way it moves, and along the axis."""
        u, w, a = (self.servos.frames[:, row] for row in range(3))
        cos, sin = np.cos(links.coordinates)[..., None], np.sin(links.coordinates)[..., None]
        rods = links.vectors / np.linalg.norm(links.vectors, axis=-1, keepdims=True)
        horns = np.stack((cos * u + sin * w, cos * w - sin * u, np.broadcast_to(a, rods.shape)), axis=-2)
        directions: Array = np.einsum("knrc,knc->knr", horns, rods)
        return directions
