"""How far a chain can reach at most and at least: a proof that some targets have no solution.

Put a knot K_i on the axis of each rotating joint i. The axis does not move when its joint turns, so the distance
l_i = |K_i K_i+1| does not depend on the configuration (up to the travel of sliding joints between, which widens it to
l_i +- s_i). By the triangle inequality the distance D from the first knot K_1 to the last K_m satisfies

    D <= sum_i (l_i + s_i)
    D >= max_i (l_i - s_i) - sum_(j != i) (l_j + s_j)

in every configuration. The knots may lie anywhere on their axes; they are put where the sum is least. Of a position
K_m is the target point. Of a whole pose it is the last knot, which the pose places, and the last link drops out: for
an arm with a spherical wrist D is the distance of the wrist from the shoulder.

The inequalities hold for real numbers and orthonormal rotations. Rounding, and placements that are not quite rotations,
widen the bounds, so that they stay a proof: see ``_widening`` and ``misshape``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.kinematics.kernel.layout import COLUMN, ROTATES, ROUNDING, SCALE, SHIFT
from pin_metaik.kinematics.limits import Limits
from pin_metaik.kinematics.paths import ChainArrays, matrix_of

DIGITS = 64.0 * float(np.finfo(float).eps)  # of a sum of a few products, for each joint
SWEEPS = 50


@dataclass(frozen=True)
class Link:
    """From knot u on one axis (u z) to knot v on the next: offset + v axis - u z, known up to ``slack`` (m)."""

    offset: NDArray[np.float64]
    axis: NDArray[np.float64]
    slack: float


@dataclass(frozen=True)
class Reach:
    """Bounds on the distance between a point fixed to the world and one fixed to the tip.

    Attributes:
        anchor: (3,) the world point.
        end: (3,) the tip's point, in the tip frame.
        least: m.
        most: m.
    """

    anchor: NDArray[np.float64]
    end: NDArray[np.float64]
    least: float
    most: float

    def moved(self, move: NDArray[np.float64]) -> Reach:
        """The same bounds for a chain moved as a whole by (4, 4)."""
        anchor = move[:3, :3] @ self.anchor + move[:3, 3]
        rounding = DIGITS * float(np.linalg.norm(anchor))
        return Reach(anchor, self.end, max(0.0, self.least - rounding), self.most + rounding)

    @property
    def array(self) -> NDArray[np.float64]:
        """(8,) all of it, as the compiled loops take it."""
        return np.array([*self.anchor, *self.end, self.least, self.most])

    def gap(self, pose: pin.SE3, distance: float = 0.0, angle: float = 0.0) -> float:
        """How far (m) every configuration is from a pose, at least; 0 proves nothing.

        Args:
            pose: World pose of the target.
            distance: How far from it the tip may be, m.
            angle: By how much it may be turned, rad; ``inf`` when bounds are for the position alone.
        """
        span = float(np.linalg.norm(pose.act(self.end) - self.anchor))
        lever = float(np.linalg.norm(self.end))
        allowed = ROUNDING + distance + (lever * (angle + misshape(pose.rotation)) if lever else 0.0)
        return max(0.0, span - self.most - allowed, self.least - span - allowed)


def misshape(rotation: NDArray[np.float64]) -> float:
    """By how much (relative) a rotation (3, 3) may stretch a vector: |R'R - I|."""
    return float(np.linalg.norm(rotation.T @ rotation - np.eye(3)))


def reach_of(paths: ChainArrays, limits: Limits, tip: int, oriented: bool) -> Reach:
    """Bounds for one tip; ``oriented`` says that targets fix all of the orientation, not only the position."""
    links, last, closing = links_of(paths, limits.lower, limits.upper, tip)
    if not links:  # nothing turns: a gantry
        return Reach(last.offset, np.zeros(3), 0.0, last.slack + _widening(paths, tip, [last], np.zeros(1)))
    # Knot i is on axis i; link 0 only places the first axis in the world.
    spanning = links[1:] if oriented else [*links[1:], last]
    knots, spans = tightened(spanning, len(links))
    slack = links[0].slack + last.slack + sum(link.slack for link in links[1:])
    slack += _widening(paths, tip, [*links, last], knots)
    most = float(spans.sum()) + slack
    least = max(0.0, 2.0 * float(spans.max(initial=0.0)) - float(spans.sum()) - slack)
    end = closing[:3, :3].T @ (np.array([0.0, 0.0, knots[-1]]) - closing[:3, 3]) if oriented else np.zeros(3)
    return Reach(links[0].offset + knots[0] * links[0].axis, end, least, most)


def _widening(paths: ChainArrays, tip: int, links: list[Link], knots: NDArray[np.float64]) -> float:
    """The most (m) by which rounding, and placements that are not quite rotations, change the sum of the links."""
    size = 2.0 * float(np.abs(knots).sum()) + sum(float(np.linalg.norm(link.offset)) + link.slack for link in links)
    rows = [*paths.joints[paths.ends[tip] : paths.ends[tip + 1]], paths.tips[tip]]
    stretch = sum(misshape(matrix_of(row)[:3, :3]) for row in rows)
    return size * (DIGITS * len(rows) + stretch)


def tightened(links: list[Link], count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Knots (count,) that make the links' total length least, and those lengths; any knots would give a true bound.

    A sum of Euclidean norms, minimised by iteratively reweighted least squares (Weiszfeld 1937).
    """
    A = np.zeros((len(links), 3, count))
    b = np.array([link.offset for link in links]).reshape(-1, 3)
    for i, link in enumerate(links):
        A[i, 2, i] = -1.0
        if i + 1 < count:
            A[i, :, i + 1] = link.axis
    knots = np.zeros(count)
    lengths = np.linalg.norm(b, axis=1)
    for sweep in range(SWEEPS):  # the floor falls slowly: a link that is short too early would stay so
        weights = (1.0 / np.sqrt(np.maximum(lengths, 0.7**sweep)))[:, None]
        knots = np.linalg.lstsq((weights[:, None] * A).reshape(-1, count), -(weights * b).ravel(), rcond=1e-9)[0]
        lengths = np.linalg.norm(A @ knots + b, axis=1)
    return knots, lengths


def links_of(
    paths: ChainArrays, lower: NDArray[np.float64], upper: NDArray[np.float64], tip: int
) -> tuple[list[Link], Link, NDArray[np.float64]]:
    """The link before each rotating joint, the one from the last to the tip, and that one's placement (4, 4).

    ``lower`` and ``upper`` (n,) are the limits of the coordinates.
    """
    links = []
    placement = np.eye(4)
    travel = np.zeros(3)
    slack = 0.0
    for s in range(paths.ends[tip], paths.ends[tip + 1]):
        row, column, rotates = paths.joints[s], paths.wiring[s, COLUMN], paths.wiring[s, ROTATES]
        placement = placement @ matrix_of(row)
        if rotates:
            links.append(Link(placement[:3, 3] + travel, placement[:3, 2], slack))
            placement, travel, slack = np.eye(4), np.zeros(3), 0.0
        else:
            ends = row[SCALE] * np.array([lower[column], upper[column]]) + row[SHIFT]
            if np.isfinite(ends).all():
                travel = travel + ends.mean() * placement[:3, 2]
            slack += 0.5 * float(abs(ends[1] - ends[0]))  # infinite without limits: then nothing bounds the reach
    placement = placement @ matrix_of(paths.tips[tip])
    placement[:3, 3] += travel
    return links, Link(placement[:3, 3], np.zeros(3), slack), placement
