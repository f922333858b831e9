"""Denavit-Hartenberg tables and their forward kinematics as the textbooks multiply it, in metres and radians."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from pin_metaik.arguments import array, checked, checked_as
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidConfiguration, InvalidTable

Convention = Literal["standard", "modified"]
JointType = Literal["revolute", "continuous", "prismatic"]


@checked_as(InvalidTable)
@dataclass(frozen=True)
class DHRow:
    """One joint and its four DH constants; q is added to theta, or to d for a prismatic joint.

    Attributes:
        a: Length along x (m); in the modified convention that of link i-1.
        alpha: Twist about x (rad); in the modified convention that of link i-1.
        d: Length along z (m); of a prismatic joint, at q = 0.
        theta: Angle about z (rad); of a turning joint, at q = 0.
        type: Revolute, continuous (revolute without limits) or prismatic.
        lower: Least q (rad or m); -inf if continuous.
        upper: Greatest q (rad or m); inf if continuous.
        velocity: Greatest speed (rad/s or m/s).
        effort: Greatest torque or force (N m or N).
        name: Name of the joint; if empty, joint_1, joint_2, ...

    Raises:
        InvalidTable: If a number is not finite, limits are crossed, or a joint has limits and is continuous.
    """

    a: float = 0.0
    alpha: float = 0.0
    d: float = 0.0
    theta: float = 0.0
    type: JointType = "revolute"
    lower: float = -np.pi
    upper: float = np.pi
    velocity: float = np.pi
    effort: float = 100.0
    name: str = ""

    def __post_init__(self) -> None:
        _one_of("type", self.type, get_args(JointType))
        for key in ("a", "alpha", "d", "theta", "velocity", "effort"):
            if not isfinite(getattr(self, key)):
                raise InvalidTable(f"{key} = {getattr(self, key)} is not finite")
        for key in ("velocity", "effort"):
            if getattr(self, key) <= 0:
                raise InvalidTable(f"{key} = {getattr(self, key)} is not above zero")
        if self.type == "continuous":
            if (self.lower, self.upper) != (-inf, inf):
                raise InvalidTable("a continuous joint has no limits: take them out, or make it revolute")
        elif not (isfinite(self.lower) and isfinite(self.upper)):
            raise InvalidTable(f"limits [{self.lower}, {self.upper}] are not finite")
        elif self.lower > self.upper:
            raise InvalidTable(f"limits are crossed: lower {self.lower:g} is above upper {self.upper:g}")


@checked_as(InvalidTable)
@dataclass(frozen=True)
class Placement:
    """A fixed transform: R = Rz(yaw) Ry(pitch) Rx(roll), as URDF has it.

    Attributes:
        xyz: Translation (m).
        rpy: Roll, pitch, yaw (rad).
    """

    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not np.isfinite([*self.xyz, *self.rpy]).all():
            raise InvalidTable(f"xyz = {self.xyz}, rpy = {self.rpy} are not all finite")

    @property
    def matrix(self) -> Array:
        """The transform as a 4x4 matrix."""
        roll, pitch, yaw = self.rpy
        turn = _turn("z", yaw) @ _turn("y", pitch) @ _turn("x", roll)
        turn[:3, 3] = self.xyz
        return turn


@checked_as(InvalidTable)
@dataclass(frozen=True)
class DHTable:
    """A serial arm as a DH table.

    Attributes:
        name: Name of the robot.
        convention: "standard", A = Rz(theta) Tz(d) Tx(a) Rx(alpha) (Denavit and Hartenberg 1955), or "modified", A =
            Rx(alpha) Tx(a) Rz(theta) Tz(d) with a and alpha of the previous link (Craig 1986).
        rows: One row per joint, from the base.
        base: Pose of frame 0 in the world.
        tool: Pose of the tool frame in the frame of the last row.
        description: The robot, and the assumptions of the table.
        source: Where its numbers were published.

    Raises:
        InvalidTable: If it has no rows, or two of its joints have the same name.
    """

    name: str
    convention: Convention
    rows: tuple[DHRow, ...]
    base: Placement = Placement()
    tool: Placement = Placement()
    description: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        _one_of("convention", self.convention, get_args(Convention))
        if not self.rows:
            raise InvalidTable("a table needs at least one joint")
        for name in (self.name, *self.joint_names):
            if not name.strip() or not name.isprintable():
                raise InvalidTable(f"{name!r} is not a name: it needs characters, and printable ones only")
        for i, name in enumerate(self.joint_names):
            if name in self.joint_names[:i]:
                raise InvalidTable(f"joints {self.joint_names.index(name) + 1} and {i + 1} are both named {name!r}")

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, from the base."""
        return tuple(row.name or f"joint_{i}" for i, row in enumerate(self.rows, start=1))

    @checked
    def frames(self, q: ArrayLike) -> Array:
        """Frames 0 (the base) to n in the world.

        Args:
            q: Joint positions (rad, m), one per row.

        Returns:
            Transforms, (n + 1, 4, 4).

        Raises:
            InvalidConfiguration: If q has not one finite number per joint.
        """
        positions = array(
            f"{self.name} needs {len(self.rows)} finite joint positions", q, len(self.rows), error=InvalidConfiguration
        )
        T = [self.base.matrix]
        for row, position in zip(self.rows, positions, strict=True):
            theta = row.theta if row.type == "prismatic" else row.theta + position
            d = row.d + position if row.type == "prismatic" else row.d
            along_z = _turn("z", theta) @ _shift("z", d)
            along_x = _shift("x", row.a) @ _turn("x", row.alpha)
            T.append(T[-1] @ (along_z @ along_x if self.convention == "standard" else along_x @ along_z))
        return np.array(T)

    @checked
    def fk(self, q: ArrayLike) -> Array:
        """Tool frame in the world, 4x4: the DH product between base and tool.

        Raises:
            InvalidConfiguration: If q has not one finite number per joint.
        """
        tip: Array = self.frames(q)[-1] @ self.tool.matrix
        return tip


def _turn(axis: Literal["x", "y", "z"], angle: float) -> Array:
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[j, i] = np.sin(angle)
    T[i, j] = -T[j, i]
    return T


def _shift(axis: Literal["x", "z"], length: float) -> Array:
    T = np.eye(4)
    T["xyz".index(axis), 3] = length
    return T


def _one_of(key: str, value: object, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InvalidTable(f"{key} = {value!r} is not one of {', '.join(known)}")
