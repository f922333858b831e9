"""Whether a robot that brakes stops before anything collides: by distances, and bounds on how far bodies go."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias, cast

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision import CollisionWorld
from pin_metaik.collision.checker import Checker
from pin_metaik.collision.solids import Placed
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.paths import Motion, leader_of, motion_of

STALE = 0.2  # of a distance that bodies may have moved until it is measured again
INFLUENCE = 0.1  # m; bodies farther apart beyond their margin do not slow anything down
DAMPING = 4.0  # 1/s; speed of approach that a metre of distance beyond the clearance allows
SHRINKING = 0.5  # of the distance that is left within the clearance, what must be left when the robot stands
ROUNDING = 1e-6  # m
FAR = 1e6  # m; a lever of what has no bounds: it is free only while such a joint stands
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
        gone: (n,) the way that the coordinates had gone by then, each by itself, rad or m.
        row: What is near, as ``kernel.aim`` takes it; None where two surfaces cross.
        carriers: Numbers of the joints that carry the two.
    """

    room: float
    gone: NDArray[np.float64]
    row: list[float] | None
    carriers: tuple[int, int]


class Stops:
    """What a chain's robot has around it, and whether it can stop there.

    A body moves, while coordinates change by |dx_j|, at most by the sum of its levers L_j times |dx_j|, whatever the
    configuration: L_j is the length of the way along the links from joint j to the farthest point of the body, 1 for a
    joint that slides. Two bodies come nearer by the sum over the joints that move the one against the other. So a pair
    that is farther apart than this at the two ends of a motion, both distances added up, does not touch in between; and
    what cannot be told so is looked at in the middle. For the same reason a distance that was measured some ticks ago
    is good for a while, less what the bodies may have moved since.

    Attributes:
        chain: The chain.
        world: The world; it may change between two ticks.
        clearance: Distance beyond the margins that is kept when nothing forces it down, m.
    """

    def __init__(self, chain: Chain, world: CollisionWorld, clearance: float) -> None:
        self.chain, self.world, self.clearance = chain, world, clearance
        self._checker: Checker | None = None
        self.moves = _moves(chain)
        self._own, self._against = np.empty((0, chain.n)), np.empty((0, chain.n))
        self._known: dict[Pair, Known] = {}
        self._others = np.isnan(chain.q(np.zeros(chain.n), np.full(chain.model.nq, np.nan)))  # entries of other joints
        self._at: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        self._gone = np.zeros(chain.n)

    @property
    def checker(self) -> Checker:
        """The checks as they are laid out now; the levers follow them."""
        checker = self.world.checker
        if checker is not self._checker:
            bodies, nothing = checker.solids.moving, np.zeros(self.chain.n)
            levers = [_levers(self.chain, body.joint, _extent(body.placement, body.solid.box)) for body in bodies]

            def apart(i: int, j: int) -> NDArray[np.float64]:
                """Levers of body i, of the joints that do not move body j as well."""
                return sum((lever for joint, lever in levers[i].items() if joint not in levers[j]), nothing)

            own = [apart(i, j) + apart(j, i) for i, j in checker.asked.own.tolist()]
            self._own = np.array(own).reshape(-1, self.chain.n)
            self._against = np.array([sum(by.values(), nothing) for by in levers]).reshape(-1, self.chain.n)
            self._checker = checker
            self._known.clear()
        return checker

    def around(self, q: NDArray[np.float64], way: NDArray[np.float64]) -> Surroundings:
        """Distances at q (nq,) of the pairs that come near, or may until coordinates have changed by way (n,)."""
        checker = self.checker
        self._went_to(q)
        own, against = self._own @ way + self.clearance, self._against @ way + self.clearance
        most = max(INFLUENCE, own.max(initial=0.0), against.max(initial=0.0))
        placed = checker.solids.place(q)
        rooms: dict[Pair, float] = {}
        near: list[Known] = []
        found = placed.near(checker.asked, most)
        for (i, j, k), least in zip(found, placed.least[: len(found)].tolist(), strict=True):
            needed = max(INFLUENCE, float(own[k] if k >= 0 else against[i]))
            if least - checker.margin_of(i, j, k) > needed:
                continue
            known = self._known.get((i, j, k))
            if known is None or (drift := float(self._lever(i, k) @ (self._gone - known.gone))) > STALE * known.room:
                known, drift = self._measured(placed, i, j, k), 0.0
                self._known[i, j, k] = known
            rooms[i, j, k] = known.room - drift
            if known.row is not None and known.room < INFLUENCE:
                near.append(known)
        rows = np.array([known.row for known in near]).reshape(-1, 10)
        carriers = np.array([known.carriers for known in near], dtype=np.int64).reshape(-1, 2)
        return Surroundings(rooms, rows, carriers)

    def _went_to(self, q: NDArray[np.float64]) -> None:
        """Add to the way that the coordinates have gone; forget distances if anything else has moved."""
        x, others = self.chain.x(q), q[self._others]
        if self._at is None or not np.array_equal(others, self._at[1]):
            self._known.clear()
        else:
            self._gone = self._gone + np.abs(self.chain.limits.way(self._at[0], x))
        self._at = x, others

    def _measured(self, placed: Placed, i: int, j: int, k: int) -> Known:
        """The distance of a pair where it is placed now."""
        checker = self.checker
        room, normal = checker.room(placed, i, j, k, self.clearance), placed.normal
        first, second = placed.points
        row = None
        if not 0.5 < float(normal @ normal) < 2.0 and room > ROUNDING:  # meshes have none
            normal = (second - first) / np.linalg.norm(second - first)
        if 0.5 < float(normal @ normal) < 2.0:  # surfaces that cross have none either way
            row = [*normal, *first, *second, DAMPING * (room - self.clearance)]
        return Known(room, self._gone, row, (checker.joint_of(i), checker.joint_of(j)))

    def _lever(self, i: int, k: int) -> NDArray[np.float64]:
        """How much (n,) a pair comes nearer at most for each rad or m of a coordinate."""
        lever: NDArray[np.float64] = self._own[k] if k >= 0 else self._against[i]
        return lever

    def free(self, rooms: dict[Pair, float], stopping: Stopping) -> bool:
        """Whether a braking motion is proved free, and ends not much nearer to anything than it begins.

        Args:
            rooms: Distances where it begins, of all pairs that it may bring together.
            stopping: The motion.
        """
        way = stopping.way(0.0, math.inf)
        own, against = self._own @ way, self._against @ way
        pending = {}
        for pair, room in rooms.items():
            i, _, k = pair
            travel = float(own[k] if k >= 0 else against[i])
            if travel > 0.0 and room - travel < SHRINKING * min(self.clearance, room):
                pending[pair] = room
        if not pending:
            return True
        ends = self._rooms(stopping.q(math.inf), list(pending))
        for pair, room in pending.items():
            if ends[pair] <= room if room <= 0.0 else ends[pair] < SHRINKING * min(self.clearance, room):
                return False
        pending = {pair: room for pair, room in pending.items() if room > 0.0}  # what collides may part
        return self._free(stopping, (0.0, pending), (stopping.ticks, ends), LOOKS)

    def harmless(self, rooms: dict[Pair, float], stopping: Stopping) -> float:
        """The share of a braking motion that takes no pair more of its distance than it may; at most 1."""
        way = stopping.way(0.0, math.inf)
        share = 1.0
        for (i, _, k), room in rooms.items():
            travel = float(self._lever(i, k) @ way)
            if travel > 0.0:
                share = min(share, max((1.0 - SHRINKING) * room, 0.0) / travel)
        return share

    def _free(
        self, stopping: Stopping, a: tuple[float, dict[Pair, float]], b: tuple[float, dict[Pair, float]], looks: int
    ) -> bool:
        """The same between two ticks, where the distances of the pairs are known."""
        way = stopping.way(a[0], b[0])
        left = [(i, j, k) for i, j, k in a[1] if a[1][i, j, k] + b[1][i, j, k] <= float(self._lever(i, k) @ way)]
        if not left:
            return True
        tick = math.floor(0.5 * (a[0] + b[0]))
        if looks == 0 or tick in (a[0], b[0]):
            return False
        middle = self._rooms(stopping.q(tick), left)
        if min(middle.values()) <= 0.0:
            return False
        first = a[0], {pair: a[1][pair] for pair in left}
        return self._free(stopping, first, (tick, middle), looks - 1) and self._free(
            stopping, (tick, middle), b, looks - 1
        )

    def _rooms(self, q: NDArray[np.float64], pairs: list[Pair]) -> dict[Pair, float]:
        checker = self.checker
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


