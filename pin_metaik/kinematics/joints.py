"""Joints: the turns and slides that each is made of, and the entries of a configuration that its coordinates are.

Pinocchio's configurations have quaternions and pairs of cosine and sine; a chain's coordinates are angles and lengths,
one for each turn or slide. A ball joint, and the turn of a floating base, is yaw, pitch and roll about z, y and x.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import UnsupportedJoint

X, Y, Z = np.eye(3)
AS_IT_IS = pin.SE3.Identity()
EXACT = 1e-9  # m and rad, of a joint's turns and slides as Pinocchio has them
RIGID = 1e-12  # of an axis, by how much rounding may turn it
TRIED = 0.3  # rad or m, where a joint is looked at
RIGHT = math.pi / 2.0  # rad, the limits of a pitch: beyond them are the same orientations


class Entry(Enum):
    """What entries of a configuration hold."""

    NUMBER = 1
    """An angle or a length."""
    CIRCLE = 2
    """The cosine and the sine of an angle."""
    QUATERNION = 4
    """The quaternion (x, y, z, w) of yaw, pitch and roll."""


THREE = 3 * (Entry.NUMBER,)


@dataclass(frozen=True, eq=False)
class Motion:
    """How a joint, or a part of its motion, follows a coordinate: along or about ``axis`` by ``scale x + shift``.

    Attributes:
        driver: Id of the joint whose coordinate is followed: the joint itself, or the one it mimics.
        axis: (3,) unit vector in the joint frame.
        rotates: About the axis, else along it.
        scale: rad/rad or m/m, or m/rad of a screw.
        shift: rad or m.
        part: Number of the coordinate among those of the driver.
        before: Placement of the joint frame in the frame that the motion before it moves.
    """

    driver: int
    axis: NDArray[np.float64]
    rotates: bool
    scale: float = 1.0
    shift: float = 0.0
    part: int = 0
    before: pin.SE3 = AS_IT_IS

    def move(self, x: float) -> pin.SE3:
        """The placement that it gives at its driver's coordinate x, rad or m."""
        by = self.scale * x + self.shift
        linear, angular = (np.zeros(3), by * self.axis) if self.rotates else (by * self.axis, np.zeros(3))
        return self.before * pin.exp6(pin.Motion(linear, angular))


@dataclass(frozen=True, eq=False)
class Parts:
    """The coordinates of a joint.

    Attributes:
        names: What each is called, after the name of the joint; empty for the only one.
        motions: The turns and slides in order.
        entries: What the joint's entries of a configuration hold, in order.
    """

    names: tuple[str, ...]
    motions: tuple[Motion, ...]
    entries: tuple[Entry, ...]

    @property
    def screw(self) -> bool:
        """Whether a coordinate turns and slides at once, so that a whole turn is not undone."""
        return len(self.motions) > len(self.names)

    @property
    def copies(self) -> bool:
        """Whether it is one turn, by as much as its coordinate."""
        return [(motion.rotates, motion.scale) for motion in self.motions] == [(True, 1.0)]


def leader_of(model: pin.Model, joint: int) -> int:
    """Id of the joint that a joint mimics, or its own."""
    kind = model.joints[joint]
    if kind.nq:
        return joint
    # A mimic joint is a scaled copy of the coordinate at the same index.
    return next(j for j in range(1, model.njoints) if model.joints[j].nv and model.joints[j].idx_v == kind.idx_v)


def parts_of(model: pin.Model, joint: int) -> Parts:
    """The coordinates of a joint, or, of one that mimics another, how it follows that one's.

    Raises:
        UnsupportedJoint: If it is not made of turns and slides that this module knows.
    """
    driver = leader_of(model, joint)
    if driver != joint:
        mimic = model.joints[joint].extract()
        parts = _single(model, joint, driver, float(mimic.scaling), float(mimic.offset))
    else:
        parts = _parts(model, joint, model.joints[joint])
    _check(model, joint, driver, parts)
    return parts


