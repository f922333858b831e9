"""How much room pairs of bodies have: bounds that cost next to nothing, and nearest points where these do not do."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision.checker import ENCLOSED, Checker
from pin_metaik.collision.covers import Covers
from pin_metaik.collision.solids import Placed
from pin_metaik.collision.travel import Travel

STALE = 0.2  # of a distance, by which what is known of it may be less until it is measured again
INFLUENCE = 0.1  # m; bodies farther apart beyond their margin do not slow anything down
ROUNDING = 1e-6  # m

Pair: TypeAlias = tuple[int, int, int]


class Near(NamedTuple):
    """The pairs of bodies near a configuration.

    Attributes:
        pairs: (p, 3) numbers of both bodies, and the row among the pairs that move or -1.
        rooms: (p,) distances beyond their margins that they have at least, m.
        travel: (p,) by how much they may come nearer, m.
        rows: (p, 10) unit vector from the first to the second, nearest point of either, and their distance along it
            beyond the margin, nearly; NaN where two surfaces cross.
    """

    pairs: NDArray[np.int64]
    rooms: NDArray[np.float64]
    travel: NDArray[np.float64]
    rows: NDArray[np.float64]


class Rooms:
    """The distances of the pairs of a world's bodies, from one tick to the next.

    Nearest points are searched for once; where they are then, and the direction between them, tell for many ticks how
    far the two bodies are apart at least (see ``parting``). Where these are of no use, as for concave bodies, it is the
    distance that was measured, less what the two have moved since.

    Attributes:
        checker: The checks.
    """

    def __init__(self, checker: Checker) -> None:
        from pin_metaik.collision.parting import part_all, survey

        self.checker, self._covers = checker, Covers.of(checker)
        solids, own = checker.solids, checker.asked.own
        self._own, self._moving, self._standing = len(own), len(solids.moving), len(solids.standing)
        self._taken = self._margins() + ENCLOSED
        self._hints = np.zeros((len(self._taken), 12))
        self._known = np.full((len(self._taken), 2), -np.inf)
        self._own_gone, self._body_gone = np.zeros(self._own), np.zeros(self._moving)
        self._survey, self._part = cast(Any, survey).compiled(), cast(Any, part_all).compiled()

    def went(self, travel: Travel) -> None:
        """The joints have moved, and the bodies at most by so much."""
        self._own_gone += travel.reaches
        self._body_gone += travel.moved[:, 0]

    def forget(self) -> None:
        """Something else has moved: what was measured says nothing any more."""
        self._known[:] = -np.inf

    def near(self, placed: Placed, travel: Travel, spare: float) -> Near:
        """The pairs that are within ``INFLUENCE``, or that may come within ``spare`` (m), of those placed."""
        found = np.array(travel.near(placed, max(INFLUENCE, spare)), dtype=np.int64).reshape(-1, 3)
        pairs, rooms, rows = np.empty_like(found), np.empty((len(found), 4)), np.empty((len(found), 10))
        count = self._survey(
            placed.poses[: self._moving], *self._covers, self._hints, self._taken, found, placed.least[: len(found)],
            travel.reaches, travel.moved, self._known, self._own_gone, self._body_gone, INFLUENCE, spare, STALE,
            pairs, rooms, rows,
        )  # fmt: skip
        pairs, rooms, rows = pairs[:count], rooms[:count], rows[:count]
        rows[:, 9] = rooms[:, 2]
        for r in np.flatnonzero(rooms[:, 3]).tolist():
            rooms[r, 0] = self._measure(placed, tuple(pairs[r].tolist()), spare, rows[r])
        return Near(pairs, rooms[:, 0], rooms[:, 1], rows)

    def least(self, placed: Placed, pairs: NDArray[np.int64], enough: NDArray[np.float64]) -> NDArray[np.float64]:
        """Room (p,) that pairs (p, 3) have at least where they are placed, m, without a search for nearest points.

        Args:
            placed: The bodies.
            pairs: (p, 3).
            enough: (p,) m; once a pair is found to have so much, no more is looked for.
        """
        rooms = np.empty(len(pairs))
        poses = placed.poses[: self._moving]
        self._part(poses, *self._covers, self._own, pairs, self._hints, self._taken, enough, rooms)
        return rooms

    def _measure(self, placed: Placed, pair: Pair, needed: float, row: NDArray[np.float64]) -> float:
        """The room of a pair where it is placed now; its nearest points go into ``row`` (10,)."""
        i, j, k = pair
        number = k if k >= 0 else self._own + i * self._standing + j - self._moving
        room, normal = self.checker.room(placed, i, j, k, needed), placed.normal
        first, second = placed.points
        if not 0.5 < float(normal @ normal) < 2.0 and room > ROUNDING:  # meshes have none
            normal = second - first
        length, hint = float(np.linalg.norm(normal)), self._hints[number]
        if length > ROUNDING:
            normal = normal / length
            (A, a), (B, b) = self._frame(placed, i), self._frame(placed, j)
            hint[:3], hint[3:6], hint[6:9], hint[9:] = normal @ A, normal @ B, (first - a) @ A, (second - b) @ B
            row[:3] = normal
        else:  # surfaces that cross have none either way
            row[:3], hint[:] = np.nan, 0.0
        row[3:6], row[6:9], row[9] = first, second, room
        self._known[number] = room, self._own_gone[k] if k >= 0 else self._body_gone[i]
        return room

    def _frame(self, placed: Placed, body: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rotation (3, 3) and place (3,) of a body; of what stands the world's, in which its cover is."""
        if body >= self._moving:
            return np.eye(3), np.zeros(3)
        pose = placed.poses[body]
        return pose[:9].reshape(3, 3).T, pose[9:]

    def _margins(self) -> NDArray[np.float64]:
        """(N,) the distances at or below which the pairs collide, m."""
        checker, against = self.checker, np.full((self._moving, self._standing), self.checker.asked.margin)
        if checker.padding.by:
            for i, j in zip(*np.nonzero(checker.asked.against), strict=True):
                against[i, j] = checker.margin_of(int(i), self._moving + int(j), -1)
        return np.concatenate([checker.asked.margins, against.ravel()])
