"""Data that a chain reads from a Pinocchio model: ids by name, limits, and which entries of q its coordinates are."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any, Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, shown
from pin_metaik.errors import FrameNotFound, InvalidConfiguration, InvalidSetting, UnknownName, UnsupportedJoint
from pin_metaik.kinematics.coordinates import Coordinates, consecutive
from pin_metaik.kinematics.joints import RIGHT, Entry, Parts, parts_of
from pin_metaik.kinematics.limits import Limits, finite_or_infinite

UNIT = 1e-6  # by how much the length of a quaternion may differ from 1


def as_configuration(model: pin.Model, q: ArrayLike) -> NDArray[np.float64]:
    """A configuration (nq,) of the model, checked.

    Raises:
        InvalidConfiguration: If its length is not nq or an entry is not finite.
    """
    given: Any = q
    if type(q) is np.ndarray and q.dtype.char == "d" and q.shape == (model.nq,) and math.isfinite(q.dot(q)):
        return given  # type: ignore[no-any-return]  # what worlds ask for thousands of times; a dot product takes a third of a sum
    return array(f"a configuration of {model.name!r}", q, model.nq, error=InvalidConfiguration)


class HasModel(Protocol):
    """A robot that has a model: a ``Robot``, Pinocchio's ``RobotWrapper``, or an object of your own."""

    @property
    def model(self) -> pin.Model:
        """Its model."""
        ...


def model_of(robot: pin.Model | HasModel) -> pin.Model:
    """A model, or that of a robot.

    Raises:
        InvalidSetting: Neither a model nor a robot that has one.
    """
    model = robot if isinstance(robot, pin.Model) else getattr(robot, "model", None)
    if not isinstance(model, pin.Model):
        advice = f"; mik.load_robot({robot!r}) loads one" if isinstance(robot, str) else ""
        raise InvalidSetting(
            f"model is a robot, e.g. mik.load_robot('panda'), or its pin.Model, got {shown(robot)}{advice}"
        )
    return model


def neutral_inside(model: pin.Model) -> NDArray[np.float64]:
    """The neutral configuration (nq,), each angle and length brought inside its limits."""
    q: NDArray[np.float64] = pin.neutral(model)
    plain = [entry for joint in range(1, model.njoints) for entry in _numbers_of(model, joint)]
    q[plain] = np.minimum(np.maximum(q[plain], model.lowerPositionLimit[plain]), model.upperPositionLimit[plain])
    return q


def _numbers_of(model: pin.Model, joint: int) -> list[int]:
    """The entries of a joint that are angles and lengths, of which alone limits are told."""
    kind, found = model.joints[joint], list[int]()
    if kind.nq == kind.nv:
        return list(range(kind.idx_q, kind.idx_q + kind.nq))
    entry = int(kind.idx_q)
    with suppress(UnsupportedJoint):  # it stays at neutral
        for part in parts_of(model, joint).entries:
            found += [entry] if part is Entry.NUMBER else []
            entry += part.value
    return found


def entries_of(model: pin.Model, joints: list[int]) -> NDArray[np.int64]:
    """Where in a configuration joints given by id are, in order."""
    kinds = [model.joints[j] for j in joints]
    return np.array([e for kind in kinds for e in range(kind.idx_q, kind.idx_q + kind.nq)], dtype=np.int64)


def check_turns(model: pin.Model, joints: list[int], q: NDArray[np.float64]) -> None:
    """Refuse a configuration q (nq,) with a quaternion, or a cosine and sine, of a joint that is not of length 1.

    Raises:
        InvalidConfiguration: If so; the joint is named.
    """
    for j in joints:
        entries = entries_of(model, [j])
        alone = pin.neutral(model)
        alone[entries] = q[entries]
        if not pin.isNormalized(model, alone, UNIT):
            raise InvalidConfiguration(
                f"joint {model.names[j]!r} is at {q[entries]}: its quaternion, or cosine and sine, has not length 1; "
                "pin.normalize(model, q) makes it so"
            )


def frame_id(model: pin.Model, name: str) -> int:
    """Id of a frame; of a joint and a link of the same name, the link."""
    ids = [i for i, frame in enumerate(model.frames) if frame.name == name]
    if not ids:
        raise FrameNotFound(str(name), {frame.name for frame in model.frames} - {"universe"})
    return next((i for i in ids if model.frames[i].type == pin.FrameType.BODY), ids[0])


def joint_id(model: pin.Model, name: str) -> int:
    """Id of a joint."""
    if not model.existJointName(name):
        raise UnknownName("joint", str(name), list(model.names)[1:])
    return int(model.getJointId(name))


def coordinates_of(model: pin.Model, drivers: list[int], parts: dict[int, Parts]) -> Coordinates:
    """The coordinates of joints given by id, in order."""
    joints: list[int] = []
    places: dict[Entry, list[tuple[int, int]]] = {kind: [] for kind in Entry}  # columns of x and entries of q
    for driver in drivers:
        entry = int(model.joints[driver].idx_q)
        for kind in parts[driver].entries:
            places[kind].append((len(joints), entry))
            entry += kind.value
            joints += [driver] * (3 if kind is Entry.QUATERNION else 1)
    numbers, circles, turns = (np.array(places[kind], dtype=np.int64).reshape(-1, 2).T for kind in Entry)
    plain, plain_q = consecutive(numbers[0]), consecutive(numbers[1])
    return Coordinates(np.array(joints, dtype=np.int64), plain, plain_q, *circles, *turns)


def names_of(model: pin.Model, drivers: list[int], parts: dict[int, Parts]) -> tuple[str, ...]:
    """A name for each coordinate: the joint's, and of a joint with several which of them, as in ``root_joint.x``."""
    return tuple(f"{model.names[j]}.{name}" if name else model.names[j] for j in drivers for name in parts[j].names)


def limits_of(model: pin.Model, drivers: list[int], parts: dict[int, Parts], mimicked: set[int]) -> Limits:
    """Limits of the driving joints. A ``mimicked`` joint is not multi-turn, because its followers may not be."""
    lower, upper, velocity, turns, multi_turn = list[float](), list[float](), list[float](), list[bool](), list[bool]()
    for j in drivers:
        entry, rotates = int(model.joints[j].idx_q), {m.part: m.rotates for m in reversed(parts[j].motions)}
        for kind in parts[j].entries:
            match kind:
                case Entry.NUMBER:
                    lower.append(model.lowerPositionLimit[entry])
                    upper.append(model.upperPositionLimit[entry])
                case Entry.CIRCLE:
                    lower.append(-np.inf)
                    upper.append(np.inf)
                case Entry.QUATERNION:
                    lower += [-np.inf, -RIGHT, -np.inf]
                    upper += [np.inf, RIGHT, np.inf]
            entry += kind.value
        count = len(parts[j].names)
        velocity += model.upperVelocityLimit[model.joints[j].idx_v :][:count].tolist()
        turns += [rotates[part] for part in range(count)]
        multi_turn += [rotates[part] and not parts[j].screw and j not in mimicked for part in range(count)]
    low, high = finite_or_infinite(lower), finite_or_infinite(upper)
    room = np.array(multi_turn) & (high - low >= 2.0 * np.pi)
    return Limits(low, high, finite_or_infinite(velocity), np.array(turns), room, names_of(model, drivers, parts))