def _parts(model: pin.Model, joint: int, kind: pin.JointModel) -> Parts:
    """The coordinates of a joint, or of a part of a composite one, that mimics no other."""
    match kind.shortname().removeprefix("JointModel"):
        case "Planar":
            return _row(_slides(joint, X, Y) + _turns(joint, Z), "x y yaw", Entry.NUMBER, Entry.NUMBER, Entry.CIRCLE)
        case "Translation":
            return _row(_slides(joint, X, Y, Z), "x y z", *THREE)
        case "Spherical":
            return _row(_turns(joint, Z, Y, X), "yaw pitch roll", Entry.QUATERNION)
        case "SphericalZYX":
            return _row(_turns(joint, Z, Y, X), "yaw pitch roll", *THREE)
        case "FreeFlyer":
            motions = _slides(joint, X, Y, Z) + _turns(joint, Z, Y, X)
            return _row(motions, "x y z yaw pitch roll", *THREE, Entry.QUATERNION)
        case "Composite":
            return _composite(model, joint, kind.extract())
        case _ if kind.nv == 1:
            return _single(*_alone(kind), 1.0, 0.0, named=joint)
        case _ if kind.nq == kind.nv == 2:
            return _universal(joint, kind)
        case _:
            raise _unsupported(model, joint, "is not made of turns and slides")


def _row(motions: tuple[Motion, ...], names: str, *entries: Entry) -> Parts:
    """Turns and slides one after the other, each with a coordinate of its own."""
    return Parts(tuple(names.split()), tuple(replace(m, part=part) for part, m in enumerate(motions)), entries)


def _slides(joint: int, *axes: NDArray[np.float64]) -> tuple[Motion, ...]:
    return tuple(Motion(joint, axis, False) for axis in axes)


def _turns(joint: int, *axes: NDArray[np.float64]) -> tuple[Motion, ...]:
    return tuple(Motion(joint, axis, True) for axis in axes)


def _alone(kind: pin.JointModel) -> tuple[pin.Model, int, int]:
    """A model with nothing but a joint of this kind, and its id, twice."""
    model = pin.Model()
    joint = model.addJoint(0, kind, pin.SE3.Identity(), "alone")
    return model, joint, joint


def _single(model: pin.Model, joint: int, driver: int, scale: float, shift: float, named: int | None = None) -> Parts:
    """One coordinate: a turn, a slide, or both along one axis, read from the joint's motion subspace S."""
    kind, data = model.joints[joint], model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    subspace: NDArray[np.float64] = np.array(data.joints[joint].S).reshape(6)
    linear, angular = subspace[:3], subspace[3:]
    slide, turn = float(np.linalg.norm(linear)), float(np.linalg.norm(angular))
    # Pinocchio's S of a mimic joint carries the scale, which is kept apart here.
    unit = (turn or slide) * np.sign(scale)
    axis = (angular if turn else linear) / unit
    motion = Motion(driver if named is None else named, axis, turn > 0.0, scale, shift)
    entries = () if kind.nq == 0 else (Entry.CIRCLE if kind.nq == 2 else Entry.NUMBER,)
    if not turn or not slide:
        return Parts(("",), (motion,), entries)
    pitch = float(linear @ axis) / unit  # m/rad
    if np.linalg.norm(linear / unit - pitch * axis) > RIGID:
        raise _unsupported(model, joint, "slides across the axis that it turns about")
    return Parts(("",), (motion, replace(motion, rotates=False, scale=pitch * scale, shift=pitch * shift)), entries)


def _universal(joint: int, kind: pin.JointModel) -> Parts:
    """Two turns about axes that cross, read from the motion subspace at zero."""
    model, alone, _ = _alone(kind)
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    S = np.array(data.joints[alone].S).reshape(6, 2)
    return _row(_turns(joint, S[3:, 0], S[3:, 1]), "1 2", Entry.NUMBER, Entry.NUMBER)


def _composite(model: pin.Model, joint: int, kind: pin.JointModelComposite) -> Parts:
    """The parts of a composite joint one after the other, numbered."""
    names: list[str] = []
    motions: list[Motion] = []
    entries: list[Entry] = []
    for number, (one, placement) in enumerate(zip(kind.joints, kind.jointPlacements, strict=True), start=1):
        parts = _parts(model, joint, one)
        for i, motion in enumerate(parts.motions):
            before = placement * motion.before if i == 0 else motion.before
            motions.append(replace(motion, part=motion.part + len(names), before=before))
        names += [f"{number}.{name}" if name else f"{number}" for name in parts.names]
        entries += parts.entries
    return Parts(tuple(names), tuple(motions), tuple(entries))


