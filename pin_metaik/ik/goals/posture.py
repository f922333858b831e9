"""The goal of joints at given values, or near a configuration."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidTarget, UnknownName
from pin_metaik.ik.goals.bounded import Bounded
from pin_metaik.ik.goals.placed import KEPT, Placed
from pin_metaik.ik.goals.vectors import check_range
from pin_metaik.kinematics import Chain


@checked_as(InvalidTarget)
@dataclass(frozen=True, eq=False)
class Posture(Bounded):
    """Joints of the chain at given values, or between two values: y = x; rad and m weighted alike.

    ``Posture(q0)`` asks for a configuration; as a wish it keeps the robot as near to it as the other goals allow.

    Attributes:
        joints: A configuration (nq,), of which the chain's joints are used, or a mapping from names of joints to a
            value or a range (least, most).

    Raises:
        InvalidTarget: If there are no values, one is not finite, or a range is empty.
    """

    joints: ArrayLike | Mapping[str, float | tuple[float, float]]
    unit: ClassVar[str] = "rad"

    def __post_init__(self) -> None:
        """Check everything once, where it enters."""
        super().__post_init__()
        if isinstance(self.joints, Mapping):
            if not self.joints:
                raise InvalidTarget("a posture needs at least one joint, got none")
            spans = {name: _as_span(name, value) for name, value in self.joints.items()}
            object.__setattr__(self, "joints", spans)
        else:
            object.__setattr__(self, "joints", array("a posture", self.joints, "nq", error=InvalidTarget).copy())

    @checked
    def check(self, chain: Chain) -> None:
        """Whether the goal makes sense for a chain.

        Raises:
            UnknownName: If one of the joints is not a coordinate of the chain.
            InvalidTarget: If a value is outside the limits of its joint by more than the tolerance.
            InvalidConfiguration: If the configuration is not one of the chain's model.
        """
        columns, least, most = joints_of(self, chain)
        lower, upper = chain.limits.lower[columns], chain.limits.upper[columns]
        for i in np.flatnonzero((most < lower - self.tolerance) | (least > upper + self.tolerance)):
            name = chain.names[columns[i]]
            wanted = f"{least[i]:g}" if least[i] == most[i] else f"{least[i]:g} to {most[i]:g}"
            raise InvalidTarget(f"joint {name!r} at {wanted} is outside its limits, {lower[i]:g} to {upper[i]:g}")

    def _values(self, at: Placed) -> Array:
        columns, least, most = joints_of(self, at.chain)
        periodic, x = at.chain.limits.periodic[columns], at.x[columns]
        if periodic.any():  # a continuous joint, by the shorter way round from the middle of its range
            middle = 0.5 * (least + most)
            turned = middle + np.remainder(x - middle + np.pi, 2.0 * np.pi) - np.pi
            x = np.where(periodic & np.isfinite(middle), turned, x)
        return x

    def _slopes(self, at: Placed) -> Array:
        return np.eye(at.chain.n)[joints_of(self, at.chain)[0]]

    def _bounds(self, at: Placed) -> tuple[Array, Array]:
        return joints_of(self, at.chain)[1:]


@lru_cache(KEPT)
def joints_of(posture: Posture, chain: Chain) -> tuple[list[int], Array, Array]:
    """Columns (m,) of the coordinates that a posture is about, and the bounds (m,) of each of them."""
    joints = posture.joints
    if isinstance(joints, Mapping):
        for name in joints:
            if name not in chain.names:
                raise UnknownName("joint of the chain", str(name), chain.names)
        spans = np.array([*joints.values()], dtype=float)
        return [chain.names.index(name) for name in joints], spans[:, 0], spans[:, 1]
    x = chain.x(np.asarray(joints))
    return [*range(chain.n)], x, x


def _as_span(name: str, value: float | tuple[float, float]) -> tuple[float, float]:
    """A number, or a range, as a range."""
    several = isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)
    span = value if several else (value, value)
    least, most = array(f"joint {name!r}", span, 2, error=InvalidTarget, finite=False)
    if not math.isfinite(least) and least == most:
        raise InvalidTarget(f"a posture gives joint {name!r} a finite value or a range (least, most), got {value!r}")
    check_range(f"joint {name!r}", least, most)
    return float(least), float(most)
