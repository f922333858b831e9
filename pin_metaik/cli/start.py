"""Configurations on the command line: joints by name, or all entries of q."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, isfinite, radians, sin

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from pin_metaik.errors import InvalidConfiguration, UnknownName


def configuration(
    model: pin.Model, given: Sequence[str], base: NDArray[np.float64], in_degrees: bool
) -> NDArray[np.float64]:
    """A configuration (nq,): all entries, or a few joints by name on top of another configuration.

    Args:
        model: The model.
        given: ``["0.1", "-1", ...]``, as many as q has entries; or ``["JOINT=0.3", ...]`` in m or rad.
        base: (nq,) where joints are that are not named.
        in_degrees: Whether the values of turning joints by name are in degrees; entries of q never are.

    Raises:
        InvalidConfiguration: A word is no number, joints and entries are mixed, or there are too few or too many.
        UnknownName: The model has no such joint.
    """
    named = [word.partition("=") for word in given]
    if not any(sign for _, sign, _ in named):
        return np.array([_number(word) for word in given])
    q = base.copy()
    for name, sign, text in named:
        if not sign:
            raise InvalidConfiguration(f"a start is JOINT=VALUE for some joints or all entries of q, got {name!r}")
        _set(model, q, name.strip(), _number(text), in_degrees)
    return q


def turns(joint: pin.JointModel) -> bool:
    """Whether the coordinate of a joint that has one is an angle."""
    return "P" not in joint.shortname().removeprefix("JointModel")  # PX, PrismaticUnaligned, ...


def _set(model: pin.Model, q: NDArray[np.float64], name: str, value: float, in_degrees: bool) -> None:
    kinds = list(zip(model.names, model.joints, strict=True))[1:]  # the first is the world
    known = [joint for joint, kind in kinds if kind.nq in (1, 2) and kind.nv == 1]
    if name not in known:
        raise UnknownName("joint with one coordinate", name, known)
    joint = model.joints[model.getJointId(name)]
    angle = radians(value) if in_degrees and turns(joint) else value
    if joint.nq == 2:
        q[joint.idx_q : joint.idx_q + 2] = cos(angle), sin(angle)
    else:
        q[joint.idx_q] = angle


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise InvalidConfiguration(f"{text!r} is not a number: give --q0 JOINT=VALUE or all entries of q") from None
    if not isfinite(value):
        raise InvalidConfiguration(f"--q0 takes finite numbers, got {text!r}")
    return value
