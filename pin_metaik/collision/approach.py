"""How near two bodies of a robot can come: steps downhill in the distance of their hulls, inside the limits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.solids import Level, Solids

STEPS = 60  # at most
LONGEST = 0.5  # rad or m, of a step
SHORTER, HALVINGS = 0.4, 6  # what a step that brings nothing is cut to, and how often
SETTLED = 1e-4  # m of distance that a step must bring, or the descent ends


class _Gap(NamedTuple):
    """The distance of two hulls (m; minus their depth), its direction (3,) and the nearest points (3,)."""

    distance: float
    normal: NDArray[np.float64]
    points: tuple[NDArray[np.float64], NDArray[np.float64]]


@dataclass(frozen=True, eq=False)
class Approach:
    """Two bodies that joints move against each other.

    Attributes:
        solids: The bodies of the robot.
        first: Number of the one.
        second: Number of the other.
    """

    solids: Solids
    first: int
    second: int

    @property
    def model(self) -> pin.Model:
        """The robot's model."""
        return self.solids.model

    @property
    def links(self) -> tuple[str, str]:
        """Names of the two links."""
        return self.solids.moving[self.first].link, self.solids.moving[self.second].link

    @property
    def several(self) -> bool:
        """Whether a joint of several freedoms, such as a ball joint, moves the two against each other."""
        return any(joint.nv > 1 for joint in self._joints)

    @cached_property
    def free(self) -> NDArray[np.int64]:
        """Numbers of the freedoms of those joints that move one of the two against the other."""
        freedoms = {k for joint in self._joints for k in range(joint.idx_v, joint.idx_v + joint.nv)}
        return np.array(sorted(freedoms), dtype=np.int64)

    @cached_property
    def _carriers(self) -> tuple[int, int]:
        """Ids of the joints that carry the two."""
        return self.solids.moving[self.first].joint, self.solids.moving[self.second].joint

    @cached_property
    def _hulls(self) -> tuple[Level, Level]:
        return self.solids.levels[self.first].hull, self.solids.levels[self.second].hull

    @cached_property
    def _joints(self) -> list[pin.JointModel]:
        """The joints between the two; for one that follows another, that one."""
        first, second = self._carriers
        between = set(self.model.supports[first]) ^ set(self.model.supports[second])
        leaders = dict(zip(self.model.mimicking_joints, self.model.mimicked_joints, strict=True))
        return [self.model.joints[leaders.get(joint, joint)] for joint in sorted(between)]

    @cached_property
    def _limits(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """For each freedom that moves: its coordinate in q, and its limits; infinite if it has none of its own."""
        bounded = {joint.idx_v: joint.idx_q for joint in self.model.joints if joint.nq == joint.nv == 1}
        places = np.array([bounded.get(int(k), -1) for k in self.free], dtype=np.int64)
        lower = np.where(places < 0, -np.inf, self.model.lowerPositionLimit[places])
        return places, lower, np.where(places < 0, np.inf, self.model.upperPositionLimit[places])

    def distance(self, q: NDArray[np.float64]) -> float:
        """Distance of the two hulls at q (nq,), m; minus their depth where they overlap."""
        return self._gap(q).distance

    def descend(self, q: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """The least distance (m) on the way downhill from q (nq,), and where; it ends as soon as the two touch.

        Each step goes along the gradient as far as would close the gap, if the distance were linear, and is cut until
        it brings something.
        """
        gap = self._gap(q)
        for _ in range(STEPS):
            if gap.distance <= 0.0:
                break
            slope = self._slope(q, gap)
            size = float(slope @ slope)
            if size == 0.0:
                break
            step = -min(gap.distance / size, LONGEST / float(np.abs(slope).max())) * slope
            for _ in range(HALVINGS):
                tried = self._step(q, step)
                there = self._gap(tried)
                if there.distance < gap.distance - SETTLED:
                    break
                step = SHORTER * step
            else:
                break
            q, gap = tried, there
        return gap.distance, q

    def _slope(self, q: NDArray[np.float64], gap: _Gap) -> NDArray[np.float64]:
        """The slope of the distance at q (nq,) along the freedoms that move; 0 along those that a limit holds."""
        data = self.solids.place(q).data
        pin.computeJointJacobians(self.model, data, q)
        slope = np.zeros(self.model.nv)
        a, b, c = gap.normal.tolist()
        for sign, joint, point in zip((-1.0, 1.0), self._carriers, gap.points, strict=True):
            if joint:
                J = pin.getJointJacobian(self.model, data, joint, pin.ReferenceFrame.WORLD)  # (6, nv), at 0
                x, y, z = point.tolist()
                slope += sign * (np.array([a, b, c, y * c - z * b, z * a - x * c, x * b - y * a]) @ J)
        slope = slope[self.free]
        places, lower, upper = self._limits
        held = ((q[places] <= lower) & (slope > 0.0)) | ((q[places] >= upper) & (slope < 0.0))
        return np.where(held, 0.0, slope)

    def _step(self, q: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
        """From q (nq,) along the freedoms that move, inside the limits."""
        v = np.zeros(self.model.nv)
        v[self.free] = step
        there: NDArray[np.float64] = pin.integrate(self.model, q, v)
        places, lower, upper = self._limits
        mine = places >= 0
        there[places[mine]] = np.minimum(np.maximum(there[places[mine]], lower[mine]), upper[mine])
        return there

    def _gap(self, q: NDArray[np.float64]) -> _Gap:
        """The gap between the hulls at q (nq,)."""
        placed = self.solids.place(q)
        distance = placed.distance(*self._hulls)
        return _Gap(distance, placed.normal, placed.points)
