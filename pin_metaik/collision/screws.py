"""How the joints of a robot turn and slide along a straight joint move."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import InvalidConfiguration, UnsupportedJoint
from pin_metaik.kinematics.joints import leader_of
from pin_metaik.kinematics.limits import UNBOUNDED
from pin_metaik.kinematics.model import check_turns

LITTLE = 1e-9  # rad; what turns less in the whole move has no axis that could be told from its digits
FARTHEST = 1e6  # rad or m; what is farther has too few digits left behind the point
LONGEST = 1e3  # rad or m, of a move
VARYING = "JointModelSphericalZYX", "JointModelUniversal"  # their axes turn with the first angles; lengths stay 1


@dataclass(frozen=True, eq=False)
class Screws:
    """The joints of a model, and what one step of all of them makes each do in its own frame.

    Joints move with a constant twist along a straight move: Pinocchio integrates so, on every group of joints.

    Attributes:
        model: The model.
    """

    model: pin.Model

    def way(self, q0: NDArray[np.float64], q1: NDArray[np.float64]) -> NDArray[np.float64]:
        """The tangent vector (nv,) from q0 to q1 (nq,), the short way round for joints without limits.

        Raises:
            UnsupportedJoint: If a joint is composite: its twist varies along a move.
            InvalidConfiguration: If a quaternion, or a cosine and sine, is not of length 1, or a joint is farther from
                its origin than ``FARTHEST`` or is to move farther than ``LONGEST``.
        """
        for j, joint in enumerate(self.model.joints):
            if joint.shortname() == "JointModelComposite":
                raise UnsupportedJoint(
                    f"joint {self.model.names[j]!r} is composite, and moves of composite joints cannot be checked; "
                    "build the model with one joint for each of its parts"
                )
        for q in (q0, q1):
            check_turns(self.model, self._turned, q)
            _check_size(f"a configuration of {self.model.name!r}", q, FARTHEST)
        way: NDArray[np.float64] = pin.difference(self.model, q0, q1)
        turn = 2.0 * np.pi
        way[self._endless] -= turn * np.round(way[self._endless] / turn)
        _check_size("a move", way, LONGEST)
        return way

    def along(self, way: NDArray[np.float64]) -> NDArray[np.float64]:
        """(J, 8) what each joint does on a way (nv,): a point of its axis, its direction, turn (rad) and slide (m).

        Axes are in the joints' frames. A joint without an axis, or with one that turns on the way, has no direction
        (zeros): it turns about its point, so that a lever is a distance from that.
        """
        rows = self._units.copy()
        twists = self._subspaces @ way  # (J, 6)
        rows[:, 6:] *= np.abs((twists * self._twists).sum(axis=1, keepdims=True))
        for joint in self._several:
            rows[joint] = _screw(twists[joint])
        for joint, freedoms in self._varying:
            rows[joint] = 0.0
            rows[joint, 6] = np.abs(way[freedoms]).sum()
        return rows

    @cached_property
    def axes(self) -> NDArray[np.float64]:
        """(J, 6) point and direction of the axis that a joint always turns about; NaN for one that has none."""
        rows = self._units[:, :6].copy()
        rows[~rows[:, 3:].any(axis=1)] = np.nan
        return rows

    @cached_property
    def _twists(self) -> NDArray[np.float64]:
        """(J, 6) the direction, of length 1, that a joint of one freedom has its twist along; zeros for all others."""
        twists = self._subspaces.sum(axis=2)
        twists[self._several] = 0.0
        lengths = np.linalg.norm(twists, axis=1, keepdims=True)
        unit: NDArray[np.float64] = twists / np.where(lengths > 0.0, lengths, 1.0)
        return unit

    @cached_property
    def _units(self) -> NDArray[np.float64]:
        """(J, 8) what a joint of one freedom does on a twist of length 1; zeros for all others."""
        return np.array([_screw(twist) for twist in self._twists])

    @cached_property
    def _several(self) -> list[int]:
        """Joints of several freedoms."""
        return [j for j, joint in enumerate(self.model.joints) if joint.nv > 1]

    @cached_property
    def _turned(self) -> list[int]:
        """Joints whose entries of q are a quaternion, or a cosine and sine."""
        return [j for j, joint in enumerate(self.model.joints) if joint.nq > joint.nv]

    @cached_property
    def _endless(self) -> NDArray[np.int64]:
        """Freedoms of joints that turn, have no limits, are one entry of q, and are not followed by others."""
        low, high = self.model.lowerPositionLimit, self.model.upperPositionLimit
        followed = {leader_of(self.model, j) for j, joint in enumerate(self.model.joints) if j and not joint.nq}
        return np.array(
            [
                joint.idx_v
                for j, joint in enumerate(self.model.joints)
                if joint.nq == joint.nv == 1
                and j not in followed
                and low[joint.idx_q] <= -UNBOUNDED
                and high[joint.idx_q] >= UNBOUNDED
                and self._subspaces[j, 3:, joint.idx_v].any()
            ],
            dtype=np.int64,
        )

    @cached_property
    def _varying(self) -> list[tuple[int, slice]]:
        return [
            (j, slice(joint.idx_v, joint.idx_v + joint.nv))
            for j, joint in enumerate(self.model.joints)
            if joint.shortname() in VARYING
        ]

    @cached_property
    def _subspaces(self) -> NDArray[np.float64]:
        """(J, 6, nv) the twist of each joint, linear part first, in its frame, by the freedoms of all."""
        model, data = self.model, self.model.createData()
        pin.forwardKinematics(model, data, pin.neutral(model))
        subspaces = np.zeros((model.njoints, 6, model.nv))
        for j, joint in enumerate(model.joints):
            if j:
                first = joint.idx_v
                S = np.array(data.joints[j].S).reshape(6, -1)
                subspaces[j, :, first : first + S.shape[1]] = S
        return subspaces


def _screw(twist: NDArray[np.float64]) -> NDArray[np.float64]:
    """(8,) point, direction, turn and slide of a twist (6,), its linear part first."""
    linear, angular = twist[:3], twist[3:]
    turn = float(np.linalg.norm(angular))
    if turn <= LITTLE:
        return np.array([*np.zeros(6), turn, np.linalg.norm(linear)])
    axis = angular / turn
    return np.array([*(np.cross(axis, linear) / turn), *axis, turn, abs(float(axis @ linear))])


def _check_size(what: str, values: NDArray[np.float64], most: float) -> None:
    """Refuse numbers beyond a size.

    Raises:
        InvalidConfiguration: One is.
    """
    if (largest := float(np.abs(values).max(initial=0.0))) > most:
        raise InvalidConfiguration(
            f"{what} can be checked for collisions up to {most:g} rad or m only, got {largest:g}"
        )
