"""Refiners: local methods that go from a start to a nearby solution, by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from pin_metaik.errors import InvalidSetting
from pin_metaik.ik.refine.dls import DLS
from pin_metaik.ik.refine.iterate import Patience
from pin_metaik.ik.refine.lm import LM
from pin_metaik.ik.refine.newton import Newton
from pin_metaik.ik.refine.protocol import Refinement, Refiner
from pin_metaik.ik.refine.qp import QP
from pin_metaik.ik.refine.sdls import SDLS
from pin_metaik.ik.refine.transpose import Transpose
from pin_metaik.lookup import lookup

REFINERS: dict[str, Callable[[], Refiner]] = {
    "dls": DLS,
    "dls_constant": partial(LM, "wampler"),  # damped least squares and Levenberg-Marquardt are one with this damping
    "lm": LM,  # with Chan and Lawrence's damping
    "lm_chan": partial(LM, "chan"),
    "lm_sugihara": partial(LM, "sugihara"),
    "lm_wampler": partial(LM, "wampler"),
    "newton": Newton,
    "qp": QP,
    "sdls": SDLS,
    "transpose": Transpose,
}

__all__ = [
    "DLS",
    "LM",
    "QP",
    "REFINERS",
    "SDLS",
    "Newton",
    "Patience",
    "Refinement",
    "Refiner",
    "Transpose",
    "make_refiner",
]


def make_refiner(refiner: str | Refiner) -> Refiner:
    """A refiner from its name; an object that already is one is returned as it is.

    Raises:
        UnknownName: No refiner of that name.
        InvalidSetting: Neither a name nor an object with a method ``refine``.
    """
    if isinstance(refiner, str):
        return lookup("refiner", refiner, REFINERS)()
    if isinstance(refiner, type) or not isinstance(refiner, Refiner):
        raise InvalidSetting(f"not a refiner: {refiner!r}; give a name or an object with refine(problem, starts, ...)")
    return refiner