def _check(model: pin.Model, joint: int, driver: int, parts: Parts) -> None:
    """See that turns and slides move a joint as Pinocchio does."""
    kind, x = model.joints[joint], TRIED * np.arange(1, 1 + len(parts.names)) / len(parts.names)
    entries = parts.entries if joint == driver else parts_of(model, driver).entries
    q = pin.neutral(model)
    first = model.joints[driver].idx_q
    q[first : first + model.joints[driver].nq] = list(_written(entries, x.tolist()))
    data, placement = kind.createData(), pin.SE3.Identity()
    kind.calc(data, q)
    for motion in parts.motions:
        placement = placement * motion.move(x[motion.part])
    if not data.M.isApprox(placement, EXACT):
        raise _unsupported(model, joint, "does not move along and about fixed axes")


def _written(entries: tuple[Entry, ...], x: list[float]) -> Iterator[float]:
    """The entries of a configuration at coordinates x of a joint."""
    at = 0
    for entry in entries:
        match entry:
            case Entry.NUMBER:
                yield x[at]
            case Entry.CIRCLE:
                yield from (math.cos(x[at]), math.sin(x[at]))
            case Entry.QUATERNION:
                yield from quaternion(np.array(x[at : at + 3])).tolist()
        at += 3 if entry is Entry.QUATERNION else 1


def quaternion(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quaternions (..., 4), x y z w, of yaw, pitch and roll (..., 3), rad: R = Rz(yaw) Ry(pitch) Rx(roll)."""
    c, s = np.cos(0.5 * angles), np.sin(0.5 * angles)
    (cy, cp, cr), (sy, sp, sr) = (c[..., i] for i in range(3)), (s[..., i] for i in range(3))
    return np.stack(
        [
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
            cy * cp * cr + sy * sp * sr,
        ],
        axis=-1,
    )


def angles(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Yaw, pitch and roll (..., 3), rad, of quaternions (..., 4): pitch within a right angle, the others within pi.

    Where the pitch is a right angle, yaw and roll are turns about one axis: then the roll is 0.
    """
    x, y, z, w = (quaternions[..., i] for i in range(4))
    # The half angles (yaw +- roll) / 2 are exact up to a right angle of pitch, unlike those of a rotation matrix.
    plus, minus = np.arctan2(z + x, w - y), np.arctan2(z - x, w + y)
    up = np.hypot(w - y, z + x)  # sqrt(1 - sin(pitch))
    down = np.hypot(w + y, z - x)  # sqrt(1 + sin(pitch))
    pitch = 2.0 * np.arctan2(down, up) - RIGHT
    yaw, roll = plus + minus, plus - minus
    yaw = np.where(up < EXACT, 2.0 * minus, np.where(down < EXACT, 2.0 * plus, yaw))
    roll = np.where((up < EXACT) | (down < EXACT), 0.0, roll)
    return np.stack([_wrapped(yaw), pitch, _wrapped(roll)], axis=-1)


def velocities(kind: pin.JointModel, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, m) Pinocchio's velocity of a joint per velocity of each of its m coordinates, at x (m,).

    The two are one for joints whose entries of a configuration are angles and lengths. Of a floating, a planar and a
    ball joint, Pinocchio's are along the axes that the joint moves.
    """
    match kind.shortname().removeprefix("JointModel"):
        case "Planar":
            c, s = math.cos(x[2]), math.sin(x[2])
            return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        case "Spherical":
            return _angular(x)
        case "FreeFlyer":
            T = np.zeros((6, 6))
            T[:3, :3], T[3:, 3:] = pin.rpy.rpyToMatrix(x[5], x[4], x[3]).T, _angular(x[3:])
            return T
        case "Composite":
            T = np.zeros((len(x), len(x)))
            at = 0
            for one in kind.extract().joints:
                part = slice(at, at + one.nv)
                T[part, part] = velocities(one, x[part])
                at = part.stop
            return T
        case _:
            return np.eye(len(x))


def _angular(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) angular velocity, along the axes of what turns, per rate of yaw, pitch and roll."""
    (_, cp, cr), (_, sp, sr) = np.cos(angles), np.sin(angles)
    return np.array([[-sp, 0.0, 1.0], [cp * sr, cr, 0.0], [cp * cr, -sr, 0.0]])


def _wrapped(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """An angle within pi, rad."""
    return angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi))


def _unsupported(model: pin.Model, joint: int, fault: str) -> UnsupportedJoint:
    name, kind = model.names[joint], model.joints[joint]
    return UnsupportedJoint(
        f"joint {name!r} ({kind.shortname()}) {fault}: hold it where the reference has it: "
        f"Chain(..., locked=[{name!r}]) or --lock {name}"
    )
