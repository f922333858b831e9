"""The shortest curve between two poses for a vehicle with a least turning radius."""

from __future__ import annotations

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile.curves.curve import Curve, Pose
from pin_metaik.mobile.curves.words import dubins_words, reeds_shepp_words

PIECES = 5  # of the longest word


@checked
def shortest_curve(start: Pose, goal: Pose, turning_radius: float, *, reverse: bool = False) -> Curve:
    """The shortest curve between two poses with at least the given turning radius, in a plane without obstacles.

    It ends at the goal to about 1e-9 m and rad: arcs shorter than that are left out.

    Args:
        start: (x, y, heading) in m and rad.
        goal: (x, y, heading).
        turning_radius: Least radius of the vehicle, m.
        reverse: Whether it may also drive backwards: the shortest of the 48 words of Reeds and Shepp (1990) instead of
            the six of Dubins (1957).

    Raises:
        InvalidSetting: A malformed pose, or a radius not above zero.
    """
    turning(turning_radius)
    a, b = (array(name, pose, 3)[None] for name, pose in (("start", start), ("goal", goal)))
    word, lengths = shortest_words(a, b, turning_radius, reverse)
    return curve_of(start, turning_radius, word[0], lengths[0])


def shortest_words(starts: Array, goals: Array, radius: float, reverse: bool) -> tuple[np.ndarray, Array]:
    """The words (n,) and signed lengths (n, 5), m, of the shortest curves from poses to poses (n, 3)."""
    dx, dy = ((goals - starts)[:, :2] / radius).T
    cos, sin = np.cos(starts[:, 2]), np.sin(starts[:, 2])
    x, y, phi = cos * dx + sin * dy, cos * dy - sin * dx, goals[:, 2] - starts[:, 2]
    best = np.full(len(starts), np.inf)
    word, lengths = np.full(len(starts), "", dtype=object), np.zeros((len(starts), PIECES))
    with np.errstate(invalid="ignore"):
        for letters, found in (reeds_shepp_words if reverse else dubins_words)(x, y, phi):
            total = np.sum(np.abs(found), axis=0)
            better = total < best
            best[better], word[better] = total[better], letters
            lengths[better] = 0.0
            lengths[better, : len(found)] = np.transpose(found)[better]
    return word, radius * lengths


def curve_of(start: Pose, radius: float, word: str, lengths: Array) -> Curve:
    """The curve of a word, without the pieces that have no length."""
    kept = [(letter, float(length)) for letter, length in zip(word, lengths, strict=False) if length]
    return Curve(start, radius, "".join(letter for letter, _ in kept), tuple(length for _, length in kept))


def turning(radius: float) -> None:
    """Make sure that a radius is one that a vehicle can turn with.

    Raises:
        InvalidSetting: It is not above zero.
    """
    if not 0 < radius < np.inf:
        raise InvalidSetting(f"turning_radius is a finite length above 0, got {radius!r}")
