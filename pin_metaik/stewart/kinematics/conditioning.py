"""Dexterity of a pose: nu = 1 / kappa of the homogenised Jacobian, Eq. 7-9; 1 is isotropic, 0 is singular."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from math import exp, log
from numbers import Real
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arguments import checked, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.optimize.settings import one_of
from pin_metaik.stewart.kinematics.golden import golden_section
from pin_metaik.stewart.kinematics.judging import judged
from pin_metaik.stewart.platform.geometry import Geometry
from pin_metaik.stewart.platform.poses import PoseLike, as_poses, is_many

Norm: TypeAlias = Literal["frobenius", "two"]
NORMS: tuple[Norm, ...] = get_args(Norm)  # their positions are what the compiled loops know them by

SPAN = 100.0  # the best characteristic length is looked for up to so many times either side of the platform's size


@dataclass(frozen=True)
class Dexterity:
    """How the dexterity of a Jacobian is measured: norm and characteristic length.

    Attributes:
        norm: ``"frobenius"``, ``||J|| = sqrt(tr(J J') / 6)``, or ``"two"``, the largest singular value.
        length: L that divides the rotational columns of J: ``"rm"`` the platform's radius, a number in m, or
            ``"best"``, the one with the greatest mean nu over the poses at hand (over a single pose: the best for it).

    Raises:
        InvalidSetting: No norm or length of that kind.
    """

    norm: Norm = "frobenius"
    length: float | Literal["rm", "best"] = "rm"

    def __post_init__(self) -> None:
        one_of("norm", self.norm, Norm)
        named = isinstance(self.length, str) and self.length in ("rm", "best")
        if not named and not (is_number(self.length) and 0.0 < self.length <= sys.float_info.max):  # type: ignore[operator]
            raise InvalidSetting(f"length is 'rm', 'best' or a length above zero in m, got {shown(self.length)}")

    @property
    def code(self) -> int:
        """The code of the norm in the compiled functions."""
        return NORMS.index(self.norm)


DEFAULT = Dexterity()


@checked
def characteristic_length(geometry: Geometry, poses: PoseLike, dexterity: Dexterity = DEFAULT) -> float:
    """The characteristic length L, m, that these settings give for these poses.

    Raises:
        InvalidTarget: Not poses.
    """
    match dexterity.length:
        case "rm":
            return geometry.platform_radius
        case "best":
            return best_length(geometry, poses, dexterity.norm)
        case length:
            return float(length)


@checked
def best_length(geometry: Geometry, poses: PoseLike, norm: Norm = "frobenius") -> float:
    """The one characteristic length in m with the greatest mean nu over these poses.

    At a single pose, for the Frobenius norm and six legs, that is ``L^4 = |J2|^2 |X1|^2 / (|J1|^2 |X2|^2)`` with
    ``J = [J1, J2]`` and ``J^-1 = [X1; X2]``. If every pose is singular it is the radius of the platform.
    """
    one_of("norm", norm, Norm)
    T = as_poses(poses)
    size = float(np.linalg.norm(geometry.m, axis=1).max())

    def loss(log_length: float) -> float:
        return -float(measure(geometry, T, exp(log_length), norm)[0].mean())

    found = golden_section(loss, log(size / SPAN), log(size * SPAN))
    return exp(found) if loss(found) < 0.0 else geometry.platform_radius


@checked
def conditioning(geometry: Geometry, poses: PoseLike, dexterity: Dexterity = DEFAULT) -> Array:
    """The local conditioning index nu (k,) at poses, 0 to 1, and 0 where J is singular; one number for a single pose.

    With fewer than six legs J has a row a leg, and nu = n / sqrt(tr(J J') tr((J J')^-1)).

    Args:
        geometry: The platform.
        poses: ``pin.SE3`` or (4, 4) for one pose, (k, 4, 4) or a list for many.
        dexterity: Norm and characteristic length.

    Raises:
        InvalidTarget: Not poses.
    """
    T = as_poses(poses)
    nu, _ = measure(geometry, T, characteristic_length(geometry, T, dexterity), dexterity.norm)
    return nu if is_many(poses) else nu[0]


def is_number(value: object) -> bool:
    """Whether this is a real number; True and False are not."""
    return isinstance(value, Real) and not isinstance(value, bool)


def measure(geometry: Geometry, T: Array, length: float, norm: Norm) -> tuple[Array, NDArray[np.int8]]:
    """The nu (k,) and ``PoseState`` (k,) of poses (k, 4, 4), whatever the limits allow."""
    states, nu = judged(geometry, None, T, length, NORMS.index(norm))
    return nu, states
