"""A curve of arcs of one radius and straight lines, driven forwards or backwards."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as File

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.motion.trajectory import Moved
from pin_metaik.optimize.settings import MANY
from pin_metaik.output import write_table

Pose = tuple[float, float, float]

BENDS = {"L": 1.0, "S": 0.0, "R": -1.0}
STEP = 0.05  # m


@checked
@dataclass(frozen=True)
class Curve:
    """Arcs to the left (L) and right (R) and straight lines (S), one after the other.

    Attributes:
        start: Pose (x, y, heading) in m and rad.
        radius: Radius of the arcs, m.
        word: Kinds of the pieces, e.g. ``"LSR"``.
        lengths: Lengths of the pieces, m; negative if driven backwards.

    Raises:
        InvalidSetting: A radius that is not above zero, or lengths that do not fit the word.
    """

    start: Pose
    radius: float
    word: str
    lengths: tuple[float, ...]

    def __post_init__(self) -> None:
        array("start", self.start, 3)
        array("lengths", self.lengths, len(self.word))
        if not 0 < self.radius < np.inf or not set(self.word) <= set(BENDS):
            raise InvalidSetting(
                f"a curve has a radius above 0 and a word of L, S and R, got {self.radius!r} and {self.word!r}"
            )

    @property
    def length(self) -> float:
        """Length of the curve, m, whichever way it is driven."""
        return float(np.abs(self.lengths).sum())

    @property
    def end(self) -> Pose:
        """Pose (x, y, heading) at the end, in m and rad."""
        x, y, heading = self._knots[-1].tolist()
        return x, y, heading

    @property
    def cusps(self) -> Array:
        """Places (c,) along the curve, in m, where it changes between forwards and backwards."""
        driven = np.array(self.lengths)[np.array(self.lengths) != 0.0]
        return np.asarray(np.cumsum(np.abs(driven))[:-1][np.diff(np.sign(driven)) != 0])

    @property
    def boundaries(self) -> Array:
        """Places (p + 1,) along the curve, in m, where pieces begin and the last ends."""
        return np.concatenate(([0.0], np.cumsum(np.abs(self.lengths))))

    @checked
    def poses(self, s: ArrayLike) -> Array:
        """Poses (n, 3) at arc lengths s (n,), in m; x, y in m and the heading in rad."""
        places = np.clip(np.atleast_1d(array("s", s, "...")).ravel(), 0.0, self.length)
        if not self.word:
            return np.tile(self.start, (len(places), 1))
        begins = self.boundaries
        k = np.clip(np.searchsorted(begins, places, side="right") - 1, 0, len(self.word) - 1)
        signs = np.sign(self.lengths)
        return _moved(self._knots[k], self._bends[k], signs[k] * (places - begins[k]))

    @checked
    def moved(self, a: Array, b: Array) -> Moved:
        """Bound (n,), m, on how far positions between arc lengths a and b (n,) are from the one in the middle."""
        a = array("a", a, "n")
        half = (array("b", b, len(a)) - a) / 2
        return Moved(half, half / self.radius)

    @checked
    def write(self, file: str | File, step: float = STEP) -> None:
        """Write s, x, y and heading as CSV, at equal distances (m) and where pieces begin."""
        s = self.places(step)
        write_table(file, ("s", "x", "y", "heading"), np.column_stack((s, self.poses(s))))

    @checked
    def places(self, step: float = STEP) -> Array:
        """Arc lengths (n,), in m, at equal distances and where pieces begin and end."""
        if not step > 0 or self.length > MANY * step:
            raise InvalidSetting(
                f"step is above 0 m and makes at most {MANY:,} places on {self.length:g} m, got {step!r}"
            )
        return np.union1d(np.arange(0.0, self.length, step), self.boundaries)

    @cached_property
    def _bends(self) -> Array:
        """Curvature of each piece (p,), 1/m."""
        return np.array([BENDS[letter] for letter in self.word]) / self.radius

    @cached_property
    def _knots(self) -> Array:
        """Poses (p + 1, 3) where pieces begin, and at the end."""
        poses = [np.array(self.start, dtype=float)]
        for bend, length in zip(self._bends, self.lengths, strict=True):
            poses.append(_moved(poses[-1][None], np.array([bend]), np.array([length]))[0])
        return np.array(poses)


def _moved(poses: Array, bends: Array, s: Array) -> Array:
    """Poses (n, 3) a way s (n,), below zero backwards, further with curvatures (n,)."""
    x, y, heading = poses.T
    turn = bends * s
    chord = s * np.sinc(turn / 2 / np.pi)  # 2 r sin(turn / 2)
    middle = heading + turn / 2
    return np.column_stack((x + chord * np.cos(middle), y + chord * np.sin(middle), heading + turn))


def joined(curves: list[Curve]) -> Curve:
    """One curve of several that follow each other."""
    word = "".join(curve.word for curve in curves)
    return Curve(curves[0].start, curves[0].radius, word, tuple(s for curve in curves for s in curve.lengths))
