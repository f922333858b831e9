"""How near two bodies of a robot can come: steps downhill in the distance of their hulls, inside the limits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.collision.body import Body

STEPS = 60  # at most
LONGEST = 0.5  # rad or m, of a step
SHORTER, HALVINGS = 0.4, 6  # what a step that brings nothing is cut to, and how often
SETTLED = 1e-4  # m of distance that a step must bring, or the descent ends


class _Gap(NamedTuple):
    """The distance of two hulls (m; minus their depth), its direction (3,) and the nearest points (3,)."""

    distance: float
    normal: NDArray[np.float64]
    points: tuple[Any, Any]


@dataclass(frozen=True, eq=False)
class Approach:
    """Two bodies that joints move against each other.

    Attributes:
        model: The robot's model.
        data: Room for its kinematics.
        first: One body.
        second: The other.
    """

    model: pin.Model
    data: pin.Data
    first: Body
    second: Body

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
    def _joints(self) -> list[pin.JointModel]:
        """The joints between the two; for one that follows another, that one."""
        between = set(self.model.supports[self.first.joint]) ^ set(self.model.supports[self.second.joint])
        leaders = dict(zip(self.model.mimicking_joints, self.model.mimicked_joints, strict=True))
        return [self.model.joints[leaders.get(joint, joint)] for joint in sorted(between)]

    @cached_property
    def _limits(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """For each freedom that moves: its coordinate in q, and its limits; infinite if it has none of its own."""
        bounded = {joint.idx_v: joint.idx_q for joint in self.model.joints if joint.nq == joint.nv == 1}
        places = np.array([bounded.get(int(k), -1) for k in self.free], dtype=np.int64)
        lower = np.where(places < 0, -np.inf, self.model.lowerPositionLimit[places])
        return places, lower, np.where(places < 0, np.inf, self.model.upperPositionLimit[places])

    @cached_property
    def _placed(self) -> tuple[pin.GeometryModel, pin.GeometryData]:
        """What Pinocchio places: the two hulls."""
        geometry = pin.GeometryModel()
        for name, body in (("first", self.first), ("second", self.second)):
            geometry.addGeometryObject(pin.GeometryObject(name, body.joint, body.placement, body.solid.hull))
        return geometry, geometry.createData()

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
        pin.computeJointJacobians(self.model, self.data, q)
        slope = np.zeros(self.model.nv)
        for sign, joint, point in zip((-1.0, 1.0), (self.first.joint, self.second.joint), gap.points, strict=True):
            if joint:
                J = pin.getJointJacobian(self.model, self.data, joint, pin.ReferenceFrame.WORLD)  # (6, nv), at 0
                slope += sign * np.concatenate([gap.normal, pin.skew(point) @ gap.normal]) @ J
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
        geometry, shapes = self._placed
        pin.updateGeometryPlacements(self.model, self.data, geometry, shapes, q)
        poses = [coal.Transform3s(M.rotation, M.translation) for M in shapes.oMg]
        result = coal.DistanceResult()
        hulls = self.first.solid.hull, self.second.solid.hull
        distance = coal.distance(hulls[0], poses[0], hulls[1], poses[1], coal.DistanceRequest(), result)
        return _Gap(distance, np.array(result.normal), (result.getNearestPoint1(), result.getNearestPoint2()))