def _extent(placement: pin.SE3, box: NDArray[np.float64]) -> float:
    """How far the ball around a body reaches from the origin of the joint that carries it, m."""
    return min(float(np.linalg.norm(placement.act(box[:3])) + box[6]), FAR)


def _levers(chain: Chain, carrier: int, extent: float) -> dict[int, NDArray[np.float64]]:
    """Levers (n,) of a body by coordinate, of each joint that moves it; m for a turn, 1 for a slide."""
    model, reach = chain.model, extent
    columns = {int(j): column for column, j in enumerate(chain.coordinates.joints)}
    found: dict[int, NDArray[np.float64]] = {}
    for joint in reversed(list(model.supports[carrier])[1:]):
        leader = leader_of(model, joint)
        if leader in columns:
            motion, column = motion_of(model, joint), columns[leader]
            found[joint] = np.zeros(chain.n)
            found[joint][column] = abs(motion.scale) * (reach if motion.rotates else 1.0)
            if not motion.rotates:
                reach += _farthest(motion, chain.limits.lower[column], chain.limits.upper[column])
        else:
            reach += _slide(model, joint)
        reach += float(np.linalg.norm(model.jointPlacements[joint].translation))
    return found


def _slide(model: pin.Model, joint: int) -> float:
    """How far a joint that is no coordinate may have slid, wherever it is held; m."""
    leader = model.joints[leader_of(model, joint)]
    if leader.shortname() == "JointModelSpherical":
        return 0.0
    if leader.nv != 1:
        return FAR
    motion = motion_of(model, joint)
    lower, upper = model.lowerPositionLimit[leader.idx_q], model.upperPositionLimit[leader.idx_q]
    return 0.0 if motion.rotates else _farthest(motion, lower, upper)


def _farthest(motion: Motion, lower: float, upper: float) -> float:
    """The farthest that a joint slides while what it follows is inside limits, m."""
    return min(max(abs(motion.scale * end + motion.shift) for end in (lower, upper)), FAR)


def _moves(chain: Chain) -> NDArray[np.int64]:
    """(joints, S) 1 where a row of the chain's paths moves what a joint carries; a joint on two paths has one row."""
    model, paths = chain.model, chain.paths
    moves = np.zeros((model.njoints, len(paths.joints)), dtype=np.int64)
    leaders = {int(j) for j in chain.coordinates.joints}
    done: set[int] = set()
    row = 0
    for frame in chain.frame_ids:
        for joint in list(model.supports[model.frames[frame].parentJoint])[1:]:
            if leader_of(model, joint) not in leaders:
                continue
            if joint not in done:
                moves[[joint in list(supports) for supports in model.supports], row] = 1
            done.add(joint)
            row += 1
    return moves
