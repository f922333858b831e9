"""Joint torques against gravity, as a criterion for choosing among solutions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, number
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.kinematics import Chain


@checked
def gravity_torque(chain: Chain, payload: float = 0.0, at: ArrayLike = (0.0, 0.0, 0.0)) -> Callable[[Array], float]:
    """The norm of the torques (N m) and forces (N) that hold a chain's joints against gravity: Pinocchio's g(q).

    Args:
        chain: The chain whose joints are counted; all masses of the model load them.
        payload: Mass that the chain's frame holds, kg.
        at: (3,) its centre of mass in that frame, m.

    Returns:
        A criterion: a number for a configuration (nq,), lower is better, for ``IKSolver(select=...)`` and
        ``SelfMotions.best``.

    Raises:
        InvalidSetting: If nothing has a mass, or the payload is below 0, or ``at`` is not (3,).
    """
    loads = gravity_loads(chain, payload, at)
    return lambda q: float(np.linalg.norm(loads(q)))


def gravity_loads(chain: Chain, payload: float = 0.0, at: ArrayLike = (0.0, 0.0, 0.0)) -> Callable[[Array], Array]:
    """The torques (N m) and forces (N) themselves, (n,), of the chain's coordinates; as for ``gravity_torque``."""
    mass, place = number("payload", payload), array("at", at, 3, error=InvalidSetting)
    model, frame = chain.model, chain.frame_ids[0]
    if mass < 0.0:
        raise InvalidSetting(f"payload is a mass of at least 0 kg, got {mass:g}")
    if mass == 0.0 and not any(inertia.mass > 0.0 for inertia in list(model.inertias)[1:]):
        raise InvalidSetting(f"the bodies of {model.name!r} have no mass: give a payload, or a model with inertias")
    weight = -mass * np.asarray(model.gravity.linear)

    def loads(q: Array) -> Array:
        data = chain.data
        held = np.array(pin.computeGeneralizedGravity(model, data, q))
        if mass > 0.0:
            J = pin.computeFrameJacobian(model, data, q, frame, pin.ReferenceFrame.LOCAL)
            turn = pin.updateFramePlacement(model, data, frame).rotation
            held += (turn @ (J[:3] - pin.skew(place) @ J[3:])).T @ weight
        held_by: Array = held @ chain.tangent(chain.x(q))
        return held_by

    return loads
