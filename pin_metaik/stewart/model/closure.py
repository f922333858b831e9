"""The mechanism in Pinocchio: an open tree from its URDF, and a ``PointAnchorConstraintModel`` for each loop.

Everything here is known in closed form elsewhere in this package, which is what grids and designs use; this model is
for dynamics, and an independent check by Pinocchio.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidConfiguration, InvalidSetting, InvalidTarget
from pin_metaik.stewart.kinematics.inverse import inverse
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.model.urdf import to_urdf
from pin_metaik.stewart.platform.poses import PoseLike, one_pose

TOLERANCE = 1e-13  # m
STEPS = 50


@dataclass(frozen=True, eq=False)
class ClosedModel:
    """A mechanism as a Pinocchio model with loop constraints.

    Attributes:
        mechanism: The mechanism that it models.
        model: The tree: a free-flyer for the platform (7 of q, 6 of v), then three joints a leg.
        closures: One for each leg, of 3 equations: its end is at its joint of the platform.
    """

    mechanism: Mechanism
    model: pin.Model
    closures: list[pin.PointAnchorConstraintModel]

    @property
    def platform(self) -> pin.JointModel:
        """The free-flyer; its velocity is in the platform frame."""
        return self.model.joints[self.model.getJointId("platform_joint")]

    @checked
    def leg(self, i: int) -> list[pin.JointModel]:
        """Joints of leg i, counted from 0: two turns of its link, about x and about y, then its actuator."""
        if not 0 <= i < self.mechanism.geometry.n:
            raise InvalidSetting(f"leg i is 0 to {self.mechanism.geometry.n - 1}, got {i}")
        actuator = "length" if self.mechanism.geometry.servos is None else "servo"  # as the URDF has it
        names = (f"leg_{i + 1}_{name}" for name in ("about_x", "about_y", actuator))
        return [self.model.joints[self.model.getJointId(name)] for name in names]

    @property
    def actuators(self) -> list[int]:
        """Indices (n,) into v of the rates of the linear actuators or servos."""
        return [self.leg(i)[2].idx_v for i in range(self.mechanism.geometry.n)]

    @checked
    def configuration(self, pose: PoseLike) -> Array:
        """The configuration q (nq,) at a pose, in closed form: the direction of a link is Rx(a) Ry(b) z.

        Raises:
            InvalidTarget: Not a pose, or a pose that a rod does not reach.
        """
        T = one_pose(pose)
        actuation = self.mechanism.geometry.actuation
        links = inverse(self.mechanism.geometry, T)
        if links.why:
            raise InvalidTarget(f"the legs do not reach this pose: {links.why}")
        q: Array = pin.neutral(self.model)
        first = self.platform.idx_q
        q[first : first + 7] = pin.SE3ToXYZQUAT(pin.SE3(T))
        for i, (x, y, z) in enumerate(actuation.in_first_joint(links)[0]):
            about_x, about_y, actuator = self.leg(i)
            q[about_x.idx_q], q[about_y.idx_q] = np.arctan2(-y, z), np.arcsin(np.clip(x, -1, 1))
            q[actuator.idx_q] = links.coordinates[0, i]
        return q

    @checked
    def pose(self, q: Array) -> Array:
        """The pose (4, 4) of the platform in a configuration."""
        q = array("a configuration", q, self.model.nq, error=InvalidConfiguration)
        first = self.platform.idx_q
        pose: Array = pin.XYZQUATToSE3(q[first : first + 7]).homogeneous
        return pose

    @checked
    def residual(self, q: ArrayLike) -> tuple[Array, Array]:
        """Residual of the loop closures, m (3 n,), and its derivative by v (3 n, nv).

        Raises:
            InvalidConfiguration: Not a configuration of the model.
        """
        q = array("a configuration", q, self.model.nq, error=InvalidConfiguration)
        data = self.model.createData()
        pin.computeJointJacobians(self.model, data, q)
        errors, rows = [], []
        for closure in self.closures:
            state = closure.createData()
            closure.calc(self.model, data, state)
            errors.append(state.constraint_position_error)
            rows.append(closure.jacobian(self.model, data, state))
        return np.concatenate(errors), np.concatenate(rows)

    @checked
    def forward(self, coordinates: ArrayLike, start: PoseLike) -> Array | None:
        """The pose (4, 4) at which the loops close with these lengths in m, or angles in rad (n,), by Newton.

        Returns:
            The pose; None if Newton does not converge.

        Raises:
            InvalidConfiguration: Not n finite coordinates.
            InvalidTarget: The start is not a pose, or is one that a rod does not reach.
        """
        held = array(f"{self.mechanism.coordinate.word}s", coordinates, len(self.actuators), error=InvalidConfiguration)
        q = self.configuration(start)
        q[[self.leg(i)[2].idx_q for i in range(len(held))]] = held
        free = np.setdiff1d(np.arange(self.model.nv), self.actuators)
        for _ in range(STEPS):
            error, J = self.residual(q)
            if np.abs(error).max() <= TOLERANCE:
                return self.pose(q)
            step = np.zeros(self.model.nv)
            step[free] = -np.linalg.lstsq(J[:, free], error)[0]
            q = pin.integrate(self.model, q, step)
        return None

    @checked
    def rates(self, pose: PoseLike) -> Array:
        """q_dot = J (v, omega) from the closed loops: J (n, 6), v of P and omega in the base frame."""
        q = self.configuration(pose)
        _, J = self.residual(q)
        first = self.platform.idx_v
        flying = np.arange(first, first + 6)
        legs = np.setdiff1d(np.arange(self.model.nv), flying)
        moved = -np.linalg.solve(J[:, legs], J[:, flying])  # velocities of the legs per velocity of the platform
        R = self.pose(q)[:3, :3]
        body = np.kron(np.eye(2), R.T)  # base frame to platform frame
        rates: Array = moved[np.searchsorted(legs, self.actuators)] @ body
        return rates


@checked
def closed_model(mechanism: Mechanism) -> ClosedModel:
    """A mechanism as a Pinocchio model, with constraints that close its loops at the platform joints."""
    model = pin.buildModelFromXML(to_urdf(mechanism))
    closures = []
    for i in range(1, mechanism.geometry.n + 1):
        ends = [model.frames[model.getFrameId(name)] for name in (f"leg_{i}_end", f"platform_end_{i}")]
        (leg, leg_end), (platform, platform_end) = ((end.parentJoint, end.placement) for end in ends)
        closures.append(pin.PointAnchorConstraintModel(model, leg, leg_end, platform, platform_end))
    return ClosedModel(mechanism, model, closures)
