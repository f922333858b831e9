"""What a chain reads from a Pinocchio model: ids by name, limits, and which entries of q its coordinates are."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from pin_metaik.errors import FrameNotFound, InvalidConfiguration, UnknownName
from pin_metaik.kinematics.coordinates import Coordinates, consecutive
from pin_metaik.kinematics.limits import Limits, finite_or_infinite
from pin_metaik.kinematics.paths import motion_of


def as_configuration(model: pin.Model, q: ArrayLike) -> NDArray[np.float64]:
    """A configuration (nq,) of the model, checked.

    Raises:
        InvalidConfiguration: If its length is not nq or an entry is not finite.
    """
    try:
        configuration = np.asarray(q, dtype=float)
    except (TypeError, ValueError):
        raise InvalidConfiguration(f"a configuration is {model.nq} numbers, got {q!r}") from None
    if configuration.shape != (model.nq,):
        raise InvalidConfiguration(
            f"a configuration of {model.name!r} has shape ({model.nq},), got {configuration.shape}"
        )
    if not math.isfinite(np.add.reduce(configuration)):
        raise InvalidConfiguration(f"a configuration has finite entries, got {configuration}")
    return configuration


def entry_limits(model: pin.Model) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Limits (nq,) of the entries of q that are a joint's coordinate; pairs and quaternions have none."""
    least, most = np.full(model.nq, -np.inf), np.full(model.nq, np.inf)
    for joint in list(model.joints)[1:]:
        if joint.nq == 1:
            least[joint.idx_q] = model.lowerPositionLimit[joint.idx_q]
            most[joint.idx_q] = model.upperPositionLimit[joint.idx_q]
    return least, most


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
    """Their limits; those ``mimicked`` do not wind, for the joints that follow them might not."""
    lower = finite_or_infinite([model.lowerPositionLimit[model.joints[j].idx_q] for j in drivers])
    upper = finite_or_infinite([model.upperPositionLimit[model.joints[j].idx_q] for j in drivers])
    velocity = finite_or_infinite([model.upperVelocityLimit[model.joints[j].idx_v] for j in drivers])
    turns = np.array([motion_of(model, j).rotates for j in drivers])
    pair = np.array([model.joints[j].nq == 2 for j in drivers])
    lower[pair], upper[pair] = -np.inf, np.inf
    winds = turns & (upper - lower >= 2.0 * np.pi) & [j not in mimicked for j in drivers]
    return Limits(lower, upper, velocity, turns, winds, names)
