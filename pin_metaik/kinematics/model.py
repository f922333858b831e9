"""Data that a chain reads from a Pinocchio model: ids by name, limits, and which entries of q its coordinates are."""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, shown
from pin_metaik.errors import FrameNotFound, InvalidConfiguration, InvalidSetting, UnknownName
from pin_metaik.kinematics.coordinates import Coordinates, consecutive
from pin_metaik.kinematics.limits import Limits, finite_or_infinite
from pin_metaik.kinematics.paths import motions_of

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
    """The neutral configuration (nq,), each joint with one coordinate brought inside its limits."""
    q: NDArray[np.float64] = pin.neutral(model)
    single = [joint.idx_q for joint in list(model.joints)[1:] if joint.nq == 1]
    q[single] = np.minimum(np.maximum(q[single], model.lowerPositionLimit[single]), model.upperPositionLimit[single])
    return q


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


def coordinates_of(model: pin.Model, drivers: list[int]) -> Coordinates:
    """The coordinates of joints given by id."""
    columns = np.arange(len(drivers))
    entry = np.array([model.joints[j].idx_q for j in drivers], dtype=np.int64)
    circular = np.array([model.joints[j].nq == 2 for j in drivers], dtype=bool)
    return Coordinates(
        np.array(drivers, dtype=np.int64),
        consecutive(columns[~circular]),
        consecutive(entry[~circular]),
        columns[circular],
        entry[circular],
    )


def limits_of(model: pin.Model, drivers: list[int], names: tuple[str, ...], mimicked: set[int]) -> Limits:
    """Limits of the driving joints. A ``mimicked`` joint is not multi-turn, because its followers may not be."""
    lower = finite_or_infinite([model.lowerPositionLimit[model.joints[j].idx_q] for j in drivers])
    upper = finite_or_infinite([model.upperPositionLimit[model.joints[j].idx_q] for j in drivers])
    velocity = finite_or_infinite([model.upperVelocityLimit[model.joints[j].idx_v] for j in drivers])
    motions = [motions_of(model, j) for j in drivers]
    turns = np.array([parts[0].rotates for parts in motions])
    alone = np.array([len(parts) == 1 for parts in motions])  # a turn that slides, too, is not undone by a whole turn
    pair = np.array([model.joints[j].nq == 2 for j in drivers])
    lower[pair], upper[pair] = -np.inf, np.inf
    winds = turns & alone & (upper - lower >= 2.0 * np.pi) & [j not in mimicked for j in drivers]
    return Limits(lower, upper, velocity, turns, winds, names)
