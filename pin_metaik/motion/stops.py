"""Whether a robot that brakes stops before anything collides: by distances, and bounds on how far bodies go."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.collision.solids import Placed
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.joints import leader_of, parts_of
from pin_metaik.motion.levers import Levers, PairLevers

STALE = 0.2  # of a distance that bodies may have moved until it is measured again
INFLUENCE = 0.1  # m; bodies farther apart beyond their margin do not slow anything down
DAMPING = 4.0  # 1/s; speed of approach that a metre of distance beyond the clearance allows
SHRINKING = 0.5  # of the distance that is left within the clearance, what must be left when the robot stands
ROUNDING = 1e-6  # m
LOOKS = 4  # times that a braking motion is cut in two

Pair: TypeAlias = tuple[int, int, int]


class Surroundings(NamedTuple):
    """What is near a configuration.

    Attributes:
        rooms: Distance beyond its margin (m) of each pair that may matter, by numbers of its bodies and of the pair.
        near: (p, 10) and ``carriers`` (p, 2): those within ``INFLUENCE``, as ``kernel.aim`` takes them.
    """

    rooms: dict[Pair, float]
    near: NDArray[np.float64]
    carriers: NDArray[np.int64]


class Known(NamedTuple):
    """A distance that was measured.

    Attributes:
        room: Beyond the margin, m.
        gone: (K,) the way that the joints had gone by then, each by itself, rad or m.
        row: What is near, as ``kernel.aim`` takes it; None where two surfaces cross.
        carriers: Numbers of the joints that carry the two.
    """

    room: float
    gone: NDArray[np.float64]
    row: list[float] | None
    carriers: tuple[int, int]


class At(NamedTuple):
    """A moment of a braking motion: after so many ticks, and the distances (m) of the pairs that are in question."""

    tick: float
    rooms: dict[Pair, float]


class Stops:
    """What a chain's robot has around it, and whether it can stop there.

    Two bodies that are farther apart than they can come nearer in a motion (see ``Levers``), the distances at its two
    ends added up, do not touch in between; and what cannot be told so is looked at in the middle. For the same reason a
    distance that was measured some ticks ago is good for a while, less what the bodies may have moved since.

    Attributes:
        chain: The chain.
        world: The world; it may change between two ticks.
        clearance: Distance beyond the margins that is kept when nothing forces it down, m.
        moves: (joints, S) 1 where a row of the chain's paths moves what a joint carries.
    """

    def __init__(self, chain: Chain, world: CollisionWorld, clearance: float) -> None:
        self.chain, self.world, self.clearance = chain, world, clearance
        self.moves = _moves(chain)
        self.levers = Levers(chain, world.checker)
        self._checker = world.checker
        self._known: dict[Pair, Known] = {}
        self._others = np.isnan(chain.q(np.zeros(chain.n), np.full(chain.model.nq, np.nan)))  # entries of other joints
        self._at: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        self._gone = self.levers.way(np.zeros(chain.n))

    def around(self, q: NDArray[np.float64], way: NDArray[np.float64]) -> Surroundings:
        """Distances at q (nq,) of the pairs that come near, or may until coordinates have changed by way (n,)."""
        self._went_to(q)
        checker, levers, way = self._checker, self.levers.everywhere, self.levers.way(way)
        needed = PairLevers(levers.own @ way + self.clearance, levers.against @ way + self.clearance)
        most = max(INFLUENCE, needed.own.max(initial=0.0), needed.against.max(initial=0.0))
        placed = checker.solids.place(q)
        rooms: dict[Pair, float] = {}
        near: list[Known] = []
        found = placed.near(checker.asked, most)
        for (i, j, k), least in zip(found, placed.least[: len(found)].tolist(), strict=True):
            if least - checker.margin_of(i, j, k) > max(INFLUENCE, float(needed.of(i, k))):
                continue
            known = self._known.get((i, j, k))
            if known is None or (drift := float(levers.of(i, k) @ (self._gone - known.gone))) > STALE * known.room:
                known, drift = self._measured(placed, i, j, k), 0.0
                self._known[i, j, k] = known
            rooms[i, j, k] = known.room - drift
            if known.row is not None and known.room < INFLUENCE:
                near.append(known)
        rows = np.array([known.row for known in near]).reshape(-1, 10)
        carriers = np.array([known.carriers for known in near], dtype=np.int64).reshape(-1, 2)
        return Surroundings(rooms, rows, carriers)

    def _went_to(self, q: NDArray[np.float64]) -> None:
        """Add to the way that the joints have gone; forget distances if anything else has moved or changed."""
        x, others = self.chain.x(q), q[self._others]
        if self._checker is not self.world.checker:
            self._checker = self.world.checker
            self.levers = Levers(self.chain, self._checker)
            self._known.clear()
        if self._at is None or not np.array_equal(others, self._at[1]):
            self._known.clear()
        else:
            self._gone = self._gone + self.levers.way(np.abs(self.chain.limits.way(self._at[0], x)))
        self._at = x, others

    def _measured(self, placed: Placed, i: int, j: int, k: int) -> Known:
        """The distance of a pair where it is placed now."""
        checker = self._checker
        room, normal = checker.room(placed, i, j, k, self.clearance), placed.normal
        first, second = placed.points
        row = None
        if not 0.5 < float(normal @ normal) < 2.0 and room > ROUNDING:  # meshes have none
            normal = (second - first) / np.linalg.norm(second - first)
        if 0.5 < float(normal @ normal) < 2.0:  # surfaces that cross have none either way
            row = [*normal, *first, *second, DAMPING * (room - self.clearance)]
        return Known(room, self._gone, row, (checker.joint_of(i), checker.joint_of(j)))

    def free(self, rooms: dict[Pair, float], stopping: Stopping) -> bool:
        """Whether a braking motion is proved free, and ends not much nearer to anything than it begins.

        Args:
            rooms: Distances where it begins, of all pairs that it may bring together.
            stopping: The motion.
        """
        way = self.levers.way(stopping.way(0.0, math.inf))
        pending = self._pending(rooms, self.levers.everywhere, way)
        if not pending:
            return True
        levers = self.levers.near(stopping.q(0.0), way)
        pending = self._pending(pending, levers, way)
        if not pending:
            return True
        ends = self._rooms(stopping.q(math.inf), list(pending))
        for pair, room in pending.items():
            if ends[pair] <= room if room <= 0.0 else ends[pair] < SHRINKING * min(self.clearance, room):
                return False
        apart = {pair: room for pair, room in pending.items() if room > 0.0}  # what collides may part
        return self._free(stopping, levers, At(0.0, apart), At(stopping.ticks, ends), LOOKS)

    def _pending(self, rooms: dict[Pair, float], levers: PairLevers, way: NDArray[np.float64]) -> dict[Pair, float]:
        """The pairs that may come nearer, while joints move by way (K,), than they may."""
        own, against = levers.own @ way, levers.against @ way
        pending = {}
        for pair, room in rooms.items():
            i, _, k = pair
            travel = float(own[k] if k >= 0 else against[i])
            if travel > 0.0 and room - travel < SHRINKING * min(self.clearance, room):
                pending[pair] = room
        return pending

    def harmless(self, rooms: dict[Pair, float], stopping: Stopping) -> float:
        """The share of a braking motion that takes no pair more of its distance than it may; at most 1."""
        way, levers = self.levers.way(stopping.way(0.0, math.inf)), self.levers.everywhere
        share = 1.0
        for (i, _, k), room in rooms.items():
            travel = float(levers.of(i, k) @ way)
            if travel > 0.0:
                share = min(share, max((1.0 - SHRINKING) * room, 0.0) / travel)
        return share

    def _free(self, stopping: Stopping, levers: PairLevers, a: At, b: At, looks: int) -> bool:
        """Whether the pairs of the first of two moments are proved free between them."""
        way = self.levers.way(stopping.way(a.tick, b.tick))
        left = [(i, j, k) for i, j, k in a.rooms if a.rooms[i, j, k] + b.rooms[i, j, k] <= levers.of(i, k) @ way]
        if not left:
            return True
        tick = math.floor(0.5 * (a.tick + b.tick))
        if looks == 0 or tick in (a.tick, b.tick):
            return False
        middle = At(tick, self._rooms(stopping.q(tick), left))
        if min(middle.rooms.values()) <= 0.0:
            return False
        begin = At(a.tick, {pair: a.rooms[pair] for pair in left})
        parts = (begin, middle), (middle, b)
        return all(self._free(stopping, levers, *part, looks - 1) for part in parts)

    def _rooms(self, q: NDArray[np.float64], pairs: list[Pair]) -> dict[Pair, float]:
        checker = self._checker
        placed = checker.solids.place(q)
        return {pair: checker.room(placed, *pair, needed=self.clearance) for pair in pairs}


class Stopping:
    """The motion of a chain that goes at some speeds for one tick and brakes from then on.

    Attributes:
        x: (n,) where it begins.
        ticks: After which it stands.
    """

    def __init__(
        self, chain: Chain, q: NDArray[np.float64], v: NDArray[np.float64], dv: NDArray[np.float64], dt: float
    ) -> None:
        from pin_metaik.motion.kernel import stopping

        self.x, self.ticks = chain.x(q), float(np.floor(np.abs(v) / dv).max() + 1.0)
        self._chain, self._q, self._given = chain, q, (v, dv, dt)
        self._stopping = cast(Any, stopping).compiled()  # a frame less

    def at(self, tick: float) -> NDArray[np.float64]:
        """Coordinates (n,) after so many ticks."""
        x = np.empty_like(self.x)
        self._stopping(self.x, *self._given, tick, x)
        return x

    def way(self, a: float, b: float) -> NDArray[np.float64]:
        """By how much (n,) the coordinates change between two ticks."""
        way: NDArray[np.float64] = np.abs(self.at(b) - self.at(a))
        return way

    def q(self, tick: float) -> NDArray[np.float64]:
        """The configuration (nq,) after so many ticks."""
        return self._chain.q(self.at(tick), self._q)


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
