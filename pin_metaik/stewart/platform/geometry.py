"""Where the joints of a general Stewart platform are, and which leg joins which two of them.

Base joints B lie on a circle of radius rb about O, platform joints M on a circle of radius rm; both circles are planar,
angles count from the x axis. Or the joints of a side are anywhere, as those of calibrated platforms are. Several legs
may share a joint: the connection matrix says which joints have a leg between them, and that matrix is all that
distinguishes the types 3x3 (three joints a side) to 6x6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import degrees, isfinite, tau
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked, checked_as, instance, number, shown
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.stewart.platform.actuation import SLIDES, Actuation
from pin_metaik.stewart.platform.servo_legs import ServoLegs
from pin_metaik.stewart.platform.servos import Servos

FEWEST_LEGS, MOST_LEGS = 3, 6

Point: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True)
class Geometry:
    """A general Stewart platform: the joints of both sides and the legs between them. Lengths in m, angles in rad.

    ``Geometry(rb, rm, base_angles, platform_angles, legs)`` has its joints on circles; ``Geometry.of_joints`` takes
    points. One side may have its joints on a circle and the other as points.

    Attributes:
        base_radius: rb, radius of the fixed circle. For joints given as points: root mean square distance from their
            mean.
        platform_radius: rm, radius of the moving circle, likewise.
        base_angles: Angles of the joints B1, B2 ... on the fixed circle, ascending, within one turn; empty for joints
            given as points.
        platform_angles: Angles of the joints M1, M2 ... on the moving circle, likewise.
        legs: The (base joint, platform joint) of each of the 3 to 6 legs, counted from 0.
        reference: The point P whose pose is given by poses, in the frame in which the platform's joints are given;
            default: the centre of its circle.
        base: The joints B1, B2 ... as points x, y, z; None: they are on a circle.
        platform: The joints M1, M2 ... likewise, in the platform's frame.
        servos: A servo for each leg, with its shaft at the base joint; None: the legs are linear actuators.

    Raises:
        InvalidGeometry: A radius that is not above zero, angles out of order, joints in one place, a leg to a joint
            that does not exist, a joint without a leg, two legs between the same joints, not 3 to 6 legs, or more or
            fewer servos than legs.
    """

    base_radius: float = 0.0
    platform_radius: float = 0.0
    base_angles: tuple[float, ...] = ()
    platform_angles: tuple[float, ...] = ()
    legs: tuple[tuple[int, int], ...] = ()
    reference: Point = (0.0, 0.0, 0.0)
    base: tuple[Point, ...] | None = None
    platform: tuple[Point, ...] | None = None
    servos: Servos | None = None

    def __post_init__(self) -> None:
        for side, letter in (("base", "B"), ("platform", "M")):
            for name, value in _side(self, side, letter).items():
                object.__setattr__(self, name, value)
        legs = _legs(self.legs, len(self.base_joints), len(self.platform_joints))
        object.__setattr__(self, "legs", legs)
        instance((Servos, type(None)), servos=self.servos)
        if self.servos is not None and self.servos.legs != self.n:
            raise InvalidGeometry(f"servos have {self.servos.legs} axes for {self.n} legs: one each")

    @classmethod
    @checked_as(InvalidGeometry)
    def of_joints(
        cls,
        base: ArrayLike,
        platform: ArrayLike,
        legs: Sequence[tuple[int, int]] | None = None,
        reference: ArrayLike = (0.0, 0.0, 0.0),
        servos: Servos | None = None,
    ) -> Geometry:
        """A platform with its joints given as points.

        Args:
            base: B1, B2 ... in the base frame, m (joints, 3).
            platform: M1, M2 ... in the platform frame, m (joints, 3).
            legs: The (base joint, platform joint) of each leg; default: the first to the first, the second to the
                second ...
            reference: The point P whose pose is given by poses, in the platform frame, m (3,).
            servos: The servos, if the legs are rods moved by servos.

        Raises:
            InvalidGeometry: Joints or legs that cannot be those of a platform.
        """
        sides = [
            tuple(map(tuple, array(name, joints, "joints", 3, error=InvalidGeometry).tolist()))
            for name, joints in (("base", base), ("platform", platform))
        ]
        if legs is None and len(sides[0]) != len(sides[1]):
            raise InvalidGeometry(
                f"give legs: pairs of one of {len(sides[0])} base and one of {len(sides[1])} platform joints"
            )
        joined = tuple((i, i) for i in range(len(sides[0]))) if legs is None else tuple(legs)
        place = tuple(array("reference", reference, 3, error=InvalidGeometry).tolist())
        return cls(legs=joined, reference=place, base=sides[0], platform=sides[1], servos=servos)

    @property
    def n(self) -> int:
        """Number of legs."""
        return len(self.legs)

    @cached_property
    def actuation(self) -> Actuation:
        """Kind of the legs: linear actuators (slides), or rods moved by servos."""
        return SLIDES if self.servos is None else ServoLegs(self.servos)

    @property
    def type(self) -> str:
        """Number of joints of base and platform, as in the literature: ``"6x3"``."""
        return f"{len(self.base_joints)}x{len(self.platform_joints)}"

    @property
    def connection(self) -> NDArray[np.int64]:
        """The connection matrix (joints of the base, joints of the platform): 1 where a leg joins the two."""
        matrix = np.zeros((len(self.base_joints), len(self.platform_joints)), dtype=np.int64)
        matrix[tuple(np.transpose(self.legs))] = 1
        return matrix

    @cached_property
    def base_joints(self) -> Array:
        """Positions of B1, B2 ... in the base frame, m (joints, 3)."""
        on_base = on_circle(self.base_radius, self.base_angles) if self.base is None else np.array(self.base)
        return _frozen(on_base)

    @cached_property
    def platform_joints(self) -> Array:
        """Positions of M1, M2 ... from P in the platform frame, m (joints, 3)."""
        on_platform = (
            on_circle(self.platform_radius, self.platform_angles) if self.platform is None else np.array(self.platform)
        )
        return _frozen(on_platform - np.array(self.reference))

    @property
    def base_centre(self) -> Array:
        """Centre of the fixed circle, or the middle of the joints of the base, m (3,) in the base frame."""
        return np.zeros(3) if self.base is None else self.base_joints.mean(axis=0)

    @property
    def platform_centre(self) -> Array:
        """Centre of the moving circle, or the middle of the joints of the platform, m (3,) from P in its frame."""
        return -np.array(self.reference) if self.platform is None else self.platform_joints.mean(axis=0)

    @cached_property
    def b(self) -> Array:
        """Base end b_i of each leg in the base frame, m (n, 3)."""
        return _frozen(self.base_joints[[base for base, _ in self.legs]])

    @cached_property
    def m(self) -> Array:
        """Platform end m_i of each leg in the platform frame, m (n, 3)."""
        return _frozen(self.platform_joints[[platform for _, platform in self.legs]])

    @cached_property
    def pairs(self) -> NDArray[np.int64]:
        """Pairs of legs that share no joint, and could therefore touch (p, 2)."""
        apart = [
            (i, j) for (i, (bi, mi)), (j, (bj, mj)) in combinations(enumerate(self.legs), 2) if bi != bj and mi != mj
        ]
        pairs = np.array(apart, dtype=np.int64).reshape(-1, 2)
        pairs.flags.writeable = False
        return pairs

    @cached_property
    def arrays(self) -> tuple[Array, Array, NDArray[np.int64]]:
        """b, m and pairs for the compiled functions, which need writable arrays; do not change them."""
        return self.b.copy(), self.m.copy(), self.pairs.copy()

    @property
    def joint_gap(self) -> float:
        """Least distance between the centres of two joints of a side, m."""
        base = gaps(self.base_joints) if self.base else chords(self.base_radius, np.array(self.base_angles))
        moving = (
            gaps(self.platform_joints)
            if self.platform
            else chords(self.platform_radius, np.array(self.platform_angles))
        )
        return float(min(base.min(), moving.min()))

    def __str__(self) -> str:
        legs = ", ".join(f"B{base + 1}-M{platform + 1}" for base, platform in self.legs)
        return f"{self.type}, {self.n} legs: {legs}"


def on_circle(radius: float, angles: ArrayLike) -> Array:
    """Points (k, 3) of a circle of this radius in the plane z = 0, at angles (k,) in rad."""
    angles = np.asarray(angles, dtype=float)
    return radius * np.column_stack((np.cos(angles), np.sin(angles), np.zeros_like(angles)))


def chords(radius: float, angles: Array) -> Array:
    """Distance (k,) from each of the joints at ascending angles (k,) to the next, round the circle.

    Negative where the angles are out of order: by how much they are.
    """
    steps = np.append(angles[1:], angles[0] + tau) - angles
    return np.asarray(2.0 * radius * np.sin(np.maximum(np.minimum(0.5 * steps, np.pi), -np.pi / 2)))


def gaps(joints: Array) -> Array:
    """Distances (p,) between all pairs of joints (k, 3)."""
    i, j = np.triu_indices(len(joints), 1)
    return np.asarray(np.linalg.norm(joints[i] - joints[j], axis=1))


@checked
def legs_of(connection: ArrayLike) -> tuple[tuple[int, int], ...]:
    """The legs of a connection matrix (joints of the base, joints of the platform) of zeros and ones, row by row.

    Raises:
        InvalidGeometry: Not a matrix of zeros and ones.
    """
    matrix = array(
        "a connection matrix of zeros and ones", connection, "base joints", "platform joints", error=InvalidGeometry
    )
    if not np.isin(matrix, (0.0, 1.0)).all():
        raise InvalidGeometry(
            f"a connection matrix has a row of zeros and ones for every base joint, got {connection!r}"
        )
    return tuple((int(base), int(platform)) for base, platform in np.argwhere(matrix == 1.0))


def _frozen(array: Array) -> Array:
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array


def _number(name: str, value: object) -> float:
    if type(value) is float and isfinite(value):  # a design makes thousands of geometries
        return value
    return float(number(name, value, InvalidGeometry))


def _numbers(name: str, values: Any) -> tuple[float, ...]:
    listed = values.tolist() if isinstance(values, np.ndarray) else values
    if isinstance(listed, str) or not isinstance(listed, Sequence):
        raise InvalidGeometry(f"{name} is a list of numbers, got {shown(values)}")
    return tuple(_number(name, value) for value in listed)


def _side(geometry: Geometry, side: str, letter: str) -> dict[str, Any]:
    """The joints of one side: a circle as given, or points and their distances."""
    radius, angles = f"{side}_radius", f"{side}_angles"
    joints = getattr(geometry, side)
    reference = _numbers("reference", geometry.reference)
    if len(reference) != 3:
        raise InvalidGeometry(f"reference is three lengths x, y, z, got {geometry.reference!r}")
    if joints is None:
        given = {
            radius: _radius(radius, getattr(geometry, radius)),
            angles: _angles(angles, letter, getattr(geometry, angles)),
        }
        return {**given, "reference": reference}
    points = array(f"{side}: the joints as points", joints, "joints", 3, error=InvalidGeometry)
    if len(points) < 2 or not gaps(points).min() > 0.0:
        raise InvalidGeometry(f"{side} has at least two joints, each in a place of its own, got {shown(joints)}")
    spread = float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()))
    if len(getattr(geometry, angles)) or getattr(geometry, radius) not in (0.0, spread):
        raise InvalidGeometry(f"give the joints of the {side} as points or by {radius} and {angles}, not both")
    return {side: tuple(map(tuple, points.tolist())), radius: spread, angles: (), "reference": reference}


def _radius(name: str, value: object) -> float:
    radius = _number(name, value)
    if not radius > 0.0:
        raise InvalidGeometry(f"{name} is above zero, got {radius:g} m")
    return radius


def _angles(name: str, side: str, values: Any) -> tuple[float, ...]:
    angles = _numbers(name, values)
    if len(angles) < 2:
        raise InvalidGeometry(f"{name} is one angle for each of at least two joints, got {values!r}")
    for k, (before, angle) in enumerate(zip(angles, angles[1:], strict=False), start=2):
        if angle <= before:
            later = angle + tau * ((before - angle) // tau + 1)
            hint = f"; write {degrees(later):.6g} deg" if later < angles[0] + tau else ""
            raise InvalidGeometry(
                f"{name} ascend within one turn, but {side}{k} at {degrees(angle):.6g} deg does not come after "
                f"{side}{k - 1} at {degrees(before):.6g} deg{hint}"
            )
    if angles[-1] >= angles[0] + tau:
        raise InvalidGeometry(
            f"{name} ascend within one turn, but {side}{len(angles)} at {degrees(angles[-1]):.6g} deg is a turn or "
            f"more after {side}1 at {degrees(angles[0]):.6g} deg"
        )
    return angles


def _legs(legs: Any, bases: int, platforms: int) -> tuple[tuple[int, int], ...]:
    try:
        ends = [(int(base), int(platform)) for base, platform in legs]
    except (TypeError, ValueError, OverflowError):
        raise InvalidGeometry(f"legs are pairs (base joint, platform joint) counted from 0, got {legs!r}") from None
    if not FEWEST_LEGS <= len(ends) <= MOST_LEGS:
        raise InvalidGeometry(f"a platform has {FEWEST_LEGS} to {MOST_LEGS} legs, got {len(ends)}")
    for leg, (base, platform) in enumerate(ends, start=1):
        for side, joint, count in (("B", base, bases), ("M", platform, platforms)):
            if not 0 <= joint < count:
                raise InvalidGeometry(
                    f"leg {leg} is joined to {side}{joint + 1}, which does not exist: "
                    f"there are {side}1 to {side}{count}"
                )
    for (i, ends_i), (j, ends_j) in combinations(enumerate(ends, start=1), 2):
        if ends_i == ends_j:
            raise InvalidGeometry(f"legs {i} and {j} both join B{ends_i[0] + 1} and M{ends_i[1] + 1}")
    for column, side, count in ((0, "B", bases), (1, "M", platforms)):
        for joint in sorted(set(range(count)) - {leg[column] for leg in ends}):
            raise InvalidGeometry(f"joint {side}{joint + 1} has no leg; leave it out or join a leg to it")
    return tuple(ends)
