"""How far the bodies of a robot can move, at most, while its joints do.

While joints turn by |dx_k| or slide by it, a body moves at most by the sum of its levers times |dx_k|. A joint that
slides has the lever 1. One that turns has, in every configuration, at most the length of the way along the links from
it to the farthest point of the body; and near a configuration at most the body's distance from its axis there, and what
the joints between the two can add to that meanwhile. Two bodies come nearer to each other by what the joints do that
move the one and not the other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.checker import Checker
from pin_metaik.kinematics import Chain
from pin_metaik.kinematics.joints import Motion, leader_of, parts_of

FAR = 1e6  # m; a lever of what has no bounds: it is free only while such a joint stands


class PairLevers(NamedTuple):
    """Of p pairs of bodies that move, and of m bodies that move against what stands, by the K joints that move.

    Attributes:
        own: (p, K) m, or 1.
        against: (m, K) m, or 1.
    """

    own: NDArray[np.float64]
    against: NDArray[np.float64]

    def of(self, body: int, pair: int) -> NDArray[np.float64]:
        """Levers (K,) of a pair; or of a body against what stands, where the number of the pair is below 0."""
        lever: NDArray[np.float64] = self.own[pair] if pair >= 0 else self.against[body]
        return lever


class Levers:
    """The levers of all bodies that move in a world, as its checks are laid out.

    Attributes:
        everywhere: Those of every configuration.
    """

    def __init__(self, chain: Chain, checker: Checker) -> None:
        model, bodies, columns = chain.model, checker.solids.moving, chain.coordinates.columns
        joints = [j for j in range(1, model.njoints) if leader_of(model, j) in columns]  # from the base on
        motions = [(j, motion) for j in joints for motion in parts_of(model, j).motions]
        alone = np.array([len(parts_of(model, j).motions) == 1 for j, _ in motions])
        self._solids, self._joints = checker.solids, [j for j, _ in motions]
        self._columns = np.array([columns[motion.driver] + motion.part for _, motion in motions])
        self._scales = np.array([abs(motion.scale) for _, motion in motions])
        self._axes = np.array([motion.axis for _, motion in motions])
        self._turns = np.array([motion.rotates for _, motion in motions])
        self._about = self._turns & alone  # those whose axis is that of their joint, wherever it is
        reaches = [_reaches(chain, columns, body.joint, _extent(body.placement, body.solid.box)) for body in bodies]
        shape = -1, len(motions)
        self._moved = np.array([[j in reach for j in self._joints] for reach in reaches]).reshape(shape)
        against = np.array([[x for j in joints for x in reach.get(j, _nothing(model, j))] for reach in reaches])
        self._first, self._second = checker.asked.own.T
        self.everywhere = self._paired(np.where(self._turns, against.reshape(shape), self._moved))

    def way(self, way: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far (K,) the joints move while coordinates change by way (n,)."""
        joints: NDArray[np.float64] = self._scales * way[self._columns]
        return joints

    def near(self, q: NDArray[np.float64], way: NDArray[np.float64]) -> PairLevers:
        """Those of all configurations that are reached from q (nq,) while the joints move by no more than way (K,)."""
        placed, everywhere = self._solids.place(q), self.everywhere.against
        frames = placed.joints[self._joints]
        axes = (self._axes[:, :, None] * frames[:, :9].reshape(-1, 3, 3)).sum(axis=1)
        boxes, poses = self._solids.boxes, placed.poses[: len(everywhere)]
        middles = (boxes[:, :3, None] * poses[:, :9].reshape(-1, 3, 3)).sum(axis=1) + poses[:, 9:]
        apart = middles[:, None] - frames[None, :, 9:]  # (m, K, 3)
        along = (apart * axes).sum(axis=2)
        distance = np.sqrt(np.maximum((apart * apart).sum(axis=2) - along * along, 0.0))
        added = everywhere * way
        after = added[:, ::-1].cumsum(axis=1)[:, ::-1] - added  # by the joints between this one and the body
        levers = np.minimum(distance + boxes[:, 6:7] + after, everywhere)
        return self._paired(np.where(self._about & self._moved, levers, everywhere))

    def _paired(self, levers: NDArray[np.float64]) -> PairLevers:
        first, second = self._first, self._second
        own = levers[first] * ~self._moved[second] + levers[second] * ~self._moved[first]
        return PairLevers(own, levers)


def _extent(placement: pin.SE3, box: NDArray[np.float64]) -> float:
    """How far the ball around a body reaches from the origin of the joint that carries it, m."""
    return min(float(np.linalg.norm(placement.act(box[:3])) + box[6]), FAR)


def _reaches(chain: Chain, columns: dict[int, int], carrier: int, extent: float) -> dict[int, list[float]]:
    """The ways (m) along the links from each motion of each joint that moves a body to the farthest point of it."""
    model, reach = chain.model, extent
    found: dict[int, list[float]] = {}
    for joint in reversed(list(model.supports[carrier])[1:]):
        leader = leader_of(model, joint)
        if leader not in columns:
            reach += _slide(model, joint)
        else:
            found[joint] = []
            for motion in reversed(parts_of(model, joint).motions):
                found[joint].insert(0, reach)
                column = columns[leader] + motion.part
                reach += _farthest(motion, chain.limits.lower[column], chain.limits.upper[column])
                reach += float(np.linalg.norm(motion.before.translation))
        reach += float(np.linalg.norm(model.jointPlacements[joint].translation))
    return found


def _nothing(model: pin.Model, joint: int) -> list[float]:
    """Levers of the motions of a joint that does not move a body."""
    return [0.0] * len(parts_of(model, joint).motions)


def _slide(model: pin.Model, joint: int) -> float:
    """How far a joint that is no coordinate may have slid, wherever it is held; m."""
    leader, motions = model.joints[leader_of(model, joint)], parts_of(model, joint).motions
    if leader.nv != 1:
        return 0.0 if all(motion.rotates for motion in motions) else FAR
    lower, upper = model.lowerPositionLimit[leader.idx_q], model.upperPositionLimit[leader.idx_q]
    return sum(_farthest(motion, lower, upper) for motion in motions)


def _farthest(motion: Motion, lower: float, upper: float) -> float:
    """The farthest that a motion slides while what it follows is inside limits, m; 0 of one that turns."""
    return 0.0 if motion.rotates else min(max(abs(motion.scale * end + motion.shift) for end in (lower, upper)), FAR)
