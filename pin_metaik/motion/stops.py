"""Whether a robot that brakes stops before anything collides: by distances, and bounds on how far bodies go."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.collision.solids import Placed
from pin_metaik.collision.travel import Travel
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.joints import leader_of, parts_of
from pin_metaik.motion.rooms import INFLUENCE, Rooms
from pin_metaik.motion.screws import ChainScrews

DAMPING = 4.0  # 1/s; speed of approach that a metre of distance beyond the clearance allows
SHRINKING = 0.5  # of the distance that is left within the clearance, what must be left when the robot stands
LOOKS = 4  # times that a braking motion is cut in two


class Surroundings(NamedTuple):
    """What is near a configuration.

    Attributes:
        pairs: (p, 3) pairs of bodies that may matter: their numbers, and the row among the pairs that move or -1.
        rooms: (p,) distances beyond their margins that they have at least, m.
        travel: (p,) by how much they may come nearer until the robot stands, m.
        joints: (J, 12) where the joints are.
        near: (k, 10) and ``carriers`` (k, 2): the pairs within ``INFLUENCE``, as ``kernel.aim`` takes them.
    """

    pairs: NDArray[np.int64]
    rooms: NDArray[np.float64]
    travel: NDArray[np.float64]
    joints: NDArray[np.float64]
    near: NDArray[np.float64]
    carriers: NDArray[np.int64]


class Moment(NamedTuple):
    """A moment of a braking motion.

    Attributes:
        tick: After so many ticks.
        joints: (J, 12) where the joints are.
        rooms: (p,) of the pairs in question, m.
    """

    tick: float
    joints: NDArray[np.float64]
    rooms: NDArray[np.float64]


class Stops:
    """What a chain's robot has around it, and whether it can stop there.

    Two bodies that are farther apart than they can come nearer in a motion (see ``Travel``), the distances at its two
    ends added up, do not touch in between; and what cannot be told so is looked at in the middle. Nearest points are
    searched for only where what is known already (see ``Rooms``) does not do.

    Attributes:
        chain: The chain.
        world: The world; it may change between two ticks.
        clearance: Distance beyond the margins that is kept when nothing forces it down, m.
        moves: (joints, S) 1 where a row of the chain's paths moves what a joint carries.
    """

    def __init__(self, chain: Chain, world: CollisionWorld, clearance: float) -> None:
        self.chain, self.world, self.clearance = chain, world, clearance
        self.moves = _moves(chain)
        self._others = np.isnan(chain.q(np.zeros(chain.n), np.full(chain.model.nq, np.nan)))  # entries of other joints
        self._at: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        self._lay_out()

    def _lay_out(self) -> None:
        """Begin anew with the world as it is now."""
        carriers = self.world.passages.carriers
        self._checker, self._travel, self._rooms = carriers.checker, Travel(carriers), Rooms(carriers.checker)
        self._screws = ChainScrews(self.chain, carriers.screws)
        self._joint_of = np.array([body.joint for body in self._checker.bodies], dtype=np.int64)
        self._joint_of[len(self._checker.solids.moving) :] = 0

    def around(self, stopping: Stopping) -> Surroundings:
        """Distances, where a braking motion begins, of the pairs that come near, or may until it ends."""
        if self._checker is not self.world.checker:
            self._lay_out()
        placed = self._checker.solids.place(stopping.q0)
        self._went_to(stopping.x, stopping.q0[self._others], placed)
        self._travel.measure(1.0, placed.joints, self._screws.along(stopping.way(0.0, math.inf)))
        near = self._rooms.near(placed, self._travel, self.clearance)
        close = (near.rows[:, 9] < INFLUENCE) & ~np.isnan(near.rows[:, 0])
        rows, carriers = near.rows[close], self._joint_of[near.pairs[close, :2]]
        rows[:, 9] = DAMPING * (rows[:, 9] - self.clearance)
        return Surroundings(near.pairs, near.rooms, near.travel, placed.joints.copy(), rows, carriers)

    def _went_to(self, x: NDArray[np.float64], others: NDArray[np.float64], placed: Placed) -> None:
        """Say how far the bodies have moved at most; forget distances if other joints than the chain's have."""
        if self._at is None or not np.array_equal(others, self._at[1]):
            self._rooms.forget()
        else:
            way = np.abs(self.chain.limits.way(self._at[0], x))
            self._travel.measure(1.0, placed.joints, self._screws.along(way))
            self._rooms.went(self._travel)
        self._at = x, others

    def free(self, around: Surroundings, stopping: Stopping) -> bool:
        """Whether a braking motion is proved free, and ends not much nearer to anything than it begins.

        Args:
            around: What is near where it begins.
            stopping: The motion.
        """
        left = SHRINKING * np.minimum(self.clearance, around.rooms)  # what must be left at its end, m
        pending = np.flatnonzero((around.travel > 0.0) & (around.rooms - around.travel < left))
        if not pending.size:
            return True
        pairs, rooms, left = around.pairs[pending], around.rooms[pending], left[pending]
        travel = self._travels(pairs, around.joints, stopping.way(0.0, math.inf))
        pending = np.flatnonzero((travel > 0.0) & (rooms - travel < left))
        if not pending.size:
            return True
        pairs, rooms, left, travel = pairs[pending], rooms[pending], left[pending], travel[pending]
        left = np.where(rooms > 0.0, left, rooms)  # what collides may part
        placed = self._checker.solids.place(stopping.q(math.inf))
        ends = self._roomy(placed, pairs, left, travel - rooms)
        if ends is None:
            return False
        apart = rooms > 0.0
        begin = Moment(0.0, around.joints, rooms[apart])
        return self._between(stopping, pairs[apart], travel[apart], begin, stopping.ticks, ends[apart])

    def harmless(self, around: Surroundings, stopping: Stopping) -> float:
        """The share of a braking motion that takes no pair more of its distance than it may; at most 1."""
        travel = self._travels(around.pairs, around.joints, stopping.way(0.0, math.inf))
        comes = travel > 0.0
        spare = (1.0 - SHRINKING) * np.maximum(around.rooms[comes], 0.0)
        return float((spare / travel[comes]).min(initial=1.0))

    def _travels(
        self, pairs: NDArray[np.int64], joints: NDArray[np.float64], way: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """By how much pairs (p, 3) come nearer at most, m, from where joints are on, while coordinates change (n,)."""
        self._travel.measure(1.0, joints, self._screws.along(way))
        own, moved = pairs[:, 2], self._travel.moved[pairs[:, 0], 0]
        return np.where(own >= 0, self._travel.reaches[own], moved) if len(self._travel.reaches) else moved

    def _roomy(
        self, placed: Placed, pairs: NDArray[np.int64], left: NDArray[np.float64], enough: NDArray[np.float64]
    ) -> NDArray[np.float64] | None:
        """Rooms (p,) of pairs (p, 3) where they are placed, m; None if one has no more than must be left.

        Args:
            placed: The bodies.
            pairs: (p, 3).
            left: (p,) what must be left, m.
            enough: (p,) m; once a pair is found to have more, no more is looked for.
        """
        enough = np.maximum(left, enough)
        rooms = self._rooms.least(placed, pairs, enough)
        for r in np.argsort(rooms - enough).tolist():  # the narrowest first: where there is none, that is soon known
            if rooms[r] > enough[r]:
                break
            i, j, k = pairs[r].tolist()
            rooms[r] = max(rooms[r], self._checker.room(placed, i, j, k, self.clearance))
            if rooms[r] <= left[r]:
                return None
        return rooms

    def _between(
        self,
        stopping: Stopping,
        pairs: NDArray[np.int64],
        travel: NDArray[np.float64],
        begin: Moment,
        end: float,
        ends: NDArray[np.float64],
        looks: int = LOOKS,
    ) -> bool:
        """Whether pairs (p, 3) are proved free between two moments.

        Args:
            stopping: The motion.
            pairs: (p, 3).
            travel: (p,) by how much they come nearer in between, at most, m.
            begin: The first of the moments.
            end: The tick of the other, ...
            ends: (p,) ... and the rooms there, m.
            looks: How often what lies between may be cut in two.
        """
        doubted = np.flatnonzero(begin.rooms + ends <= travel)
        if not doubted.size:
            return True
        tick = math.floor(0.5 * (begin.tick + end))
        if looks == 0 or tick in (begin.tick, end):
            return False
        pairs, rooms, ends = pairs[doubted], begin.rooms[doubted], ends[doubted]
        placed = self._checker.solids.place(stopping.q(tick))
        joints = placed.joints.copy()
        there = self._travels(pairs, begin.joints, stopping.way(begin.tick, tick))
        onward = self._travels(pairs, joints, stopping.way(tick, end))
        middle = self._roomy(placed, pairs, np.zeros(len(pairs)), np.maximum(there - rooms, onward - ends))
        if middle is None:
            return False
        first, second = begin._replace(rooms=rooms), Moment(tick, joints, middle)
        return self._between(stopping, pairs, there, first, tick, middle, looks - 1) and self._between(
            stopping, pairs, onward, second, end, ends, looks - 1
        )


class Stopping:
    """The motion of a chain that goes at some speeds for one tick and brakes from then on.

    Attributes:
        q0: (nq,) where it begins.
        x: (n,) its coordinates there.
        ticks: After which it stands.
    """

    def __init__(
        self, chain: Chain, q0: NDArray[np.float64], v: NDArray[np.float64], dv: NDArray[np.float64], dt: float
    ) -> None:
        from pin_metaik.motion.kernel import stopping

        self.q0, self.x, self.ticks = q0, chain.x(q0), float(np.floor(np.abs(v) / dv).max() + 1.0)
        self._chain, self._given = chain, (v, dv, dt)
        self._stopping = cast(Any, stopping).compiled()  # a frame less

    def at(self, tick: float) -> NDArray[np.float64]:
        """Coordinates (n,) after so many ticks."""
        x = np.empty_like(self.x)
        self._stopping(self.x, *self._given, tick, x)
        return x

    def way(self, a: float, b: float) -> NDArray[np.float64]:
        """By how much (n,) the coordinates change between two ticks."""
        way: NDArray[np.float64] = np.abs(self.at(b) - (self.at(a) if a else self.x))
        return way

    def q(self, tick: float) -> NDArray[np.float64]:
        """The configuration (nq,) after so many ticks."""
        return self._chain.q(self.at(tick), self.q0)


def _moves(chain: Chain) -> NDArray[np.int64]:
    """(joints, S) 1 where a row of the chain's paths moves what a joint carries; a joint on two paths has one row."""
    model, paths = chain.model, chain.paths
    moves = np.zeros((model.njoints, len(paths.joints)), dtype=np.int64)
    columns = chain.coordinates.columns
    done: set[int] = set()
    row = 0
    for frame in chain.frame_ids:
        for joint in list(model.supports[model.frames[frame].parentJoint])[1:]:
            if leader_of(model, joint) not in columns:
                continue
            rows = slice(row, row + len(parts_of(model, joint).motions))
            if joint not in done:
                moves[[joint in list(supports) for supports in model.supports], rows] = 1
            done.add(joint)
            row = rows.stop
    return moves
