"""How fast the joints of a chain may move: speed, acceleration and jerk."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.kinematics import Chain

SPEED_UP = 0.2  # s from rest to full speed, where nobody says how fast a joint may speed up

Share: TypeAlias = ArrayLike | None


@checked
@dataclass(frozen=True, eq=False)
class MotionLimits:
    """Velocity, acceleration and jerk limits of n joints, the same in both directions.

    Attributes:
        velocity: (n,) rad/s or m/s.
        acceleration: (n,) rad/s^2 or m/s^2.
        jerk: (n,) rad/s^3 or m/s^3; None: not limited.
    """

    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    jerk: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        """Refuse limits that are none.

        Raises:
            InvalidSetting: A limit is not above 0 and finite, or not one a joint.
        """
        n = len(self.velocity) if np.ndim(self.velocity) else 0
        for name in ("velocity", "acceleration", "jerk"):
            given = getattr(self, name)
            if given is not None and not (array(name, given, n) > 0.0).all():
                raise InvalidSetting(f"{name} is above 0 for every joint, got {given.tolist()}")

    @staticmethod
    def of(chain: Chain, velocity: Share = None, acceleration: Share = None, jerk: Share = None) -> MotionLimits:
        """Limits for a chain, each one number for all joints or (n,) one a joint.

        Mimic joints are bounded through the joint that they follow, not by velocity limits of their own.

        Args:
            chain: The chain.
            velocity: rad/s or m/s; default: the model's.
            acceleration: rad/s^2 or m/s^2. Models have none: by default full speed is reached within 0.2 s, which is
                an assumption about your robot; its data sheet knows better.
            jerk: rad/s^3 or m/s^3; default: not limited.

        Raises:
            InvalidSetting: A limit is not above 0 and finite, or the model has no velocity for a joint.
        """
        if not isinstance(chain, Chain):
            raise InvalidSetting(f"chain: expected a Chain (e.g. mik.Chain(robot, robot.frame)), got {chain!r}")
        fastest = _each("velocity", velocity, chain.n) if velocity is not None else chain.limits.velocity
        for name, speed in zip(chain.names, fastest.tolist(), strict=True):
            if not 0.0 < speed < np.inf:
                raise InvalidSetting(
                    f"joint {name!r} has a velocity limit of {speed:g}: a motion needs one above 0 and below infinity; "
                    "pass velocity=..., in rad/s or m/s"
                )
        quickest = fastest / SPEED_UP if acceleration is None else _each("acceleration", acceleration, chain.n)
        return MotionLimits(fastest, quickest, None if jerk is None else _each("jerk", jerk, chain.n))


def _each(name: str, given: ArrayLike, n: int) -> NDArray[np.float64]:
    """One number for all joints, or one a joint, as (n,)."""
    numbers = array(name, given, "...")
    return np.full(n, float(numbers)) if numbers.ndim == 0 else array(name, numbers, n)
