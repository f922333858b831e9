"""Pickles of Pinocchio's models, which Pinocchio itself cannot take if a joint mimics another.

What Pinocchio unpickles has lost how many columns a joint has that mimics another, and the first forward kinematics
with it ends the process. Here these joints are made anew. ``copyreg`` is where Python keeps how a type of somebody
else's is pickled, so that a model survives in whatever holds it: a chain, a robot, an object of one's own.
"""

from __future__ import annotations

import copyreg
import tempfile
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import pinocchio as pin

from pin_metaik.errors import InvalidModel
from pin_metaik.robots.description import description_of

Reduced: TypeAlias = tuple[Callable[..., pin.Model], tuple[Any, ...]]

QUICKLY = 1  # zlib's level: 9 is a fifth smaller and takes five times as long


class Follower(NamedTuple):
    """A joint that mimics another.

    Attributes:
        joint: Its id.
        kind: Pinocchio's name of the class of joint it would be, did it not follow.
        settings: What that class takes: an axis, a pitch.
        leader: Id and ``idx_vExtended`` of the joint it follows.
        scaling: Of the leader's coordinate ...
        offset: ... and the offset.
    """

    joint: int
    kind: str
    settings: tuple[tuple[float, ...] | float, ...]
    leader: tuple[int, int]
    scaling: float
    offset: float


def reduce_model(model: pin.Model) -> Reduced:
    """What pickle keeps of a model, and the function that makes it again.

    Raises:
        InvalidModel: If a joint mimics another and Pinocchio has no way to make such a joint anew.
    """
    state = zlib.compress(model.saveToString().encode(), QUICKLY)
    if not len(model.mimicking_joints):
        return model_of, (state,)
    followers = _followers(model)
    if _same(model, lambda: model_of(state, followers)):
        return model_of, (state, followers)
    description = description_of(model)
    if description is not None and _same(model, description.model):
        return type(description).model, (description,)
    names = ", ".join(sorted({f"{model.names[f.joint]!r} ({f.kind})" for f in followers}))
    raise InvalidModel(
        f"the model {model.name!r} cannot be pickled, because Pinocchio cannot restore its mimic joints: "
        f"{names}; pickle its source, and build the model again from that"
    )


def model_of(state: bytes, followers: tuple[Follower, ...] = ()) -> pin.Model:
    """The model that ``reduce_model`` took apart."""
    model = pin.Model()
    model.loadFromString(zlib.decompress(state).decode())
    for follower in followers:
        model.joints[follower.joint] = _joint(model, follower)
    return model


def _followers(model: pin.Model) -> tuple[Follower, ...]:
    """The joints that mimic others. Their axes are in Pinocchio's XML only."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.xml"
        model.saveToXML(str(path), "model")
        joints = ET.parse(path).getroot().findall("./model/joints/item")
    return tuple(_follower(model, int(j), joints[j]) for j in model.mimicking_joints)


def _follower(model: pin.Model, joint: int, written: ET.Element) -> Follower:
    mimic = model.joints[joint].extract()
    free = written.find("./base_variant/value/jmodel")
    settings: list[tuple[float, ...] | float] = []
    for value in [] if free is None else free.findall("./base_variant/value/*"):
        if value.tag == "axis":
            settings.append(tuple(float(item.text or "nan") for item in value.iter("item")))
        elif value.tag == "m_pitch":
            settings.append(float(value.text or "nan"))
    leader = ("nan", "nan") if free is None else (free.findtext("i_id", "nan"), free.findtext("i_vExtended", "nan"))
    kind = str(mimic).partition("Mimicking joint type: ")[2].partition("\n")[0]
    return Follower(
        joint, kind, tuple(settings), (int(leader[0]), int(leader[1])), float(mimic.scaling), float(mimic.offset)
    )


def _joint(model: pin.Model, follower: Follower) -> pin.JointModel:
    """A joint that follows another, as it was in the model."""
    settings = [np.array(one) if isinstance(one, tuple) else one for one in follower.settings]
    free, before = getattr(pin, follower.kind)(*settings), model.joints[follower.joint]
    free.setIndexes(follower.leader[0], before.idx_q, before.idx_v, follower.leader[1])
    mimic = pin.JointModelMimic(pin.JointModel(free), follower.scaling, follower.offset)
    mimic.setIndexes(before.id, before.idx_q, before.idx_v, before.idx_vExtended)
    return pin.JointModel(mimic)


def _same(model: pin.Model, remake: Callable[[], pin.Model]) -> bool:
    """Whether the model made anew equals the model, to the last bit of its joints."""
    try:
        made = remake()
    except (TypeError, ValueError, AttributeError):  # Pinocchio's Python has no such joint, or no way to make one
        return False
    if made != model or made.saveToString() != model.saveToString():
        return False
    q = pin.integrate(model, pin.neutral(model), np.linspace(0.1, 1.0, model.nv))
    here, there = model.createData(), made.createData()
    pin.forwardKinematics(model, here, q)
    pin.forwardKinematics(made, there, q)
    return all(np.array_equal(a, b) for a, b in zip(here.oMi, there.oMi, strict=True))


copyreg.pickle(pin.Model, reduce_model)
